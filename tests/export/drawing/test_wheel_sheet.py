"""The drawing of a wheel: legible for any wheel, with its sizes, tolerances, mass and notes."""

import math
import re
from dataclasses import make_dataclass, replace
from itertools import combinations
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from built_devices import DEVICES
from hypothesis import HealthCheck, example, given, settings
from scipy.integrate import quad
from wheel_drawings import (
    CROWDED,
    FLAT,
    HOLED,
    REFUSED,
    WEB,
    assert_refused,
    box_of,
    covers,
    drawings,
    overlap,
    texts,
)
from wheels import paper_device

from ocs_design.actuation.supply import Supply
from ocs_design.export.drawing.sheet import FRAME_BOX, OUTLINE, Circle, Lettering, Line
from ocs_design.export.drawing.title_block import device_hash
from ocs_design.export.drawing.views import AXIS_Y, lay_out, section_view
from ocs_design.export.drawing.wheel import inertia_error, inside_corners
from ocs_design.export.drawing.wheel_sheet import draw_wheel, wheel_drawing, wheel_sheet
from ocs_design.export.drawing.writers import pdf_of_pages
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.rim import Hub
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import Wheel, wheel_parts

RIM = FLAT.wheel.rim


def words(wheel):
    return [text.text for text in texts(wheel_sheet(wheel))]


@pytest.mark.slow
@settings(max_examples=25, suppress_health_check=[HealthCheck.filter_too_much])
@given(drawings())
@example(CROWDED)
def test_any_sheet_is_legible_within_its_frame_and_well_formed(drawing):
    """No text covers another one or a line; both formats are reproducible."""
    items = wheel_sheet(drawing)
    boxes = [(text, box_of(text)) for text in texts(items)]
    for (one, first), (other, second) in combinations(boxes, 2):
        assert not overlap(first, second), (one, other)
    lines = [item for item in items if isinstance(item, Line | Circle)]
    left, top, right, bottom = FRAME_BOX
    for text, box in boxes:
        assert not [line for line in lines if covers(line, box)], text
        x0, y0, x1, y1 = box
        assert left < x0 < x1 < right, text
        assert top < y0 < y1 < bottom, text
    drawn = draw_wheel(drawing)
    assert ET.fromstring(drawn["svg"]).tag.endswith("svg")
    assert drawn["pdf"].startswith(b"%PDF-1.")
    assert drawn == draw_wheel(drawing)


def test_the_drawing_of_an_unbuildable_wheel_says_so_first():
    assert_refused(wheel_sheet(replace(FLAT, refused=REFUSED)))
    assert "NOT" not in " ".join(words(FLAT))


@pytest.mark.parametrize(
    ("drawing", "once", "notes"),
    [
        (
            FLAT,
            [
                "Ø82.60 ±0.04",
                "Ø78.40 shrink fit",
                "Ø24",
                "Ø8 H7 (0/+0.015)",
                "3.05 ±0.03",
                "1.50 ±0.05",
                "8",
            ],
            ["4 × Ø3.4 through", "evenly on Ø16 ±0.1"],
        ),
        (HOLED, ["3 × Ø3.2 through", "6 × Ø12 through", "12 × Ø3"], ["3 deep, both faces"]),
    ],
    ids=["shrunk on", "one piece"],
)
def test_every_size_and_hole_is_written_once(drawing, once, notes):
    written = words(drawing)
    for label in once:
        assert written.count(label) == 1, label
    assert set(notes) <= set(written)


def test_the_yield_strength_is_that_of_the_rim():
    least = "one with a yield strength of at least 250 MPa, as assumed in sizing"
    for drawing, piece in ((FLAT, "Rim's material"), (HOLED, "Material")):
        notes = " ".join(words(replace(drawing, yield_strength=250e6)))
        assert f"{piece}: {least}" in notes


def test_the_material_is_named_as_it_is_ordered():
    """A name such as 304 says neither standard nor condition, and so guarantees no strength."""
    device = DEVICES["caged"]
    device = replace(device, flywheel=replace(device.flywheel, material="steel-4140-qt"))
    notes = " ".join(words(wheel_drawing(device, "dog")))
    assert "42CrMo4+QT (1.7225), EN 10083-3" in notes
    assert "of at least 500 MPa, as assumed in sizing; certificate 3.1 (EN 10204)" in notes


def test_the_title_has_the_number_of_wheels_to_make():
    assert "OCS flywheel, 2 off" in words(wheel_drawing(DEVICES["caged"], "dog"))
    assert "OCS flywheel" in words(FLAT)


@pytest.mark.parametrize(
    ("name", "datum"), [("caged", "bore and hub faces"), ("by its face", "the bore")]
)
def test_hub_faces_are_a_datum_where_screws_clamp_them(name, datum):
    notes = " ".join(words(wheel_drawing(DEVICES[name], "dog")))
    assert f"Run-out of the rim, around and on its faces, to {datum} at most 0.05." in notes


def test_the_dimension_of_the_web_is_clear_of_its_holes():
    holes, layout = HOLED.wheel.web.holes, lay_out(HOLED.wheel)
    view = section_view(HOLED.wheel, layout)
    ((_, y),) = (
        item.place for item in view if isinstance(item, Lettering) and item.text == "1.50 ±0.05"
    )
    offset = abs(AXIS_Y - y) - layout.scale(holes.circle_radius)
    assert abs(offset) > layout.scale(holes.hole_radius) + 1.0


@pytest.mark.parametrize("drawing", [FLAT, HOLED], ids=["shrunk on", "one piece"])
def test_the_note_has_the_change_of_inertia_by_all_tolerances(drawing):
    """Central differences for all sizes, also those without a tolerance on the sheet.

    IT9 of 80 and 60 mm is 74 um; IT7 of 78.4 mm 30 um; IT11 of 10 mm 90 um, of 3.05 mm 75 um; IT12
    of 1.5 mm 100 um. Half of it is written, in whole hundredths of a millimetre.
    """
    wheel, step = drawing.wheel, 1e-6

    def inertia(**changes):
        parts = {"rim": wheel.rim, "web": wheel.web, "hub": wheel.web.hub}
        for key, change in changes.items():
            part, size = key.split("__")
            parts[part] = replace(parts[part], **{size: getattr(parts[part], size) + change})
        web = replace(parts["web"], hub=parts["hub"])
        return total(wheel_parts(Wheel(parts["rim"], web))).inertia[2, 2]

    shrunk = drawing is FLAT
    tolerances = {
        "rim__outer_radius": 0.04e-3 / 2.0 if shrunk else 0.03e-3 / 2.0,
        "rim__inner_radius": 0.03e-3 / 2.0,
        "rim__height": 0.03e-3 if shrunk else 0.04e-3,
        "web__thickness": 0.05e-3,
        "hub__radius": 0.2e-3 / 2.0,
        "hub__height": 0.2e-3,
    }
    change = sum(
        abs(inertia(**{size: step}) - inertia(**{size: -step})) / (2.0 * step) * tolerance
        for size, tolerance in tolerances.items()
    )
    if not shrunk:
        ring = wheel.web.holes
        area = 6.0 * np.pi * 0.0015 * 2700.0
        radius_square = ring.circle_radius**2
        change += (
            area * np.ptp([a**2 * (radius_square + a**2 / 2.0) for a in (5.9e-3, 6.1e-3)]) / 2.0
        )
    expected = change / inertia()
    # Chamfers, and the bolts' holes, are not in the closed form.
    assert inertia_error(wheel) == pytest.approx(expected, rel=0.05)
    assert f"within ±{100.0 * inertia_error(wheel):.2g}" in " ".join(words(drawing))


def test_the_title_block_says_mass_and_inertia():
    written = words(FLAT)
    mass, inertia = (1e3 * sum(FLAT.masses), 1e6 * FLAT.mass_properties.inertia[2, 2])
    assert f"{mass:.4g} g" in written
    assert f"{inertia:.4g} kg mm²" in written
    # A rim of 8000 kg/m^3 and a web of 2700 kg/m^3, as cylinders: chamfers take 2 % of the rim.
    assert mass == pytest.approx(mass_of_cylinders(FLAT.wheel), rel=0.02)
    assert "1:1" in written
    assert "9f3c0a1b2d4e" in written


def test_figures_of_a_large_wheel_are_written_out():
    """Unitree's G1 has 12,800 kg mm²; here 10^5 kg and 10^5 kg m²."""
    written = words(CROWDED)
    assert not [text for text in written if re.search(r"\de\+", text)]


def mass_of_cylinders(wheel):
    """Mass of a wheel of cylinders, without chamfers [g]."""
    rim, web = wheel.rim, wheel.web
    hub = web.hub
    discs = [
        (rim.density, rim.inner_radius, rim.outer_radius, rim.height),
        (web.density, hub.radius, rim.inner_radius, web.thickness),
        (web.density, hub.bore_radius, hub.radius, hub.height),
    ]
    holes = hub.bolts * math.pi * hub.bolt_hole_radius**2 * hub.height * web.density
    return 1e3 * (sum(d * math.pi * (R**2 - r**2) * h for d, r, R, h in discs) - holes)


def test_the_balance_note_has_the_residual_unbalance():
    # 6.3 mm/s / 750 rad/s = 8.4 um.
    text = " ".join(words(FLAT)).replace("\N{NO-BREAK SPACE}", " ")
    assert "G 6.3 (ISO 21940-11) at 7,162 rpm" in text
    assert f"{8.4 * sum(FLAT.masses):.3g} g mm (e = 8.4 µm)" in text


def test_one_piece_is_hatched_as_one_and_has_no_list_of_parts():
    whole = replace(FLAT, wheel=Wheel(RIM, replace(WEB, material=RIM.material)))
    assert "Item" in words(FLAT)
    assert "Item" not in words(whole)
    assert "Ø78.40 ±0.03" in words(whole)
    assert slopes(FLAT) == {-1, 1}
    assert slopes(whole) == {1}


def slopes(wheel):
    """Slopes of the hatching: -1 falls to the right on paper, 1 rises."""
    senses = set()
    for item in wheel_sheet(wheel):
        if isinstance(item, Line):
            across, down = item.end[0] - item.start[0], item.end[1] - item.start[1]
            if item.pen.width < 0.3 and abs(abs(across) - abs(down)) < 1e-9 and across:
                senses.add(-1 if across * down > 0 else 1)
    return senses


def test_the_front_view_is_to_scale():
    radii = [item.radius for item in wheel_sheet(FLAT) if isinstance(item, Circle)]
    for expected in (41.3, 39.2, 12.0, 4.0, 1.7, 8.0):
        assert any(abs(expected - radius) < 1e-9 for radius in radii), expected


def test_rim_and_web_of_a_shrink_fit_have_limits_of_their_own():
    """Interference of 42 to 80 um over 78.4 mm, of which IT6 takes 19 um for each part."""
    fit = replace(FLAT, interference=(42e-6, 80e-6))
    written = words(fit)
    assert "Rim, bore Ø78.400 to 78.419" in written
    assert "Web with hub, Ø78.461 to 78.480" in written
    assert "Ra 3.2, all fits Ra 1.6 (ISO 21920)" in written
    assert "Ra 3.2, bore Ra 1.6 (ISO 21920)" in words(HOLED)
    assert {"Rim", "Web with hub"} <= set(words(FLAT))


def test_names_are_escaped_in_both_formats():
    drawn = draw_wheel(replace(FLAT, robot='<a> & (b) \\ "é" 机'))
    root = ET.fromstring(drawn["svg"])
    assert '<a> & (b) \\ "é" ?' in [element.text for element in root]
    assert rb'(<a> & \(b\) \\ "\351" ?) Tj' in drawn["pdf"]


def test_both_formats_show_the_same_texts():
    drawn = draw_wheel(FLAT)
    root = ET.fromstring(drawn["svg"])
    texts = [element for element in root if element.tag.endswith("text")]
    in_svg = [text.text for text in texts if text.text]
    strings = re.findall(rb"\(((?:[^()\\]|\\.)*)\) Tj", drawn["pdf"])
    plain = (re.sub(rb"\\([()\\])", rb"\1", string) for string in strings)
    decoded = [
        re.sub(rb"\\(\d{3})", lambda code: bytes([int(code[1], 8)]), string).decode("cp1252")
        for string in plain
    ]
    assert in_svg == [text for text in decoded if text]
    assert in_svg == [
        item.text for item in wheel_sheet(FLAT) if isinstance(item, Lettering) and item.text
    ]


SMALL_HUB = replace(FLAT, wheel=Wheel(RIM, replace(WEB, hub=Hub(0.004, 0.005, 0.002))))


@pytest.mark.parametrize(
    "drawing", [FLAT, HOLED, SMALL_HUB], ids=["shrunk on", "one piece", "small hub"]
)
def test_the_note_has_the_inertia_of_rounded_corners(drawing):
    """The inertia 2 pi rho x^3 dz of a rounded corner of radius R, integrated over its width."""
    wheel = drawing.wheel
    web, rim = wheel.web, wheel.rim
    radius, share = inside_corners(wheel)
    corners = [(web.hub.radius, 1.0)] + [(rim.inner_radius, -1.0)] * (not wheel.shrunk_on)

    def ring(offset, corner, sense):
        height = radius - math.sqrt(radius**2 - (radius - offset) ** 2)
        return 2.0 * math.pi * web.density * (corner + sense * offset) ** 3 * height

    added = [2.0 * quad(ring, 0.0, radius, args=corner)[0] for corner in corners]
    inertia = drawing.mass_properties.inertia[2, 2]
    assert radius == pytest.approx(0.4e-3)
    assert share == pytest.approx(sum(added) / inertia, rel=1e-2)
    text = " ".join(words(drawing))
    # What a hub alone adds is not worth a note.
    assert ("of inertia)" in text) == (share > 1e-5)
    assert share <= 1e-5 or f"(+{100.0 * share:.2g} % of inertia)" in text
    assert "e-0" not in text


def test_rounded_corners_are_at_most_half_their_step():
    low, level = (
        replace(WEB, hub=replace(WEB.hub, height=WEB.thickness + step)) for step in (0.5e-3, 0.0)
    )
    assert inside_corners(replace(FLAT.wheel, web=low))[0] == pytest.approx(0.25e-3)
    assert inside_corners(replace(FLAT.wheel, web=level)) == (0.0, 0.0)


def test_the_hub_has_a_note_on_its_joint():
    bare = replace(FLAT, wheel=Wheel(RIM, replace(WEB, hub=replace(WEB.hub, bolts=0))))
    for drawing, note in (
        (replace(bare, on_shaft=True), "bonded on the motor's shaft"),
        (bare, "a pilot hole"),
        (FLAT, "a pilot hole"),
    ):
        assert note in " ".join(text.text for text in texts(wheel_sheet(drawing)))
    on_shaft = texts(wheel_sheet(replace(FLAT, on_shaft=True)))
    assert not [text for text in on_shaft if "pilot" in text.text or "bolt circle" in text.text]


NUMBER = rb"-?\d*\.?\d+"


def test_lines_and_circles_of_the_pdf_are_those_of_the_sheet():
    """Coordinates of a PDF start at the bottom; a circle starts at its right."""
    pdf = draw_wheel(FLAT)["pdf"]
    lines = [(*item.start, *item.end) for item in wheel_sheet(FLAT) if isinstance(item, Line)]
    drawn = re.findall(rb"n (%b) (%b) m (%b) (%b) l S" % ((NUMBER,) * 4), pdf)
    expected = np.array(lines) * [1, -1, 1, -1] + [0, 210, 0, 210]
    np.testing.assert_allclose(np.array(drawn, float), expected, atol=1e-4)
    content = pdf_of_pages([[Circle((100.0, 60.0), 40.0, OUTLINE)]], "")
    start = re.search(rb"n\s(%b) (%b) m\s" % (NUMBER, NUMBER), content).groups()
    assert [float(number) for number in start] == pytest.approx([140.0, 150.0])


DEVICE = paper_device()


def test_mass_and_inertia_are_the_designed_ones():
    drawing = wheel_drawing(DEVICE, "solo12")
    drawn, wheel = drawing.mass_properties, DEVICE.flywheel
    assert drawn.mass == pytest.approx(wheel.mass, rel=1e-9)
    rotor = DEVICE.motor.rotor_inertia
    assert drawn.inertia[2, 2] == pytest.approx(wheel.spin_inertia - rotor, rel=1e-9)
    assert drawn.inertia[0, 0] == pytest.approx(wheel.transverse_inertia, rel=1e-9)


def test_the_hash_follows_everything_that_is_drawn():
    """It changes with all drawn parts and sizes, but not with the supply."""
    built = DEVICES["on a plate"]
    pedestal = Pedestal(0.027, 0.02, 0.05, 0.5, 0.04)
    others = [
        replace(built, flywheel=replace(built.flywheel, height=0.02)),
        replace(built, plate=replace(built.plate, thickness=0.005)),
        replace(built, plate=None),
        replace(built, plate=None, pedestals=(pedestal,)),
        replace(built, guard_wall=0.0015),
        replace(built, foot_plate=0.006),
        built.at_incidence(0.3),
    ]
    assert len({device_hash(device) for device in (built, *others)}) == 1 + len(others)
    assert device_hash(built) == device_hash(replace(built, supply=Supply(24.0)))
    backwards = make_dataclass("Backwards", reversed(vars(built.motor)))(**vars(built.motor))
    assert device_hash(built) == device_hash(replace(built, motor=backwards))
    assert len(device_hash(built)) == 12


@pytest.mark.parametrize(("no_load_speed", "expected"), [(math.inf, None), (800.0, 800.0)])
def test_an_infinite_speed_is_not_drawn(no_load_speed, expected):
    motor = replace(DEVICE.motor, no_load_speed=no_load_speed, speed_max=None)
    device = replace(DEVICE, motor=motor)
    assert wheel_drawing(device, "x").speed == expected
