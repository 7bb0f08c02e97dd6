"""The drilling template, read back from its PDF and DXF, against plate and feet."""

import re
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from built_devices import CAGED_DEVICE, DEVICES, device_in_layout
from wheels import paper_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.device_parts import foot_holes
from ocs_design.export.drawing.sheet import (
    HEIGHT,
    THIN,
    WIDTH,
    Area,
    Circle,
    Lettering,
    Line,
    Polyline,
)
from ocs_design.export.drawing.title_block import device_hash
from ocs_design.export.drawing.writers import pdf_of_pages
from ocs_design.export.drilling import CHECK, SHEET, drilling_of, pages
from ocs_design.export.formats import Base, Subject


def subject(device, refused="", com=None):
    seat = Base("trunk", None, com)
    return Subject("dog", device, base=seat, refused=refused)


TRIAD = device_in_layout(Layout(LayoutName.TRIAD))


def thick_circles(page):
    """Circles of the holes, which have thick lines."""
    return [item for item in page if isinstance(item, Circle) and item.pen.width > 0.25]


def lettering(items):
    return " ".join(item.text for item in items if isinstance(item, Lettering))


@pytest.fixture(params=["caged", "on a plate", "triad"])
def device(request):
    return (DEVICES | {"triad": TRIAD})[request.param]


def trunk_holes(device):
    """Places of the holes in the trunk frame [m], of the plate or of the feet."""
    if device.plate is None:
        return [hole for holes in foot_holes(device).values() for hole in holes]
    x, y, _ = device.plate.position
    return [(x + along, y + across) for along, across in device.plate.trunk]


def test_screws_of_the_feet_are_within_reach_of_their_slots():
    """At any incidence the screws are less than 45 degrees from the wheel's axis."""
    pairs = [CAGED_DEVICE.at_incidence(angle) for angle in np.radians([5.0, 40.0, 85.0])]
    for device in (*pairs, TRIAD):
        for module, places in zip(device.modules, foot_holes(device).values(), strict=True):
            offset = np.array(places) - module.position[:2]
            np.testing.assert_allclose(offset.sum(axis=0), 0.0, atol=1e-15)
            along = np.abs(offset @ module.axis[:2]) / np.linalg.norm(offset, axis=1)
            assert (along >= np.sqrt(0.5) - 1e-12).all()


def test_the_pdf_is_in_full_size_with_forward_up(device):
    """The unit of a PDF is 1/72 inch."""
    content = pdf_of_pages(pages(drilling_of(subject(device))), "x").decode("latin-1")
    box = re.search(r"/MediaBox \[ 0 0 (\S+) (\S+) \]", content)
    assert [float(side) * 25.4 / 72.0 for side in box.groups()] == pytest.approx([297.0, 210.0])
    (scale,) = re.findall(r"([\d.]+) 0 0 ([\d.]+) 0 0 cm", content.replace("1 0 0 1 0 0 cm", ""))
    assert [float(factor) for factor in scale] == pytest.approx([72.0 / 25.4] * 2, rel=1e-6)
    (page,) = pages(drilling_of(subject(device)))
    (across, along) = np.array(trunk_holes(device)).T * 1e3
    (left, *_), (_, _, _, bottom) = SHEET, SHEET
    circles = thick_circles(page)
    drawn = np.array([circle.center for circle in circles])
    expected = np.column_stack([-along, -across])
    offset = drawn - expected
    np.testing.assert_allclose(offset, offset[[0]].repeat(len(offset), axis=0), atol=1e-9)
    assert all(circle.radius == pytest.approx(1.25) for circle in circles)
    words = lettering(page)
    assert f"dog: drill {len(circles)} holes of 2.5 mm at the crosses, and tap M3" in words
    assert f"Design {device_hash(device)}." in words
    lines = [line for line in page if isinstance(line, Line) and line.start[1] == line.end[1]]
    below = [line for line in lines if line.start[1] > bottom and line.start[0] == left]
    assert below[0].end[0] - below[0].start[0] == CHECK


def test_coordinates_cover_the_thin_lines(device):
    (page,) = pages(drilling_of(subject(device)))
    numbers = [item for item in page if isinstance(item, Lettering) and item.height == 1.8]
    assert len(numbers) == len(trunk_holes(device))
    last = max(k for k, item in enumerate(page) if isinstance(item, Circle) and item.pen == THIN)
    white = ((k, item) for k, item in enumerate(page) if isinstance(item, Area) and item.white)
    covers = {area.corners[3]: k for k, area in white}
    for text in numbers:
        assert last < covers[text.place] < page.index(text)


def test_a_wide_template_goes_on_several_sheets():
    apart = [
        replace(module, position=module.position * [1.0, 4.0, 1.0])
        for module in CAGED_DEVICE.modules
    ]
    wide = drilling_of(subject(replace(CAGED_DEVICE, modules=tuple(apart))))
    sheets = list(pages(wide))
    for sheet in sheets:
        *_, cover = (k for k, item in enumerate(sheet) if isinstance(item, Area) and item.white)
        assert {y for _, y in sheet[cover].corners} == {SHEET[3], HEIGHT}
        assert "100 %" in lettering(sheet[cover:])
    left, top, right, bottom = SHEET
    assert len(sheets) == 2
    held = [
        sum(
            left <= circle.center[0] <= right and top <= circle.center[1] <= bottom
            for circle in thick_circles(sheet)
        )
        for sheet in sheets
    ]
    assert held == [2, 2]
    assert "Sheet 2 of 2" in lettering(sheets[1])


def test_threads_are_as_deep_as_the_screws_go(device):
    """The longest length of screw beyond plate and sleeve, and a pitch."""
    plate, drilling = device.plate, drilling_of(subject(device))
    screws = (
        [(6.0, 3.0)]
        if plate is None
        else [
            (1e3 * length, 1e3 * (plate.clamped + sleeve))
            for length, sleeve in zip(plate.screw_lengths, plate.sleeves, strict=True)
        ]
    )
    depths = [length - held for length, held in screws]
    assert min(depths) >= 3.0
    words = drilling.words[1]
    shortest, longest = (f"{depth:.1f}" for depth in (min(depths), max(depths)))
    interval = shortest if shortest == longest else f"{shortest} to {longest}"
    assert f"go {interval} mm" in words
    deep, blind = map(float, re.findall(r"([\d.]+) mm deep", words))
    assert max(depths) + 0.5 <= deep + 1e-9 < max(depths) + 0.6 + 1e-9
    assert blind == pytest.approx(deep + 3.0, abs=0.06)


def test_without_a_file_the_frame_is_given_by_the_centre_of_mass():
    first, *_ = drilling_of(subject(DEVICES["caged"], com=(0.0, 0.0, 0.0))).words
    assert "frame of trunk, whose origin is the robot's centre of mass." in first
    first, *_ = drilling_of(subject(DEVICES["caged"], com=(0.01, 0.0, -0.02))).words
    assert "the robot's centre of mass is at x, y, z = 10.0, 0.0, -20.0 mm" in first


def test_one_sheet_is_enough_where_it_has_room_for_the_holes():
    """Feet and plate of a triad are wider than a sheet."""
    drilling = drilling_of(subject(TRIAD))
    wide = Circle((400.0, 0.0), 30.0)
    (page,) = pages(replace(drilling, around=(*drilling.around, wide)))
    left, top, right, bottom = SHEET
    holes = [circle.center for circle in thick_circles(page)]
    shown = [(x, y) for x, y in holes if left <= x <= right and top <= y <= bottom]
    assert len(shown) == len(drilling.holes)


def points_of(item):
    """Points along a line or a circle, closer together than a line is wide."""
    match item:
        case Circle((x, y), radius):
            angles = np.linspace(0.0, 2.0 * np.pi, 3600)
            return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])
        case Line(start, end):
            return np.linspace(start, end, 1000)
        case Polyline(corners):
            return np.concatenate([np.linspace(*side, 1000) for side in pairwise(corners)])
    return np.empty((0, 2))


@pytest.mark.parametrize("apart", [1.0, 4.0], ids=["cropped", "on two sheets"])
def test_nothing_of_the_trunk_shows_beyond_the_frame(apart):
    """Feet once ran over the frame and off the paper, as on Unitree's Go2."""
    modules = (
        replace(module, position=module.position * [1.0, apart, 1.0])
        for module in CAGED_DEVICE.modules
    )
    drilling = drilling_of(subject(replace(CAGED_DEVICE, modules=tuple(modules))))
    wide = Circle((0.0, 0.0), 140.0, THIN)
    left, top, right, bottom = SHEET
    for page in pages(replace(drilling, around=(*drilling.around, wide))):
        covers = [
            (k, np.array(item.corners))
            for k, item in enumerate(page)
            if isinstance(item, Area) and item.white
        ]
        frame = min(
            k for k, item in enumerate(page) if isinstance(item, Line) and item.start == (left, top)
        )
        for k, item in enumerate(page[:frame]):
            x, y = points_of(item).T
            hidden = (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
            for later, corners in covers:
                (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
                if later > k:
                    hidden |= (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
            paper = (x >= 0.0) & (x <= WIDTH) & (y >= 0.0) & (y <= HEIGHT)
            assert (hidden | ~paper).all(), item


def test_bare_wheels_and_tilted_modules_have_no_drilling_template():
    tilted = device_in_layout(Layout(LayoutName.PYRAMID))
    assert foot_holes(tilted) == {}
    for device in (paper_device(), tilted):
        assert drilling_of(subject(device)) is None


def test_dxf_has_the_holes_in_the_frame_of_the_trunk(device, tmp_path):
    pytest.importorskip("ezdxf", reason="ezdxf is the extra [dxf]")
    from ezdxf import recover, units

    from ocs_design.export.dxf import write

    write(subject(device), tmp_path)
    document, auditor = recover.readfile(tmp_path / "drilling.dxf")
    assert not auditor.has_errors
    assert document.units == units.MM
    space = document.modelspace()
    holes = [(e.dxf.center.x, e.dxf.center.y) for e in space.query('CIRCLE[layer=="HOLES"]')]
    np.testing.assert_allclose(holes, 1e3 * np.array(trunk_holes(device)), atol=1e-9)
    axes = space.query('LINE[layer=="AXES"]')
    starts = Counter(tuple(np.round(axis.dxf.start, 6)[:2]) for axis in axes)
    assert {starts[tuple(np.round(hole, 6))] for hole in holes} == {4}
    measured = [e.dxf.start.distance(e.dxf.end) for e in space.query('LINE[layer=="TEXT"]')]
    assert CHECK in [pytest.approx(length) for length in measured]
    words = [e.dxf.text for e in space.query("TEXT")]
    assert any(re.match(r"dog: drill [46] holes of 2.5 mm", text) for text in words)
    assert "forward" in words


def test_the_template_of_an_unbuildable_device_asks_for_no_holes(device):
    """The verdict stands above everything else on each sheet."""
    refused = "NOT buildable as it stands. The feet hang in the air; " + 40 * "give a place "
    for page in pages(drilling_of(subject(device, refused))):
        texts = [item for item in page if isinstance(item, Lettering)]
        order = lettering(sorted(texts, key=lambda text: text.place[1]))
        assert order.startswith("NOT buildable as it stands. The feet hang in the air;")
        assert "drill nothing by this sheet" in order
        assert re.search(r"drill \d", order) is None
        low = max(text.place[1] for text in texts if "give a place" in text.text)
        circles = [item for item in page if isinstance(item, Circle)]
        assert all(circle.center[1] - circle.radius > low for circle in circles)
