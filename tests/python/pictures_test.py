"""Tests of pictures: SVG, PNG, and the page that Jupyter shows."""

import html.parser
import re
import struct
import unittest
import xml.etree.ElementTree
import zlib

import corridor
import numpy as np
from corridor import Joint, Pose, shapes


def solved():
    arm = corridor.robot(
        {"base": shapes.cylinder(0.1, 0.1), "upper": shapes.capsule(0.05, 0.6, Pose((0, 0, 0.3)))},
        [Joint("turn", "revolute", "base", "upper", Pose((0, 0, 0.1)), axis=(1, 0, 0), limits=(-2, 2))],
    )
    problem = corridor.Problem(arm, {"ball": shapes.sphere(0.1, Pose((0.3, 0.8, 0.2)))}, start=[-1], goals=[1])
    return corridor.solve(problem)


def pixels(png):
    """Returns the pixels of a PNG, H×W×channels, by NumPy and zlib alone."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data, header = 8, b"", None
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        body = png[at + 8 : at + 8 + size]
        assert struct.unpack(">I", png[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        data += body if kind == b"IDAT" else b""
        at += 12 + size
    width, height, depth, colour = header[:4]
    assert depth == 8 and header[6] == 0
    channels = {2: 3, 6: 4}[colour]
    rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + width * channels)
    image = np.zeros((height, width * channels), np.uint8)
    for y, row in enumerate(rows):
        above = image[y - 1].astype(int) if y else np.zeros(width * channels, int)
        kind, line = row[0], row[1:].astype(int)
        for x in range(width * channels) if kind in (1, 3, 4) else ():
            left = line[x - channels] if x >= channels else 0
            corner = above[x - channels] if x >= channels else 0
            p = left + above[x] - corner
            near = min((abs(p - left), 0, left), (abs(p - above[x]), 1, above[x]), (abs(p - corner), 2, corner))[2]
            line[x] = (line[x] + {1: left, 3: (left + above[x]) // 2, 4: near}[kind]) % 256
        image[y] = (line + above) % 256 if kind == 2 else line
    return image.reshape(height, width, channels)


class Loads(html.parser.HTMLParser):
    """Collects the addresses that a page would load: those in tags, in styles and in scripts."""

    def __init__(self, page):
        super().__init__()
        self.found, self.inside, self.text = [], None, {"style": "", "script": ""}
        self.frames = []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.inside = tag
        for name, value in attributes:
            if name == "srcdoc":
                self.frames.append(value)
            # The href of <a> loads nothing, and that of <use> refers to the page itself.
            elif name in ("src", "srcset", "data", "poster", "action", "background") or (name == "href" and tag == "link"):
                self.found.append((tag, name, value))
            elif name == "style":
                self.text["style"] += value

    def handle_endtag(self, tag):
        self.inside = None

    def handle_data(self, data):
        if self.inside in self.text:
            self.text[self.inside] += data

    def external(self):
        """Returns all addresses that are neither `data:` nor within the page."""
        found = [each for each in self.found if not (each[2] or "").startswith(("data:", "#", "blob:"))]
        styles = [u for u in re.findall(r"url\(\s*['\"]?([^)'\"]*)", self.text["style"]) if not u.startswith(("data:", "#"))]
        styles += re.findall(r"@import[^;]*", self.text["style"])
        # In scripts, these load addresses: imports of https addresses, and calls such as fetch with any address.
        script = self.text["script"]
        scripts = re.findall(r"(?:^|[;\s])import\s*(?:[\w{}*,\s]*from\s*)?['\"]https?:[^'\"]*", script)
        scripts += re.findall(r"(?:fetch|importScripts|Worker|EventSource|WebSocket)\(\s*['\"`][^)]{0,80}", script)
        return found, styles, scripts


class Jupyter(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = solved()

    def test_the_page_is_whole(self):
        for shown in self.solution, self.solution.problem:
            outer = Loads(shown._repr_html_())
            self.assertEqual(outer.external(), ([], [], []))
            [page] = outer.frames
            self.assertIn("<!DOCTYPE html>", page[:200])
            inner = Loads(page)
            self.assertEqual(inner.external(), ([], [], []))
            self.assertGreater(len(inner.text["script"]), 10_000)  # the viewer is in it
        self.assertEqual(page, self.solution.problem.page())

    def test_the_check_finds_external_loads(self):
        for page in (
            '<script src="https://x.org/a.js"></script>', '<link rel="stylesheet" href="a.css">', "<img src='b.png'>",
            "<style>@import 'a.css';</style>", "<style>p {background: url(c.png)}</style>",
            '<script>import {a} from "https://x.org/b.js";</script>', '<script>fetch("/data")</script>',
        ):  # fmt: skip
            self.assertNotEqual(Loads(page).external(), ([], [], []), page)

    def test_no_path(self):
        self.solution = corridor.Solution(self.solution.problem, "not found", "too <short>", np.zeros((0, 1)), False)
        self.assertEqual(self.solution._repr_html_(), "<p>&lt;Solution: not found; too &lt;short&gt;&gt;</p>")
        self.assertIsNone(self.solution._repr_png_())
        with self.assertRaisesRegex(ValueError, "there is no path: too <short>"):
            self.solution.png()


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = solved()

    def test_svg(self):
        root = xml.etree.ElementTree.fromstring(self.solution.svg())
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        images = [e for e in root.iter() if e.tag.endswith("}image")]
        self.assertEqual([e.get("href")[:22] for e in images], ["data:image/png;base64,"])
        self.assertEqual(self.solution.svg().count("href"), 1)

    def test_direction(self):
        pictures = {self.solution.svg(seen_from=d) for d in ("top", "left", "-30,20", None)}
        self.assertEqual(len(pictures), 4)
        self.assertEqual(self.solution.svg("top"), self.solution.svg(seen_from="-90,90"))
        with self.assertRaisesRegex(corridor.InputError, r'seen_from: .* is needed, not "topp" \(did you mean "top"\?\)'):
            self.solution.svg(seen_from="topp")
        with self.assertRaisesRegex(ValueError, r'seen_from: a text is needed, such as "front" or "-60,38", not \(0, 90\)'):
            self.solution.png(seen_from=(0, 90))

    def test_bad_width(self):
        for width in 0, -1, 8_001, 1.5, "100", True:
            with self.assertRaisesRegex(ValueError, "width: a whole number from 1 to 8000 is needed"):
                self.solution.png(width=width)

    def test_png(self):
        image = pixels(self.solution.png(width=300))
        self.assertEqual(image.shape[1], 300)
        self.assertGreater(image.shape[0], 50)
        colours = image[..., :3].reshape(-1, 3).astype(int)
        # The colours of the path go from green to red.
        red = (colours[:, 0] > colours[:, 1] + 60) & (colours[:, 0] > colours[:, 2] + 60)
        green = (colours[:, 1] > colours[:, 0] + 30) & (colours[:, 1] > colours[:, 2] + 30)
        self.assertGreater(red.sum(), 30)
        self.assertGreater(green.sum(), 30)
        self.assertEqual(self.solution._repr_png_()[:4], b"\x89PNG")


if __name__ == "__main__":
    unittest.main()
