"""The drilling template, read again from its PDF and DXF, against plate and feet."""

import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from built_devices import CAGED_DEVICE, DEVICES, device_in_layout
from wheels import paper_device

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.device_parts import foot_holes
from ocs_design.export.drawing.sheet import HEIGHT, THIN, Area, Circle, Lettering, Line
from ocs_design.export.drawing.writers import pdf_of_pages
from ocs_design.export.drilling import CHECK, SHEET, drilling_of, pages
from ocs_design.export.formats import Base, Subject


def subject(device, refused="", com=None):
    seat = Base("trunk", None, com)
    return Subject("dog", device, base=seat, refused=refused)


TRIAD = device_in_layout(Layout(LayoutName.TRIAD))


@pytest.fixture(params=["caged", "on a plate", "triad"])
def device(request):
    return (DEVICES | {"triad": TRIAD})[request.param]


def trunk_holes(device):
    """Where they must be [mm], by what carries the feet."""
    if device.plate is None:
        return [place for places in foot_holes(device).values() for place in places]
    x, y, _ = device.plate.position
    return [(x + along, y + across) for along, across in device.plate.trunk]


def test_screws_of_the_feet_are_within_reach_of_their_slots():
    """At any incidence: less than 45 degrees from the wheel's axis, on the slots' circle."""
    pairs = [CAGED_DEVICE.at_incidence(each) for each in np.radians([5.0, 40.0, 85.0])]
    for turned in (*pairs, TRIAD):
        for module, places in zip(turned.modules, foot_holes(turned).values(), strict=True):
            off = np.array(places) - module.position[:2]
            np.testing.assert_allclose(off.sum(axis=0), 0.0, atol=1e-15)
            along = np.abs(off @ module.axis[:2]) / np.linalg.norm(off, axis=1)
            assert (along >= np.sqrt(0.5) - 1e-12).all()


def test_on_paper_the_holes_are_in_full_size_with_forward_up(device):
    """A PDF's unit is a 72nd of an inch."""
    content = pdf_of_pages(pages(drilling_of(subject(device))), "x").decode("latin-1")
    box = re.search(r"/MediaBox \[ 0 0 (\S+) (\S+) \]", content)
    assert [float(each) * 25.4 / 72.0 for each in box.groups()] == pytest.approx([297.0, 210.0])
    (scale,) = re.findall(r"([\d.]+) 0 0 ([\d.]+) 0 0 cm", content.replace("1 0 0 1 0 0 cm", ""))
    assert [float(each) for each in scale] == pytest.approx([72.0 / 25.4] * 2, rel=1e-6)
    (page,) = pages(drilling_of(subject(device)))
    (across, along) = np.array(trunk_holes(device)).T * 1e3
    (left, *_), (_, _, _, bottom) = SHEET, SHEET
    thick = [each for each in page if isinstance(each, Circle) and each.pen.width > 0.25]
    found = np.array([each.center for each in thick])
    expected = np.column_stack([-along, -across])
    offset = found - expected
    np.testing.assert_allclose(offset, offset[[0]].repeat(len(offset), axis=0), atol=1e-9)
    assert all(each.radius == pytest.approx(1.25) for each in thick)
    words = " ".join(each.text for each in page if isinstance(each, Lettering))
    assert f"dog: drill {len(thick)} holes of 2.5 mm at the crosses, and tap M3" in words
    levels = [each for each in page if isinstance(each, Line) and each.start[1] == each.end[1]]
    below = [each for each in levels if each.start[1] > bottom and each.start[0] == left]
    assert below[0].end[0] - below[0].start[0] == CHECK


def test_thin_lines_end_at_coordinates(device):
    (page,) = pages(drilling_of(subject(device)))
    numbers = [each for each in page if isinstance(each, Lettering) and each.height == 1.8]
    assert len(numbers) == len(trunk_holes(device))
    last = max(k for k, each in enumerate(page) if isinstance(each, Circle) and each.pen == THIN)
    white = ((k, each) for k, each in enumerate(page) if isinstance(each, Area) and each.white)
    covers = {each.corners[3]: k for k, each in white}
    for text in numbers:
        assert last < covers[text.place] < page.index(text)


def test_what_is_wider_than_a_sheet_goes_on_several():
    apart = [
        replace(module, position=module.position * [1.0, 4.0, 1.0])
        for module in CAGED_DEVICE.modules
    ]
    wide = drilling_of(subject(replace(CAGED_DEVICE, modules=tuple(apart))))
    sheets = list(pages(wide))
    for sheet in sheets:
        *_, cover = (k for k, each in enumerate(sheet) if isinstance(each, Area) and each.white)
        assert {y for _, y in sheet[cover].corners} == {SHEET[3], HEIGHT}
        assert any("100 %" in each.text for each in sheet[cover:] if isinstance(each, Lettering))
    left, top, right, bottom = SHEET
    assert len(sheets) == 2
    held = [
        sum(
            left <= each.center[0] <= right and top <= each.center[1] <= bottom
            for each in sheet
            if isinstance(each, Circle) and each.pen.width > 0.25
        )
        for sheet in sheets
    ]
    assert held == [2, 2]
    assert "Sheet 2 of 2" in " ".join(
        each.text for each in sheets[1] if isinstance(each, Lettering)
    )


def test_threads_are_as_deep_as_the_screws_go(device):
    """The longest reach beyond plate and sleeve, and a pitch."""
    plate, drilling = device.plate, drilling_of(subject(device))
    screws = (
        [(6.0, 3.0)]
        if plate is None
        else [
            (1e3 * length, 1e3 * (plate.clamped + sleeve))
            for length, sleeve in zip(plate.screw_lengths, plate.sleeves, strict=True)
        ]
    )
    reach = [length - held for length, held in screws]
    assert min(reach) >= 3.0
    said = drilling.words[1]
    assert (
        f"go {' to '.join(dict.fromkeys(f'{x:.1f}' for x in (min(reach), max(reach))))} mm" in said
    )
    deep, blind = map(float, re.findall(r"([\d.]+) mm deep", said))
    assert max(reach) + 0.5 <= deep + 1e-9 < max(reach) + 0.6 + 1e-9
    assert blind == pytest.approx(deep + 3.0, abs=0.06)


def test_by_hand_the_frame_is_told_by_the_centre_of_mass():
    first, *_ = drilling_of(subject(DEVICES["caged"], com=(0.0, 0.0, 0.0))).words
    assert "frame of trunk, whose origin is the robot's centre of mass." in first
    first, *_ = drilling_of(subject(DEVICES["caged"], com=(0.01, 0.0, -0.02))).words
    assert "the robot's centre of mass is at x, y, z = 10.0, 0.0, -20.0 mm" in first


def test_one_sheet_is_enough_where_it_has_room_for_the_holes():
    """Feet and plate of a triad are wider than a sheet."""
    drilling = drilling_of(subject(TRIAD))
    far = Circle((400.0, 0.0), 30.0)
    (page,) = pages(replace(drilling, around=(*drilling.around, far)))
    left, top, right, bottom = SHEET
    holes = [each.center for each in page if isinstance(each, Circle) and each.pen.width > 0.25]
    shown = [each for each in holes if left <= each[0] <= right and top <= each[1] <= bottom]
    assert len(shown) == len(drilling.holes)


def test_wheels_alone_and_modules_that_do_not_stand_have_no_holes_in_the_trunk():
    leaning = device_in_layout(Layout(LayoutName.PYRAMID))
    assert foot_holes(leaning) == {}
    for device in (paper_device(), leaning):
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
    starts = Counter(tuple(np.round(each.dxf.start, 6)[:2]) for each in axes)
    assert {starts[tuple(np.round(each, 6))] for each in holes} == {4}
    measured = [e.dxf.start.distance(e.dxf.end) for e in space.query('LINE[layer=="TEXT"]')]
    assert CHECK in [pytest.approx(each) for each in measured]
    words = [e.dxf.text for e in space.query("TEXT")]
    assert any(re.match(r"dog: drill [46] holes of 2.5 mm", each) for each in words)
    assert "forward" in words


def test_what_cannot_be_built_is_not_drilled(device):
    """The verdict stands above everything else on each sheet, and no hole is asked for."""
    refused = "NOT buildable as it stands. The feet hang in the air; " + 40 * "give a place "
    for page in pages(drilling_of(subject(device, refused))):
        texts = [each for each in page if isinstance(each, Lettering)]
        order = " ".join(each.text for each in sorted(texts, key=lambda each: each.place[1]))
        assert order.startswith("NOT buildable as it stands. The feet hang in the air;")
        assert "drill nothing by this sheet" in order
        assert re.search(r"drill \d", order) is None
        low = max(each.place[1] for each in texts if "give a place" in each.text)
        shown = [each for each in page if isinstance(each, Circle)]
        assert all(each.center[1] - each.radius > low for each in shown)
