"""The drawing of the guard ring: its sizes against its solid, its drum and its wheel."""

import re
from dataclasses import replace
from itertools import combinations
from math import pi
from xml.etree import ElementTree as ET

import pytest
from built_devices import DEVICES
from wheel_drawings import REFUSED, assert_refused, box_of, check_words, covers, overlap, texts

from ocs_design.export.assembly.steps import HAND_STRIP
from ocs_design.export.drawing.guard_sheet import guard_sheet
from ocs_design.export.drawing.sheet import Circle, Line
from ocs_design.export.drawing.title_block import device_hash
from ocs_design.export.drawing.wheel_sheet import write
from ocs_design.export.formats import Base, Subject
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.housing import guard_ring

RINGED = DEVICES["in a guard ring"]


def lettering(device):
    return " ".join(item.text for item in texts(guard_sheet(device, "dog")))


OUTSIDE, WALL, HEIGHT = -0.2, 0.1, -0.3
"""Deviations that tell the three sizes of a ring apart [mm]."""


def limits(deviation, words):
    """Nominal value of the size with this deviation, and its other limit [mm]."""
    (nominal,) = re.findall(r"([\d.]+) " + re.escape(f"(0/{deviation:+g})"), words)
    return float(nominal), float(nominal) + deviation


@pytest.mark.parametrize("wall", [0.7e-3, 1.5e-3, 6e-3])
def test_any_ring_is_legible_within_the_frame(wall):
    page = guard_sheet(replace(RINGED, guard_wall=wall), "dog")
    check_words(page)
    boxes = [(text, box_of(text)) for text in texts(page)]
    for (one, first), (other, second) in combinations(boxes, 2):
        assert not overlap(first, second), (one, other)
    lines = [item for item in page if isinstance(item, Line | Circle)]
    for text, box in boxes:
        assert not [line for line in lines if covers(line, box)], text


def test_sizes_on_the_sheet_are_those_of_the_solid():
    """Mass from the labels, and from the mesh, with the density of steel."""
    words = lettering(RINGED)
    outside, wall, height = (limits(size, words)[0] for size in (OUTSIDE, WALL, HEIGHT))
    mass = float(re.search(r"([\d.]+) g\b", words)[1])
    assert mass == pytest.approx(7.85e-3 * pi * (outside - wall) * wall * height, rel=1e-3)
    volume = part_manifold(guard_ring(RINGED.foot.housing)).volume()
    assert mass == pytest.approx(7850e3 * volume, rel=1e-3)
    assert f"Ø{outside - 2.0 * wall:.4g}" in words
    length = float(re.search(r"([\d.]+) long", words)[1])
    assert length == pytest.approx(pi * (outside - wall), abs=0.1)
    assert f"{wall:g} × {height:g}, {length} long" in words
    assert "Guard ring, 2 off" in words
    assert device_hash(RINGED) in words


def test_the_ring_goes_into_its_drum_at_the_worst_of_its_tolerances():
    """With glue around it it fits, keeps the wheel free where it touches the drum, and lets the lid
    lie flat; no wall is thinner than sized."""
    words, housing = lettering(RINGED), RINGED.foot.housing
    bore, rim = 2e3 * housing.inner_radius, 1e3 * housing.rim_radius
    wide, narrow = limits(OUTSIDE, words)
    thin, thick = limits(WALL, words)
    assert wide + 0.2 == pytest.approx(bore, abs=0.006)
    assert thin == pytest.approx(1e3 * RINGED.guard_wall)
    # Pushed against the drum on one side, its far inside is nearest to the rim.
    assert narrow - bore / 2.0 - thick - rim >= 1e3 * HAND_STRIP - 0.01
    highest, _ = limits(HEIGHT, words)
    assert highest == pytest.approx(1e3 * housing.rim_height + 4.0, abs=0.006)


def test_the_drawing_is_written_in_both_formats(tmp_path):
    write(Subject("dog", RINGED, base=Base("trunk", None)), tmp_path)
    svg, pdf = (tmp_path / f"guard_ring.{suffix}" for suffix in ("svg", "pdf"))
    assert ET.fromstring(svg.read_text(encoding="utf-8")).tag.endswith("svg")
    assert pdf.read_bytes().startswith(b"%PDF-1.")
    assert guard_sheet(DEVICES["caged"], "dog") == []


def test_the_drawing_of_an_unbuildable_ring_says_so_first():
    page = guard_sheet(RINGED, "dog", REFUSED)
    check_words(page)
    assert_refused(page)
