"""What tests of pages share: the program, a browser without a display, and what is to hold of every page.

A test is a script that imports this file, opens pages and ends with `done()`. Without Chromium, its driver or Selenium it
prints why and ends with status 77, which ctest shows as skipped."""

import contextlib
import io
import os
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
WAIT = 120  # seconds: a busy machine of two cores draws by its processor

SIZES = {"desktop": (1366, 768), "phone": (390, 844)}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    skip("needs Debian's python3-selenium")


def corridor(*words, status=0):
    """Runs the program (CORRIDOR_PROGRAM) and returns what it printed."""
    result = subprocess.run([os.environ["CORRIDOR_PROGRAM"], *map(str, words)], capture_output=True, text=True)
    assert result.returncode == status, f"corridor {words}: {result.returncode}\n{result.stdout}{result.stderr}"
    return result.stdout


def source(*parts):
    return os.path.join(os.environ["CORRIDOR_SOURCE_DIR"], *parts)


@contextlib.contextmanager
def folder():
    with tempfile.TemporaryDirectory(prefix="corridor-browser-") as path:
        yield path


class Browser:
    """Chromium with one page."""

    def __init__(self):
        browser, driver = shutil.which("chromium"), shutil.which("chromedriver")
        if not browser or not driver:
            skip("needs Debian's chromium and chromium-driver")
        options = webdriver.ChromeOptions()
        options.binary_location = browser
        for word in ("--headless", "--hide-scrollbars", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader"):
            options.add_argument(word)
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(driver), options=options)
        self.driver.set_page_load_timeout(WAIT)
        self.driver.set_script_timeout(WAIT)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.driver.quit()

    def size(self, name):
        """The inside of the window, exactly: Chromium makes no window narrower than 500 pixels by itself."""
        width, height = SIZES[name]
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def open(self, file, fragment=""):
        self.driver.get("about:blank")
        self.driver.get(f"file://{os.path.abspath(file)}{fragment}")

    def js(self, expression):
        return self.driver.execute_script(f"return {expression};")

    def wait(self, expression):
        """Until the expression holds."""
        WebDriverWait(self.driver, WAIT, 0.1).until(lambda _: self.js(expression), f"in {WAIT} s not true: {expression}")

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector):
        """As a user does who scrolls there."""
        element = self.find(selector)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def screenshot(self, selector=None):
        return (self.find(selector).screenshot_as_png if selector else self.driver.get_screenshot_as_png())

    def complaints(self):
        """What the console has of errors."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def check_page(self):
        """What holds of every page, of any size: no error, nothing loaded, nothing wider than the window."""
        assert not (found := self.complaints()), found
        loaded = self.js("performance.getEntriesByType('resource').map((entry) => entry.name)")
        assert not loaded, f"the page loads {loaded}"
        width, inner = self.js("[document.documentElement.scrollWidth, window.innerWidth]")
        assert width <= inner, f"the page is {width} pixels wide, the window {inner}"


def colours(png):
    """How many colours a picture has (PNG, as screenshots are)."""
    return len(set(pixels(png)))


def pixels(png):
    """The pixels of an 8-bit PNG without interlacing, as bytes objects. (So that the tests need no further package.)"""
    import struct
    import zlib
    stream = io.BytesIO(png[8:])
    data, channels, width = b"", 0, 0
    while header := stream.read(8):
        length, kind = struct.unpack(">I4s", header)
        body = stream.read(length)
        stream.read(4)
        if kind == b"IHDR":
            width, _, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and not interlaced and colour in (2, 6), "another kind of PNG"
            channels = {2: 3, 6: 4}[colour]
        elif kind == b"IDAT":
            data += body
    raw, stride, result = zlib.decompress(data), width * channels, []
    above = bytearray(stride)
    for start in range(0, len(raw), stride + 1):
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            a = row[i - channels] if i >= channels else 0
            b = above[i]
            c = above[i - channels] if i >= channels else 0
            if kind == 1:
                row[i] = (row[i] + a) & 255
            elif kind == 2:
                row[i] = (row[i] + b) & 255
            elif kind == 3:
                row[i] = (row[i] + (a + b) // 2) & 255
            elif kind == 4:
                near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))
                row[i] = (row[i] + near[2]) & 255
        result += [bytes(row[i:i + channels]) for i in range(0, stride, channels)]
        above = row
    return result


def main(tests):
    """Runs functions of one browser each by name; the first failure ends with status 1."""
    for test in tests:
        began = time.monotonic()
        with Browser() as browser, folder() as path:
            test(browser, path)
        print(f"{test.__name__}: passed in {time.monotonic() - began:.1f} s", flush=True)
    print(f"{len(tests)} passed, 0 failed")
