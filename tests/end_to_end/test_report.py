"""The report in a browser: headless Chromium with software rendering."""

import base64
import json
import re
from itertools import pairwise

import pytest
from browser import browser

# One product is enough, since tests of the page cover the differences.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.parametrize("product", ["motor"], indirect=True),
]

MOST_BYTES = 5_000_000
READY = "document.documentElement.classList.contains('orbits')"
AT_REST = "new Promise((done) => setTimeout(done, 600))"


@pytest.fixture(scope="module")
def page(product):
    """The report, its viewer ready."""
    with browser() as tab:
        tab.open(product.folder / "report.html", width=1000, height=700)
        tab.wait(READY)
        yield tab


def choose(page, name, value):
    """Set a control as a user does, and return the readout."""
    page.value(
        f"(() => {{ const it = document.getElementById('{name}'); it.value = '{value}';"
        "it.dispatchEvent(new Event('input')); it.dispatchEvent(new Event('change')); })()"
    )
    return page.value("document.getElementById('scene-readout').textContent")


def press(page, selector):
    page.value(f'document.querySelector("{selector}").click()')


def screenshot(page):
    """A screenshot of the view at rest."""
    page.value("document.getElementById('robot').scrollIntoView({ behavior: 'instant' })")
    page.value(AT_REST)
    return page.call("Page.captureScreenshot", format="png")["data"]


def test_it_is_small_and_requests_nothing_else(page, product):
    report = product.folder / "report.html"
    assert report.stat().st_size < MOST_BYTES
    requests = [sent["request"]["url"] for sent in page.of_kind("Network.requestWillBeSent")]
    assert requests[0] == report.as_uri()
    assert all(url.startswith("data:") for url in requests[1:])


def test_it_embeds_the_design(page, product):
    embedded = page.value("document.getElementById('design').textContent")
    assert json.loads(embedded) == json.loads((product.folder / "design.json").read_text())


def test_replays_are_those_of_the_simulation(page, product):
    """At the end of a flight the readout has the figures of the CSV; wheels have rpm."""
    choose(page, "scene-choice", "1")
    readout = choose(page, "scene-time", "0.3")
    pitch, roll = map(float, re.search(r"pitch (-?[\d.]+)°, roll (-?[\d.]+)°", readout).groups())
    heading, *rows = (product.folder / "validation" / "drop_with_ocs.csv").read_text().split()
    row = dict(zip(heading.split(","), map(float, rows[60].split(",")), strict=True))
    assert row["time_s"] == pytest.approx(0.3)
    assert (pitch, roll) == (
        pytest.approx(row["pitch_rad"] * 57.29578, abs=0.15),
        pytest.approx(row["roll_rad"] * 57.29578, abs=0.15),
    )
    assert "rpm" in readout
    assert "rpm" not in choose(page, "scene-device", "without")
    assert choose(page, "scene-device", "both").count("pitch") == 2
    choose(page, "scene-device", "with")


def test_the_view_follows_the_controls(page):
    choose(page, "scene-choice", "")
    views = [screenshot(page)]
    for look in ("device", "0 0", "-1.5708 0", "3.1416 1.5"):
        press(page, f"[data-look='{look}']")
        views.append(screenshot(page))
    press(page, "#scene-fade")
    views.append(screenshot(page))
    press(page, "#scene-fade")
    press(page, "[data-look='home']")
    assert len(set(views)) == len(views)


def test_play_pause_and_the_cursor_of_the_charts(page):
    press(page, "[data-replay='0']")
    time_value = "Number(document.getElementById('scene-time').value)"
    page.wait(f"{time_value} > 0.02")
    assert page.value("document.getElementById('scene-play').textContent") == "Pause"
    press(page, "#scene-play")
    paused = page.value(time_value)
    page.value(AT_REST)
    assert page.value(time_value) == paused
    cursors = (
        "[...document.querySelectorAll(\"[data-flight='{}'] .cursor\")]"
        ".map((line) => line.getAttribute('d'))"
    )
    assert all(page.value(cursors.format(0)))
    assert not any(page.value(cursors.format(1)))


def test_the_view_is_operable_by_keyboard(page):
    page.value("document.getElementById('viewer').focus()")
    first = screenshot(page)
    for key in ("ArrowLeft", "ArrowUp", "+"):
        page.call("Input.dispatchKeyEvent", type="keyDown", key=key)
    rotated = screenshot(page)
    page.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
    playing = page.value("document.getElementById('scene-play').getAttribute('aria-pressed')")
    page.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
    assert first != rotated
    assert playing == "true"


def test_every_element_has_an_accessible_name(page):
    nameless = page.value(
        "[...document.querySelectorAll('button, select, input, summary, a, img, canvas, svg')]"
        ".filter((it) =>"
        " !(it.textContent.trim() || it.labels?.length || it.alt || it.getAttribute('aria-label')"
        " || it.querySelector('title'))).map((it) => it.outerHTML.slice(0, 80))"
    )
    assert nameless == []
    levels = page.value(
        "[...document.querySelectorAll('h1,h2,h3')].map((it) => Number(it.tagName[1]))"
    )
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))


def test_it_fits_a_phone(page):
    page.size(390, 800)
    try:
        assert page.value("document.documentElement.scrollWidth") <= 390
    finally:
        page.size(1000, 700)


def test_the_printed_page_has_the_picture_instead_of_the_view(page, tmp_path):
    page.call("Emulation.setEmulatedMedia", media="print")
    look = "getComputedStyle(document.querySelector('.view {}')).{}"
    try:
        assert page.value(look.format("img", "visibility")) == "visible"
        assert page.value(look.format("canvas", "display")) == "none"
    finally:
        page.call("Emulation.setEmulatedMedia", media="")
    printed = base64.b64decode(page.call("Page.printToPDF", printBackground=True)["data"])
    assert printed.startswith(b"%PDF")
    assert 2 <= printed.count(b"/Type /Page\n") <= 6


def test_the_console_is_empty_after_all_tests(page):
    """This test is the last since it concerns all tests above."""
    assert (
        page.of_kind("Runtime.exceptionThrown", "Log.entryAdded", "Runtime.consoleAPICalled") == []
    )


def test_without_webgl_the_picture_stays_with_a_reason(product):
    with browser("--disable-3d-apis") as tab:
        tab.open(product.folder / "report.html")
        tab.wait("document.getElementById('viewer-note').textContent.includes('picture')")
        image = "getComputedStyle(document.querySelector('.view img')).visibility"
        assert tab.value(image) == "visible"
        assert tab.of_kind("Runtime.exceptionThrown") == []
