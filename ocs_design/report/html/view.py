"""The view of the robot that can be turned, with a picture in its place where it cannot."""

import base64
import json
from collections.abc import Iterator, Sequence

from ocs_design.export.png import png_bytes
from ocs_design.export.snapshot import HEIGHT, WIDTH
from ocs_design.report.bodies import ShownBody, still
from ocs_design.report.html.elements import Markup, data, element, joined, void
from ocs_design.report.story import Story
from ocs_design.report.viewer.encoding import Blob, encoded_scene

_LOOKS = (
    ("Oblique", "home"),
    ("Device", "device"),
    ("Front", "0 0"),
    ("Side", "-1.5708 0"),
    ("Top", "3.1416 1.5"),
)
"""Names of views: azimuth and elevation of the camera seen from the robot [rad], or its aim."""

_SPEEDS = (("1/20", "0.05"), ("1/10", "0.1"), ("1/4", "0.25"), ("1/2", "0.5"), ("real time", "1"))

_DEVICE = (("with the device", "with"), ("without it", "without"), ("both", "both"))

_KEYS = "arrow keys turn it, plus and minus zoom, Home resets, Space plays"

_NOTE = (
    "Drag to turn, with Shift or two fingers to move, pinch or use the wheel after a click to "
    "zoom; on the keyboard the arrows, plus, minus, Home and Space."
)


def view(story: Story, bodies: Sequence[ShownBody], scenarios: Sequence[str]) -> Markup:
    """Picture, canvas and controls; nothing where there are no bodies."""
    if not bodies:
        return Markup("")
    name = f"{story.design.robot.name} with its device, oblique view from the front"
    frame = element(
        "div",
        void(
            "img",
            src=f"data:image/png;base64,{base64.b64encode(png_bytes(still(bodies))).decode('ascii')}",
            alt=name,
            width=str(WIDTH),
            height=str(HEIGHT),
        ),
        element(
            "canvas",
            id="viewer",
            tabindex="0",
            role="img",
            aria_label=f"{name}; {_KEYS}",
            aria_describedby="viewer-note",
        ),
        element("output", id="scene-readout", aria_live="off"),
        class_="view",
    )
    note = element("p", _NOTE, id="viewer-note", class_="note screen")
    return joined((frame, *_controls(scenarios), note))


def view_data(story: Story, bodies: Sequence[ShownBody], scenarios: Sequence[str]) -> Markup:
    """Data that the script shows, at the end of the page, so that the page is there first."""
    if not bodies:
        return Markup("")
    blob = Blob()
    scene = encoded_scene(bodies, story.flights, scenarios, blob)
    numbers = element("script", Markup(blob.text()), type="text/plain", id="scene-numbers")
    return joined((data("scene", json.dumps(scene, separators=(",", ":"))), numbers))


def _controls(scenarios: Sequence[str]) -> Iterator[Markup]:
    looks = (element("button", name, type="button", data_look=look) for name, look in _LOOKS)
    fade = _tick("scene-fade", "see through the robot", checked=False)
    yield element("div", *looks, fade, class_="controls", role="group", aria_label="View")
    if not scenarios:
        return
    flights = (("as designed", ""), *((name, str(i)) for i, name in enumerate(scenarios)))
    yield element(
        "div",
        _choice("scene-choice", "Scenario", flights, chosen=""),
        _choice("scene-device", "Robot", _DEVICE, chosen="with"),
        _choice("scene-speed", "Speed", _SPEEDS, chosen="0.25"),
        _tick("scene-follow", "follow", checked=True),
        class_="controls",
        role="group",
        aria_label="Replay",
    )
    yield element(
        "div",
        element("button", "Play", type="button", id="scene-play", aria_pressed="false"),
        element("label", "Time", for_="scene-time", class_="hidden"),
        Markup(
            '<input type="range" id="scene-time" min="0" max="1" step="0.005" value="0" disabled>'
        ),
        class_="controls time",
    )


def _choice(name: str, label: str, options: tuple[tuple[str, str], ...], *, chosen: str) -> Markup:
    made = (
        element("option", text, value=value, selected=value == chosen) for text, value in options
    )
    return element("label", f"{label} ", element("select", *made, id=name))


def _tick(name: str, label: str, *, checked: bool) -> Markup:
    box = Markup(f'<input type="checkbox" id="{name}"{" checked" if checked else ""}>')
    return element("label", box, f" {label}")
