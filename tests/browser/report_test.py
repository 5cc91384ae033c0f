"""Tests a campaign's report in a browser: it has no errors and loads no file, and its plots have all points, each with
a text."""

import csv
import os

from browser import SIZES, ActionChains, By, corridor, main, source

CAMPAIGN = """format: corridor-campaign-1
problems: [%s, %s]
planners: [RRTConnect, {name: RRTConnect, label: <b>short</b>, params: {range: 0.5}}]
checkers:
  certified: {edges: certified}
  sampled: {edges: discrete, resolution: [0.1, 0.01]}
runs: 3
limits: {time: 60}
"""


def report(folder):
    campaign = os.path.join(folder, "pages.yaml")
    with open(campaign, "w") as file:
        file.write(CAMPAIGN % (source("problems", "thin_plate"), source("problems", "gantry_bins")))
    out = os.path.join(folder, "results")
    corridor("benchmark", campaign, "-o", out)
    return out


def pages(browser, folder):
    out = report(folder)
    for size in SIZES:
        browser.size(size)
        browser.open(os.path.join(out, "report.html"))
        browser.check_page()
    assert browser.js("document.title") == "pages"
    # Three plots for each of the two problems, and three for all problems together.
    assert browser.js("document.querySelectorAll('figure svg').length") == 9
    names = browser.js("[...document.querySelectorAll('figure')].map((figure) => figure.dataset.plot)")
    assert sorted(names) == sorted(
        [f"{kind}.{problem}" for kind in ("error", "solved", "clearance") for problem in ("thin_plate", "gantry_bins")] + ["cost", "error", "profile"]
    ), names
    assert browser.js("document.querySelectorAll('#ranking tbody tr').length") == 6  # two planners, three variants
    # The planners with the variant `certified` rank first, because none of their paths is refuted.
    first = browser.find("#ranking tbody tr").text
    assert ", certified" in first and "0 of 6" in first, first
    # A label that looks like HTML is shown as text.
    assert browser.js("document.querySelectorAll('#cells b').length") == 0
    assert "<b>short</b>" in browser.find("#cells").text
    points_have_texts(browser, out)


def points_have_texts(browser, out):
    """A plot has a point for each row of its CSV file, and each point shows a text when the pointer is on it."""
    browser.size("desktop")
    browser.open(os.path.join(out, "report.html"))
    with open(os.path.join(out, "plots", "error.thin_plate.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 6, rows  # two planners, three variants
    points = browser.driver.find_elements(By.CSS_SELECTOR, "figure[data-plot='error.thin_plate'] g[onmousemove]")
    assert len(points) == len(rows), len(points)
    said = set()
    # The events are simulated, because some points are covered by others. The text is read at once, because scrolling
    # hides it.
    for point in points:
        browser.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", point)
        words, tip = browser.driver.execute_script("""
            const box = arguments[0].getBoundingClientRect(), tip = document.getElementById('tip');
            arguments[0].dispatchEvent(new MouseEvent('mousemove', {clientX: box.x, clientY: box.y}));
            return [tip.textContent, tip.getBoundingClientRect().toJSON()];""", point)
        assert "paths refuted" in words and "s (median)" in words, words
        said.add(words.split("\n")[0])
        assert tip["width"] > 50 and 0 <= tip["left"] and tip["right"] <= SIZES["desktop"][0] and tip["top"] >= 0, tip
    assert len(said) == len(points), said
    # A real pointer is moved to the topmost point, again and again until the page has stopped scrolling.
    use = points[-1].find_element(By.TAG_NAME, "use")
    for step in range(20):
        ActionChains(browser.driver).move_to_element_with_offset(use, step % 2, 0).pause(0.1).perform()
        if not browser.js("document.getElementById('tip').hidden"):
            break
    else:
        raise AssertionError("a pointer on a point says nothing")
    # At least a line per planner and variant.
    lines = browser.js("document.querySelectorAll(\"figure[data-plot='solved.thin_plate'] g[id*=plot] path\").length")
    assert lines >= 6, lines
    browser.check_page()


def folded(browser, folder):
    """With many problems, the plot of a problem is stored as text. It is drawn when its part of the page has been
    opened and scrolled to, or when the page is printed."""
    campaign = os.path.join(folder, "folded.yaml")
    with open(campaign, "w") as file:
        file.write("format: corridor-campaign-1\nproblems: [%s]\ncheckers: {sampled: {edges: discrete}}\nruns: 1\nlimits: {time: 60}\n"
                   % ", ".join([source("problems", "thin_plate")] * 9))
    out = os.path.join(folder, "results")
    corridor("benchmark", campaign, "-o", out)
    browser.size("desktop")
    browser.open(os.path.join(out, "report.html"))
    browser.check_page()
    drawn = "[...document.querySelectorAll('details figure')].filter((figure) => figure.querySelector('svg')).length"
    assert browser.js("document.querySelectorAll('details figure').length") == 27
    assert browser.js(drawn) == 0
    browser.wait("document.querySelector(\"figure[data-plot='error'] svg\")")  # the plot of all problems is drawn at once
    browser.click("#solved summary")
    browser.driver.execute_script("document.querySelector('#solved details figure:last-child').scrollIntoView()")
    browser.wait("document.querySelector('#solved details figure:last-child svg')")
    browser.check_page()
    browser.js("dispatchEvent(new Event('beforeprint'))")
    assert browser.js(drawn) == 27
    browser.check_page()


main([pages, folded])
