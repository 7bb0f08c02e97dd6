"""The drawing of the plate under the feet: holes, sizes and mast, read from the sheet."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from built_devices import DEVICES, MAST_PLATE, in_two_rows
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


def test_texts_are_legible_within_the_frame(plate):
    pages = sheets_of(plate)
    assert len(pages) == (1 if plate.mast is None else 2)
    for page in pages:
        check_words(page)


def test_the_table_has_every_hole_of_a_plate_with_its_place(plate):
    """A row of the table consists of the texts at one height."""
    rows = {}
    for item in texts(sheets_of(plate)[0]):
        rows.setdefault(round(item.place[1], 3), []).append((item.place[0], item.text))
    cells = [[text for _, text in sorted(row)] for row in rows.values()]
    holes = [row for row in cells if re.fullmatch(r"[ABC]\d", row[0]) and len(row) == 4]
    listed = {(row[1], float(row[2]), float(row[3])) for row in holes}
    single = plate.single_plates[0]
    expected = {("M3", *np.round(1e3 * np.array(at), 2)) for at in single.feet}
    if plate.mast is None:
        expected |= {("Ø3.4", *np.round(1e3 * np.array(at), 2)) for at in single.trunk}
    for y in (single.across, -single.across) if single.window > 0.0 else ():
        expected.add((f"Ø{2e3 * single.window:.4g}", 0.0, round(1e3 * y, 2)))
    assert listed == expected


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
"""The plate of Unitree's Go2, drawn at half its size, with holes near its edges."""


ANYMAL = replace(
    PLATE,
    radius=0.04305,
    half_length=0.20607,
    neck=0.02325,
    across=0.16302,
    window=0.03405,
    feet=((0.02726, 0.19028), (-0.02726, 0.13576), (0.02726, -0.19028), (-0.02726, -0.13576)),
    trunk=tuple((x, y) for x in (0.015, -0.015) for y in (0.05753, -0.05753)),
    thread="M5",
)
"""The front plate of ANYmal C, drawn at a fifth of its size: names of holes once lay on another."""

TRIAD = replace(
    PLATE,
    radius=0.0383,
    half_length=0.14099,
    neck=0.0201,
    across=0.10269,
    window=0.0293,
    feet=(
        *((0.0239, 0.12659), (-0.0239, 0.07878), (-0.06503, -0.02744)),
        *((-0.11283, -0.07524), (0.11283, -0.07524), (0.06503, -0.02744)),
    ),
    trunk=(
        *((0.015, 0.0484), (-0.04942, -0.01121), (0.03442, -0.03719)),
        *((-0.015, 0.0484), (-0.03442, -0.03719), (0.04942, -0.01121)),
    ),
    sleeves=(0.0,) * 6,
    arms=3,
)
"""The plate of three wheels on Go2, drawn at a fifth of its size."""

CROWDED = {"large": PLATE, "at half its size": GO2, "at a fifth": ANYMAL, "of three feet": TRIAD}


@pytest.mark.parametrize("plate", CROWDED)
def test_names_of_holes_are_clear_of_lines_and_of_each_other(plate):
    plate = CROWDED[plate]
    page = sheets_of(plate)[0]
    check_words(page)
    (ring,) = (item for item in page if isinstance(item, Polyline) and item.pen is OUTLINE)
    sides = [Line(*ends) for ends in pairwise(ring.points)]
    drawn = [item for item in page if isinstance(item, Circle | Line)]
    named = [item for item in texts(page) if re.fullmatch(r"[ABC]\d", item.text)]
    names = [item for item in named if item.height == 1.8]
    assert len(names) == 5 * plate.arms
    for name in names:
        box = box_of(name)
        assert not [line for line in (*sides, *drawn) if covers(line, box)], name


def test_the_outline_drawn_is_that_of_the_plate(plate):
    """The area at the sheet's scale, without the holes, is the volume over the thickness."""
    page = sheets_of(plate)[0]
    scale = next(item.text for item in texts(page) if re.fullmatch(r"\d+:\d+", item.text))
    paper, part = map(int, scale.split(":"))
    (ring,) = (item for item in page if isinstance(item, Polyline) and item.pen is OUTLINE)
    x, y = np.array(ring.points).T
    area = abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2.0
    holes = sum(
        np.pi * item.radius**2
        for item in page
        if isinstance(item, Circle) and item.center[1] < 140.0
    )
    single = plate.single_plates[0]
    volume = part_manifold(plate_part(single)).volume()
    assert (area - holes) * (part / paper) ** 2 == pytest.approx(
        1e6 * volume / single.thickness, rel=1e-3
    )


@pytest.mark.parametrize("outwards", [0.0, 0.008])
def test_plates_that_differ_have_a_sheet_each(outwards):
    """A rear plate whose trunk screws are farther out is not made to the front one's sheet."""
    plates = in_two_rows(PLATE, outwards)
    pages = sheets_of(plates)
    titles = [item.text for page in pages for item in texts(page) if "plate u" in item.text.lower()]
    if outwards:
        assert titles == ["Front plate under the feet", "Rear plate under the feet"]
    else:
        assert titles == ["Plate under the feet, 2 off"]
    # Where they stand: a trunk drilled to the sheet's own table misses them.
    x = PLATE.position[0]
    middles = [f"({1e3 * (x + row):.4g}, 0)" for row in plates.rows]
    notes = " ".join(item.text for page in pages for item in texts(page))
    if not outwards:
        middles = [" and ".join(middles)]
    assert re.findall(r"axes cross at x, y = (.*?) of the base frame", notes) == middles
    for page, plate in zip(pages, plates.single_plates, strict=False):
        words = [item.text for item in texts(page)]
        assert all(f"{1e3 * y:.2f}" in words for _, y in plate.trunk)
        check_words(page)


@pytest.mark.parametrize(("thickness", "deep"), [(3e-3, None), (6e-3, None), (20e-3, 4)])
def test_a_thick_plate_is_not_tapped_right_through(thickness, deep):
    """M3 x 6 through a base of 3 mm reach 3 mm into the plate, and two turns are 1 mm."""
    plate = replace(PLATE, thickness=thickness)
    notes = " ".join(item.text for item in texts(sheets_of(plate)[0]))
    expected = "Holes A are threads M3 right through, for the feet's screws"
    if deep:
        expected = f"drilled right through, with threads M3 at least {deep} deep from above, for"
    assert expected in notes


def test_the_sheet_rounds_the_sizes_as_the_bill_does(plate):
    """Once half a hundredth of a millimetre, as on Unitree's G1, gave 336.80 and 336.79."""
    for variant in (plate, replace(plate, radius=0.0478275, across=0.1205675)):
        words = [item.text for item in texts(sheets_of(variant)[0])]
        numbers = {float(text) for text in words if re.fullmatch(r"[\d.]+", text)}
        assert {float(f"{1e3 * size:.2f}") for size in variant.sizes} <= numbers


def test_a_mast_has_the_lengths_that_it_is_cut_to():
    text = " ".join(item.text for item in texts(sheets_of(MAST_PLATE)[1]))
    mast = MAST_PLATE.mast
    assert f"An upright of {1e3 * (mast.high + mast.below):.4g} and 2 arms" in text
    assert f"arms of {1e3 * (mast.face - mast.side + MAST_PLATE.neck):.5g}" in text
    for z in (mast.high, -mast.below, -0.0689, -0.0889, 0.0):
        assert f"z = {1e3 * z:.2f}" in text


def test_without_a_plate_there_is_no_sheet():
    assert plate_sheets(DEVICES["caged"], "dog") == []


def test_the_drawing_of_an_unbuildable_plate_says_so_first(plate):
    """At the top of each sheet; the first note has the reason and leaves room for the others."""
    device = replace(DEVICES["on a plate"], plate=plate)
    long_reason = " ".join(
        ["NOT buildable as it stands."] + ["One thing; another that cures it."] * 40
    )
    sheets = (plate_sheets(device, "dog", refused) for refused in (REFUSED, long_reason))
    for short, long in zip(*sheets, strict=True):
        check_words(short)
        assert_refused(short)
        check_words(long)
        text = " ".join(item.text for item in texts(long))
        assert "cures it. cad/assembly.pdf has all open points." in text
