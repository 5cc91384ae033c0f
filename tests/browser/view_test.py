"""Tests the pages of `corridor view` in a browser, at the sizes of a desktop and of a phone: they draw, play, fit the
window and have no errors."""

import json
import os

from browser import Browser, Keys, SIZES, corridor, main, png_size, source

READY = "window.corridorView !== undefined"
# The poses of all frames of the moving robots.
POSES = "corridorView.motion.now.frames.map((frame) => frame.matrix.elements.join()).join()"


def page_of(path, problem, *solve):
    """Makes a page of a problem, with a path if options of `corridor solve` are given."""
    words = [source("problems", problem)]
    if solve:
        words.append(os.path.join(path, "path.yaml"))
        corridor("solve", words[0], "-o", words[1], *solve)
    page = os.path.join(path, "page.html")
    corridor("view", *words, "-o", page)
    return page


def shown(browser, page, size):
    browser.size(size)
    browser.open(page)
    browser.wait(READY)
    browser.js("corridorView.stage.drawNow()")


def canvas(browser):
    browser.js("corridorView.stage.drawNow()")
    return browser.canvas("#canvas")


def check_slider(browser):
    """Slider and keys change the robots' poses and the canvas."""
    before, (colours, pixels) = browser.js(POSES), canvas(browser)
    assert colours > 50, f"only {colours} colours: the scene is not there"
    browser.driver.execute_script("""const slider = document.getElementById('slider');
        slider.value = 0.5;
        slider.dispatchEvent(new Event('input'));""")
    middle = browser.js(POSES)
    assert middle != before, "the slider moves nothing"
    assert canvas(browser)[1] != pixels, "the slider changes no pixel"
    browser.press(Keys.ARROW_RIGHT)
    assert browser.js(POSES) != middle
    assert abs(browser.js("Number(document.getElementById('slider').value)") - 0.51) < 1e-9
    browser.press(Keys.ARROW_LEFT)
    assert browser.js(POSES) == middle
    browser.press(Keys.END)
    assert browser.js("corridorView.motion.at") == 1
    browser.press(Keys.ARROW_LEFT, shift=True)
    states = browser.js("data.path.states.map((i) => data.array(data.path.at)[i])")
    assert browser.js("corridorView.motion.at") == states[-2]
    browser.press(Keys.HOME)
    assert browser.js(POSES) == before


def two_arms(browser, path):
    page = page_of(path, "two_arms", "--seed", 1)
    for size in SIZES:
        shown(browser, page, size)
        browser.check_page()
        badge = browser.js("document.getElementById('badge').textContent")
        assert badge == (
            "Proved free of contact, except 2 pairs that touch at rest or are allowed to: "
            "left/base ~ table, right/base ~ table"
        ), badge
        check_slider(browser)
        browser.check_page()
    browser.press(Keys.SPACE)
    browser.wait("corridorView.motion.at > 0.02")
    # On a busy machine the path may end before the key is pressed; then the key starts the path again.
    for _ in range(5):
        browser.press(Keys.SPACE)
        if browser.js("corridorView.player.playing") == 0:
            break
    assert browser.js("corridorView.player.playing") == 0
    # What is shown only on demand is off at first.
    if browser.js("document.body.classList.contains('closed')"):
        browser.click("#toggle")
    for body in ("closest-body", "trees-body", "pairs-body"):
        assert browser.js(f"document.getElementById('{body}').hidden")
    browser.click("#closest")
    samples = browser.js("corridorView.closest.metres.length")
    assert samples > 50
    assert len(browser.find("#chart polyline").get_attribute("points").split()) == samples
    assert browser.js("corridorView.closest.root.visible")
    linear = browser.find("#chart polyline").get_attribute("points")
    browser.click("#decades")
    assert len(browser.find("#chart polyline").get_attribute("points").split()) == samples
    assert browser.find("#chart polyline").get_attribute("points") != linear
    chart, at = browser.find("#chart svg"), browser.js("corridorView.motion.at")
    chart.click()  # at its centre
    assert browser.js("corridorView.motion.at") != at
    assert abs(browser.js("corridorView.motion.at") - 0.5) < 0.1
    browser.click("#trees")
    assert browser.js("corridorView.trees.shown.length") == browser.js("data.bodies.length")
    counts = []
    for level in range(3):
        browser.driver.execute_script("""const level = document.getElementById('level');
            level.value = arguments[0];
            level.dispatchEvent(new Event('input'));""", level)
        counts.append(browser.js("corridorView.trees.shown.reduce((sum, box) => sum + box.geometry.attributes.position.count / 24, 0)"))
    assert counts[0] == browser.js("data.bodies.length") and counts[0] < counts[1] < counts[2], counts
    browser.click("#pairs")
    browser.click("#pairs-body summary")
    browser.wait("document.querySelectorAll('#pairs-body li').length > 0")
    browser.check_page()


def hook_maze(browser, path):
    page = page_of(path, "hook_maze", "--seed", 1)
    for size in SIZES:
        shown(browser, page, size)
        assert browser.js("corridorView.stage.camera.isOrthographicCamera"), "a plan is not seen from above"
        check_slider(browser)
        browser.click("#view-3d")
        assert not browser.js("corridorView.stage.camera.isOrthographicCamera")
        assert canvas(browser)[0] > 50
        browser.check_page()


def without_solution(browser, path):
    page = page_of(path, "arm_at_shelf")
    for size in SIZES:
        shown(browser, page, size)
        assert canvas(browser)[0] > 50
        assert not browser.find("#bar").is_displayed()
        browser.check_page()
    glass = "corridorView.obstacles.bodies.filter((body) => body.isGlass).map((body) => data.bodies[body.index].name)"
    shown(browser, page, "desktop")
    assert browser.js(glass) == ["shelf"], "the shelf hides the arm"
    before = canvas(browser)[1]
    browser.click("[data-glass=solid]")
    assert browser.js(glass) == [] and canvas(browser)[1] != before


def refuted(browser, path):
    page = page_of(path, "thin_plate", "--edges", "discrete", "--seed", 1)
    for size in SIZES:
        shown(browser, page, size)
        assert browser.js("document.getElementById('badge').textContent") == "Refuted"
        if browser.js("document.body.classList.contains('closed')"):
            browser.click("#toggle")
        assert browser.js("corridorView.motion.at") == 0
        before = canvas(browser)[1]
        browser.click("#findings button")
        at = browser.js("data.array(data.path.at)[data.path.findings[0]]")
        assert at > 0 and browser.js("corridorView.motion.at") == at
        assert browser.js("corridorView.contact.lit.length") >= 2, "fewer than two bodies are lit"
        assert canvas(browser)[1] != before
        browser.click("#findings button")
        assert browser.js("corridorView.contact.lit.length") == 0
        browser.check_page()


def trajectory(browser, path):
    """A trajectory plays at its true speed. All plots and the table mark the same time."""
    for file, text in {
            "robot.yaml": "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [1, 1, 1]}]\n",
            "problem.yaml": "format: corridor-problem-1\nrobot: robot.yaml\nworld: {wall: {box: [0.1, 1, 1]}}\n"
                            "start: {at: [-3, 0]}\ngoal: {at: [3, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n"
                            "limits: {position: {velocity: 1}, rotation: {velocity: 1}}\n",
            "path.csv": "time,x,y,yaw\n1,-3,0,0\n21,-1,2,0\n41,3,0,1\n", "through.csv": "time,x,y,yaw\n1,-3,0,0\n5,3,0,0\n",
            "fast.csv": "time,x,y,yaw\n1,-3,0,0\n2,-1,2,0\n3,3,0,1\n"}.items():
        with open(os.path.join(path, file), "w", encoding="utf-8") as out:
            out.write(text)
    page = os.path.join(path, "page.html")
    corridor("view", os.path.join(path, "problem.yaml"), os.path.join(path, "path.csv"), "-o", page)
    cells = "[...document.querySelectorAll('#joints td')].map((cell) => cell.textContent)"
    for size in SIZES:
        shown(browser, page, size)
        browser.check_page()
        assert "Duration40 s" in browser.js("document.getElementById('facts').textContent")
        assert browser.find("#plots").is_displayed() == (size == "desktop")
        if size == "phone":
            browser.click("#plots-toggle")
            browser.check_page()
        assert browser.js("document.querySelectorAll('#plots svg').length") == 4
        assert browser.js("document.querySelectorAll('#plots figure:first-child polyline').length") == 3
        browser.js("corridorView.seek(0.25)")
        assert browser.find("#place").text == "11.000 s, edge 0"
        assert browser.js(cells) == ["-2.000", "0.100", "0.000", "1.000", "0.100", "0.000", "0.000", "0.000", "0.000"]
        places = browser.js("corridorView.plots.charts.map((chart) => chart.cursor.getAttribute('x1') === String(chart.x(0.25)))")
        assert places == [True] * 4, places
        browser.click("#plots svg")  # at its centre, which is not that of the axes
        assert abs(browser.js("corridorView.motion.at") - 0.4) < 0.02
        assert browser.js("document.querySelector('#slider').getAttribute('aria-valuetext')") == browser.find("#place").text
    assert "Limitsnot all tested; the others are kept; velocity " in browser.js("document.getElementById('facts').textContent")
    corridor("view", os.path.join(path, "problem.yaml"), os.path.join(path, "fast.csv"), "-o", os.path.join(path, "fast.html"))
    shown(browser, os.path.join(path, "fast.html"), "desktop")
    assert browser.find("#badge").text == "Proved free of contact, limits exceeded", "green although limits are exceeded"
    assert browser.find("#badge").get_attribute("class") == "undecided"
    assert "Limitsexceeded; velocity " in browser.js("document.getElementById('facts').textContent")
    shown(browser, page, "desktop")
    # The true speed: w seconds later by the browser's clock, the trajectory is `speed`·w seconds later.
    for speed in (0.25, 1, 2):
        browser.driver.execute_script("document.getElementById('speed').value = arguments[0];", str(speed))
        played = browser.driver.execute_async_script("""
            const done = arguments[0], {player, seek} = corridorView, played = [], request = window.requestAnimationFrame;
            let now = 0;
            window.requestAnimationFrame = (callback) => request((time) => { now = time; callback(time); });
            player.seek = (at) => {
              seek(at);
              if (played.push([now, at]) < 3) return;
              Object.assign(window, {requestAnimationFrame: request});
              player.seek = seek;
              player.pause();
              done(played);
            };
            seek(0);
            player.play();""")
        (begin, first), _, (end, last) = played
        assert end > begin and abs((last - first) * 40 - speed * (end - begin) / 1000) < 1e-9, (speed, played)
    corridor("view", os.path.join(path, "problem.yaml"), os.path.join(path, "through.csv"), "-o", page)
    shown(browser, page, "desktop")
    time = browser.js("data.verdict.findings[0].time_s")
    assert 1 < time < 5 and f"at {time:.3f} s, edge 0" in browser.find("#findings small").text
    browser.click("#findings button")
    assert abs(1 + 4 * browser.js("corridorView.motion.at") - time) < 1e-6
    assert pictured(browser, page, (600, 400)).startswith("refuted")
    assert "duration 4 s" in browser.find("#legend").text


def hostile_names(browser, path):
    name = "<img src=x onerror=alert(1)></script>'\""
    for file, text in {
            "cube.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
            "robot.yaml": f"format: corridor-robot-1\nname: {json.dumps(name)}\nrigid: SE3\nshapes: [{{mesh: cube.obj, unit: m}}]\n",
            "problem.yaml": f"format: corridor-problem-1\nrobot: robot.yaml\nworld: {{{json.dumps(name)}: {{box: [1, 1, 1]}}}}\n"
                            "start: {at: [-3, 0, 0]}\ngoal: {at: [3, 0, 0]}\nbounds: {at: [[-4, -4, -4], [4, 4, 4]]}\n",
            "path.yaml": "format: corridor-solution-1\nspace: SE3\npath: [[-3, 0, 0, 0, 0, 0, 1], [3, 0, 0, 0, 0, 0, 1]]\n"}.items():
        with open(os.path.join(path, file), "w", encoding="utf-8") as out:
            out.write(text)
    page = os.path.join(path, "page.html")
    corridor("view", os.path.join(path, "problem.yaml"), os.path.join(path, "path.yaml"), "-o", page)
    shown(browser, page, "desktop")
    assert name in browser.js("document.getElementById('facts').textContent")
    assert name in browser.js("document.getElementById('findings').textContent")
    assert browser.js("document.querySelectorAll('img').length") == 0
    browser.check_page()


def without_webgl(_, path):
    page = page_of(path, "hook_maze", "--seed", 1)
    with Browser("--disable-3d-apis") as browser:
        browser.size("desktop")
        browser.open(page)
        assert "WebGL" in browser.find("#trouble").text
        assert browser.js("document.getElementById('name').textContent") == "hook_maze", "the part that needs no WebGL is missing"
        browser.check_page()


def picture(browser, path):
    page_of(path, "hook_maze", "--seed", 1)
    image = os.path.join(path, "page.png")
    corridor("view", source("problems", "hook_maze"), os.path.join(path, "path.yaml"), "--image", image, "--size", "640x400")
    assert png_size(image) == (640, 400)
    assert os.path.getsize(image) > 10000, "hardly anything is on it"


def pictured(browser, page, size):
    """Opens the page as `--image` draws it; checks that the legend is in the picture, below the scene. Returns the legend's verdict."""
    browser.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                   {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False})
    browser.open(page, "#image")
    browser.wait(READY)
    browser.js("corridorView.stage.drawNow()")
    browser.check_page()
    boxes = browser.js("[...document.querySelectorAll('#legend, #legend span')].map((e) => { const b = e.getBoundingClientRect();"
                       " return [b.left, b.top, b.right, b.bottom]; })")
    for left, top, right, bottom in boxes:
        assert 0 <= left < right <= size[0] and 0 <= top < bottom <= size[1], (size, boxes)
    lowest = browser.js("Math.min(...corridorView.stage.points.map((p) => p.clone().project(corridorView.stage.camera).y))")
    assert (1 - lowest) / 2 * size[1] <= boxes[0][1], f"{size}: the scene goes on under the legend"
    assert not browser.find("#panel").is_displayed()
    return browser.find("#legend .verdict").text


def picture_shows_the_verdict(browser, path):
    """The legend shows the verdict. For a refuted path a ring marks the contact, and all poses keep their own colours."""
    ring = "corridorView.contact.ring.visible"
    sizes = (1366, 768), (600, 400)
    page = page_of(path, "thin_plate", "--seed", 1)
    for size in sizes:
        assert pictured(browser, page, size) == "proved"
        assert not browser.js(ring)
    page = page_of(path, "thin_plate", "--edges", "discrete", "--seed", 1)
    for size in sizes:
        assert pictured(browser, page, size) == "refuted: paper_plane and plate touch"
        assert browser.js(ring) and browser.js("corridorView.contact.lit.length") == 0
        assert browser.js("corridorView.contact.ring.position.toArray()") == browser.js("data.verdict.findings[0].point")
        x, y = browser.js("(({x, y}) => [x, y])(corridorView.contact.ring.position.clone().project(corridorView.stage.camera))")
        assert max(abs(x), abs(y)) < 1, "the ring is not in the picture"
        motion = "corridorView.motion"
        assert browser.js(f"[{motion}.start, ...{motion}.goals, ...{motion}.ghosts].every((copy) => copy.root.visible)")
        with_ring = canvas(browser)[1]
        browser.driver.execute_script("corridorView.contact.show(null);")
        assert canvas(browser)[1] != with_ring, "the ring is not drawn"
    shown(browser, page, "desktop")
    assert not browser.js(ring), "a page draws the ring before a finding is selected"
    assert browser.js("document.querySelector('#legend .verdict')") is None, "the legend shows a verdict: pages have a panel for it"
    # The path ends outside of the goal, which the verifier does not report as a finding. The names are very long.
    long = "from_here_to_there_and_back_again_" * 5
    for file, text in {
            "robot.yaml": f"format: corridor-robot-1\nname: {long}\nrigid: SE2\nshapes: [{{box: [1, 1, 1]}}]\n",
            "problem.yaml": f"format: corridor-problem-1\nrobot: robot.yaml\nworld: {{{long}wall: {{box: [0.1, 9, 1]}}}}\n"
                            "start: {at: [-3, 0]}\ngoal: {at: [3, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n",
            "short.yaml": "format: corridor-solution-1\nspace: SE2\npath: [[-3, 0, 0], [-2, 0, 0]]\n",
            "through.yaml": "format: corridor-solution-1\nspace: SE2\npath: [[-3, 0, 0], [3, 0, 0]]\n"}.items():
        with open(os.path.join(path, file), "w", encoding="utf-8") as out:
            out.write(text)
    for solution, ending in ("short", "refuted: the last state is not in the goal"), ("through", "from_here_to_th…_back_again_wall touch"):
        corridor("view", os.path.join(path, "problem.yaml"), os.path.join(path, f"{solution}.yaml"), "-o", page)
        for size in sizes:
            text = pictured(browser, page, size)
            assert text.endswith(ending) and len(text) < 100, text
            assert ("end of the path, not in the goal" in browser.find("#legend").text) == (solution == "short")
            assert browser.js(ring) == (solution == "through")


def not_shown_as_proved(browser, path):
    """A path of another problem must not look proved, nor may a path of a problem in which no pair is tested."""
    for file, text in {
            "robot.yaml": "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [1, 1, 1]}]\n",
            "free.yaml": "format: corridor-problem-1\nrobot: robot.yaml\nworld: {wall: {box: [0.1, 1, 1]}}\nallow: [[cube, wall]]\n"
                         "start: {at: [-3, 0]}\ngoal: {at: [3, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n",
            "hand.yaml": "format: corridor-solution-1\nspace: SE2\npath: [[-3, 0, 0], [3, 0, 0]]\n",
            "other.yaml": f"format: corridor-solution-1\nspace: SE2\ndigest: {64 * 'a'}\npath: [[-3, 0, 0], [3, 0, 0]]\n"}.items():
        with open(os.path.join(path, file), "w", encoding="utf-8") as out:
            out.write(text)
    page = os.path.join(path, "page.html")
    for solution, badge, verdict in (("hand", "No pair is tested", "no pair is tested"), ("other", "Other problem", "other problem")):
        corridor("view", os.path.join(path, "free.yaml"), os.path.join(path, f"{solution}.yaml"), "-o", page)
        shown(browser, page, "desktop")
        shown_badge = browser.find("#badge")
        assert shown_badge.text == badge and "proved" not in shown_badge.get_attribute("class")
        assert browser.find("#notes li").text.startswith("The path was made for" if solution == "other" else "no pair of bodies is tested")
        assert ("Edges proved" in browser.find("#facts").text) == (solution == "hand")
        browser.check_page()
        assert pictured(browser, page, (600, 400)) == verdict


main([not_shown_as_proved, two_arms, hook_maze, trajectory, without_solution, refuted, hostile_names, without_webgl, picture, picture_shows_the_verdict])
