"""The report as a browser shows it: Chromium without a screen, drawing by the processor."""

import base64
import json
import re
from itertools import pairwise

import pytest
from browser import browser

# One of them is enough: what differs between them is in the tests of the page.
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


def chosen(page, name, value):
    """Set a control as a user does; the readout then."""
    page.value(
        f"(() => {{ const it = document.getElementById('{name}'); it.value = '{value}';"
        "it.dispatchEvent(new Event('input')); it.dispatchEvent(new Event('change')); })()"
    )
    return page.value("document.getElementById('scene-readout').textContent")


def pressed(page, selector):
    page.value(f'document.querySelector("{selector}").click()')


def seen(page):
    """A picture of the view at rest."""
    page.value("document.getElementById('robot').scrollIntoView({ behavior: 'instant' })")
    page.value(AT_REST)
    return page.call("Page.captureScreenshot", format="png")["data"]


def test_it_is_small_and_asks_for_nothing_but_itself(page, product):
    report = product.folder / "report.html"
    assert report.stat().st_size < MOST_BYTES
    asked = [each["request"]["url"] for each in page.of_kind("Network.requestWillBeSent")]
    assert asked[0] == report.as_uri()
    assert all(url.startswith("data:") for url in asked[1:])


def test_it_holds_the_design_as_it_was_written(page, product):
    held = page.value("document.getElementById('design').textContent")
    assert json.loads(held) == json.loads((product.folder / "design.json").read_text())


def test_replays_are_those_of_the_simulation(page, product):
    """At the end of a flight: what the CSV file says, and wheels only where there are some."""
    chosen(page, "scene-choice", "1")
    said = chosen(page, "scene-time", "0.3")
    pitch, roll = map(float, re.search(r"pitch (-?[\d.]+)°, roll (-?[\d.]+)°", said).groups())
    heading, *rows = (product.folder / "validation" / "drop_with_ocs.csv").read_text().split()
    at = dict(zip(heading.split(","), map(float, rows[60].split(",")), strict=True))
    assert at["time_s"] == pytest.approx(0.3)
    assert (pitch, roll) == (
        pytest.approx(at["pitch_rad"] * 57.29578, abs=0.15),
        pytest.approx(at["roll_rad"] * 57.29578, abs=0.15),
    )
    assert "rpm" in said
    assert "rpm" not in chosen(page, "scene-device", "without")
    assert chosen(page, "scene-device", "both").count("pitch") == 2
    chosen(page, "scene-device", "with")


def test_the_view_shows_what_is_chosen(page):
    chosen(page, "scene-choice", "")
    views = [seen(page)]
    for look in ("device", "0 0", "-1.5708 0", "3.1416 1.5"):
        pressed(page, f"[data-look='{look}']")
        views.append(seen(page))
    pressed(page, "#scene-fade")
    views.append(seen(page))
    pressed(page, "#scene-fade")
    pressed(page, "[data-look='home']")
    assert len(set(views)) == len(views)


def test_it_plays_pauses_and_moves_the_cursor_of_its_charts(page):
    pressed(page, "[data-replay='0']")
    now = "Number(document.getElementById('scene-time').value)"
    page.wait(f"{now} > 0.02")
    assert page.value("document.getElementById('scene-play').textContent") == "Pause"
    pressed(page, "#scene-play")
    stopped = page.value(now)
    page.value(AT_REST)
    assert page.value(now) == stopped
    drawn = (
        "[...document.querySelectorAll(\"[data-flight='{}'] .cursor\")]"
        ".map((line) => line.getAttribute('d'))"
    )
    assert all(page.value(drawn.format(0)))
    assert not any(page.value(drawn.format(1)))


def test_the_keyboard_is_enough(page):
    page.value("document.getElementById('viewer').focus()")
    first = seen(page)
    for key in ("ArrowLeft", "ArrowUp", "+"):
        page.call("Input.dispatchKeyEvent", type="keyDown", key=key)
    turned = seen(page)
    page.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
    playing = page.value("document.getElementById('scene-play').getAttribute('aria-pressed')")
    page.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
    assert first != turned
    assert playing == "true"


def test_everything_has_a_name_for_those_who_do_not_see_it(page):
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


def test_it_fits_a_telephone(page):
    page.size(390, 800)
    try:
        assert page.value("document.documentElement.scrollWidth") <= 390
    finally:
        page.size(1000, 700)


def test_printed_it_has_the_picture_in_place_of_the_view(page, tmp_path):
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


def test_after_all_that_the_console_is_empty(page):
    """Last, for it is about all of the above."""
    assert (
        page.of_kind("Runtime.exceptionThrown", "Log.entryAdded", "Runtime.consoleAPICalled") == []
    )


def test_without_webgl_the_picture_stays_and_says_why(product):
    with browser("--disable-3d-apis") as tab:
        tab.open(product.folder / "report.html")
        tab.wait("document.getElementById('viewer-note').textContent.includes('picture')")
        image = "getComputedStyle(document.querySelector('.view img')).visibility"
        assert tab.value(image) == "visible"
        assert tab.of_kind("Runtime.exceptionThrown") == []
