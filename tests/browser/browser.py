"""Helpers for the tests of HTML pages: they run the program `corridor` and a headless browser, and check every page.

A test is a script that imports this file and ends with `main([test, …])`, a list of functions, each of which takes a
browser and a folder. Without Chromium, its driver or Selenium the script prints the reason and ends with status 77, which
ctest shows as skipped."""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
WAIT = 120  # seconds: a busy machine with two cores and no graphics card renders slowly

SIZES = {"desktop": (1366, 768), "phone": (390, 844)}


def skip(why):
    print(f"browser: Skipped\n{why}")  # in GoogleTest's format, so that ./corridor test lists the reason
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    skip("needs Debian's python3-selenium")


def corridor(*words, status=0):
    """Runs the program (CORRIDOR_PROGRAM), requires its exit status, and returns what it printed."""
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
    """Chromium with one open page."""

    def __init__(self, *flags):
        """flags: command-line flags of Chromium, in addition to those for rendering without a graphics card."""
        browser, driver = shutil.which("chromium"), shutil.which("chromedriver")
        if not browser or not driver:
            skip("needs Debian's chromium and chromium-driver")
        options = webdriver.ChromeOptions()
        options.binary_location = browser
        for word in ("--headless", "--hide-scrollbars", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--webgl-antialiasing-mode=none",  # four times as fast; no test needs antialiasing
                     *flags):
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
        """Sets the exact size of the page. Chromium itself makes no window narrower than 500 pixels."""
        width, height = SIZES[name]
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def open(self, file, fragment=""):
        self.driver.get("about:blank")
        self.driver.get(f"file://{os.path.abspath(file)}{fragment}")

    def js(self, expression):
        return self.driver.execute_script(f"return {expression};")

    def wait(self, expression):
        """Waits until the expression is true."""
        WebDriverWait(self.driver, WAIT, 0.1).until(lambda _: self.js(expression), f"in {WAIT} s not true: {expression}")

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector):
        """Scrolls to an element and clicks it, as a user does."""
        element = self.find(selector)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def screenshot(self, selector=None):
        return (self.find(selector).screenshot_as_png if selector else self.driver.get_screenshot_as_png())

    def complaints(self):
        """Returns the errors in the console."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def check_page(self):
        """Checks the rules for every page at any size: no error in the console, no file loaded, nothing wider than the
        window."""
        assert not (found := self.complaints()), found
        loaded = self.js("performance.getEntriesByType('resource').map((entry) => entry.name)")
        assert not loaded, f"the page loads {loaded}"
        width, inner = self.js("[document.documentElement.scrollWidth, window.innerWidth]")
        assert width <= inner, f"the page is {width} pixels wide, the window {inner}"


    def press(self, key, shift=False):
        """Sends a key to the page."""
        chain = ActionChains(self.driver)
        if shift:
            chain.key_down(Keys.SHIFT)
        chain.send_keys(key)
        if shift:
            chain.key_up(Keys.SHIFT)
        chain.perform()

    def canvas(self, selector):
        """Returns the number of colours of a canvas that WebGL draws on, and a hash of its pixels."""
        # Without a graphics card, copying the pixels to a 2D canvas and reading this canvas takes a hundred times as
        # long.
        return self.driver.execute_script("""
            const canvas = document.querySelector(arguments[0]), gl = canvas.getContext('webgl2') || canvas.getContext('webgl');
            const pixels = new Uint32Array(gl.drawingBufferWidth * gl.drawingBufferHeight);
            gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE,
                          new Uint8Array(pixels.buffer));
            let sum = 0;
            for (const pixel of pixels) sum = Math.imul(sum, 31) + pixel | 0;
            return [new Set(pixels).size, sum];""", selector)


def png_size(file):
    """Returns width and height of a PNG."""
    with open(file, "rb") as png:
        start = png.read(24)
    assert start[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    return int.from_bytes(start[16:20], "big"), int.from_bytes(start[20:24], "big")


def main(tests):
    """Runs all tests in one browser, which takes seconds to start. The first failure ends the script with status 1."""
    with Browser() as browser:
        for test in tests:
            began = time.monotonic()
            with folder() as path:
                test(browser, path)
            print(f"{test.__name__}: passed in {time.monotonic() - began:.1f} s", flush=True)
    print(f"{len(tests)} passed, 0 failed")
