"""The drawing of the plate under the feet: its holes, sizes and mast, from the sheet alone."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from built_devices import DEVICES, MAST_PLATE
from wheel_drawings import REFUSED, assert_refused, box_of, check_words, covers, texts

from ocs_design.export.drawing.plate_sheet import plate_sheets
from ocs_design.export.drawing.sheet import OUTLINE, Circle, Line, Polyline
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.carrier_plate import plate_part

PLATE = DEVICES["on a plate"].plate
PLATES = {"on the trunk": PLATE, "on a mast": MAST_PLATE}


@pytest.fixture(params=PLATES, ids=str)
def plate(request):
    return PLATES[request.param]


def sheets_of(plate):
    return plate_sheets(replace(DEVICES["on a plate"], plate=plate), "dog")


def test_all_words_are_within_the_frame_and_none_on_another(plate):
    pages = sheets_of(plate)
    assert len(pages) == (1 if plate.mast is None else 2)
    for page in pages:
        check_words(page)


def test_the_table_has_every_hole_of_one_plate_where_it_is(plate):
    """Read as a machinist does: a row is what stands at one height."""
    rows = {}
    for item in texts(sheets_of(plate)[0]):
        rows.setdefault(round(item.place[1], 3), []).append((item.place[0], item.text))
    cells = [[text for _, text in sorted(row)] for row in rows.values()]
    holes = [row for row in cells if re.fullmatch(r"[ABC]\d", row[0]) and len(row) == 4]
    found = {(row[1], float(row[2]), float(row[3])) for row in holes}
    own = plate.each[0]
    wanted = {("M3", *np.round(1e3 * np.array(at), 2)) for at in own.feet}
    if plate.mast is None:
        wanted |= {("Ø3.4", *np.round(1e3 * np.array(at), 2)) for at in own.trunk}
    for y in (own.across, -own.across) if own.window > 0.0 else ():
        wanted.add((f"Ø{2e3 * own.window:.4g}", 0.0, round(1e3 * y, 2)))
    assert found == wanted


GO2 = replace(
    PLATE,
    radius=0.03816,
    half_length=0.12709,
    neck=0.0201,
    across=0.08893,
    window=0.02916,
    feet=((0.0238, 0.11273), (-0.0238, 0.06513), (0.0238, -0.11273), (-0.0238, -0.06513)),
    trunk=tuple((x, y) for x in (0.015, -0.015) for y in (0.0383, -0.0383)),
)
"""The plate of Unitree's Go2, drawn at half its size: holes are near its edges."""


@pytest.mark.parametrize("plate", [PLATE, GO2], ids=["large", "at half its size"])
def test_no_name_of_a_hole_stands_on_an_outline(plate):
    page = sheets_of(plate)[0]
    (ring,) = (item for item in page if isinstance(item, Polyline) and item.pen is OUTLINE)
    sides = [Line(*ends) for ends in pairwise(ring.points)]
    circles = [item for item in page if isinstance(item, Circle) and item.center[1] < 140.0]
    named = [item for item in texts(page) if re.fullmatch(r"[ABC]\d", item.text)]
    names = [item for item in named if item.height == 1.8]
    assert len(names) == 10
    for name in names:
        box = box_of(name)
        assert not [line for line in (*sides, *circles) if covers(line, box)], name


def test_the_outline_drawn_is_that_of_the_plate(plate):
    """Its area at the sheet's scale, less that of the holes, is the volume over the thickness."""
    page = sheets_of(plate)[0]
    scale = next(item.text for item in texts(page) if re.fullmatch(r"\d+:\d+", item.text))
    paper, part = map(int, scale.split(":"))
    (ring,) = (item for item in page if isinstance(item, Polyline) and item.pen is OUTLINE)
    x, y = np.array(ring.points).T
    area = abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2.0
    cut = sum(
        np.pi * item.radius**2
        for item in page
        if isinstance(item, Circle) and item.center[1] < 140.0
    )
    own = plate.each[0]
    volume = part_manifold(plate_part(own)).volume()
    assert (area - cut) * (part / paper) ** 2 == pytest.approx(
        1e6 * volume / own.thickness, rel=1e-3
    )


@pytest.mark.parametrize("inwards", [0.0, 0.008])
def test_plates_that_differ_have_a_sheet_each(inwards):
    """A rear plate whose trunk screws are farther out is not made to the front one's sheet."""
    front, rear = 0.1, -0.1
    twice = replace(
        PLATE,
        rows=(front, rear),
        feet=tuple((x + row, y) for row in (front, rear) for x, y in PLATE.feet),
        trunk=tuple((x + front, y) for x, y in PLATE.trunk)
        + tuple((x + rear, y + inwards * np.sign(y)) for x, y in PLATE.trunk),
        sleeves=PLATE.sleeves * 2,
    )
    pages = sheets_of(twice)
    titles = [item.text for page in pages for item in texts(page) if "plate u" in item.text.lower()]
    if inwards:
        assert titles == ["Front plate under the feet", "Rear plate under the feet"]
    else:
        assert titles == ["Plate under the feet, 2 off"]
    for page, plate in zip(pages, twice.each, strict=False):
        said = [item.text for item in texts(page)]
        assert all(f"{1e3 * y:.2f}" in said for _, y in plate.trunk)
        check_words(page)


def test_the_sheet_rounds_the_sizes_as_the_bill_does(plate):
    """Half a hundredth of a millimetre, as Unitree's G1 has it, came out as 336.80 and 336.79."""
    for each in (plate, replace(plate, radius=0.0478275, across=0.1205675)):
        said = [item.text for item in texts(sheets_of(each)[0])]
        found = {float(text) for text in said if re.fullmatch(r"[\d.]+", text)}
        assert {float(f"{1e3 * size:.2f}") for size in each.sizes} <= found


def test_a_mast_has_the_lengths_that_it_is_cut_to():
    said = " ".join(item.text for item in texts(sheets_of(MAST_PLATE)[1]))
    mast = MAST_PLATE.mast
    assert f"An upright of {1e3 * (mast.high + mast.below):.4g} and 2 arms" in said
    assert f"arms of {1e3 * (mast.face - mast.side + MAST_PLATE.neck):.5g}" in said
    for z in (mast.high, -mast.below, -0.0689, -0.0889, 0.0):
        assert f"z = {1e3 * z:.2f}" in said


def test_without_a_plate_there_is_no_sheet():
    assert plate_sheets(DEVICES["caged"], "dog") == []


def test_a_plate_that_is_not_to_be_made_says_so_first(plate):
    """At the top of each sheet, and why in its first note, which leaves the others their room."""
    device = replace(DEVICES["on a plate"], plate=plate)
    many = " ".join(["NOT buildable as it stands."] + ["One thing; another that cures it."] * 40)
    sheets = (plate_sheets(device, "dog", refused) for refused in (REFUSED, many))
    for short, long in zip(*sheets, strict=True):
        check_words(short)
        assert_refused(short)
        check_words(long)
        said = " ".join(item.text for item in texts(long))
        assert "cures it. cad/assembly.pdf has all open points." in said
