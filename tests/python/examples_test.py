"""Runs the examples of planner/python/README.md as one script, and the example of README.md."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["CORRIDOR_SOURCE_DIR"])


class Examples(unittest.TestCase):
    def printed(self, page, least):
        """Runs all blocks of Python code of a page, and returns the text that they print."""
        blocks = re.findall(r"```python\n(.*?)```", (SOURCE / page).read_text(encoding="utf-8"), re.DOTALL)
        self.assertGreaterEqual(len(blocks), least)
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "examples.py")
            script.write_text("".join(blocks), encoding="utf-8")
            done = subprocess.run([sys.executable, script], cwd=SOURCE, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 0)
        return done.stdout

    def test_guide(self):
        out = self.printed("planner/python/README.md", 6)
        self.assertRegex(out, r"<Solution: solved, \d+ states, certified, except 1 pair [a-z ]*: base ~ pedestal>")
        self.assertIn("proved\n", out)
        self.assertRegex(out, r"(?m)^0\.(5|49999)\d*$")  # the time of the first contact

    def test_front_page(self):
        expected = r"^<Solution: solved, \d+ states, certified, except 1 pair [a-z ]*: base ~ pedestal> proved\n$"
        self.assertRegex(self.printed("README.md", 1), expected)


if __name__ == "__main__":
    unittest.main()
