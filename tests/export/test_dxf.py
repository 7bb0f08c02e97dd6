"""DXF of the wheel's pieces, read back by ezdxf, against the closed form."""

import hashlib
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from sample_parts import ONE_PIECE, RIM_ALONE, TWO_PIECES, WEB

from ocs_design.common.units import MILLIMETRES
from ocs_design.export.meshes import part_mesh
from ocs_design.export.stl import stl_bytes
from ocs_design.parts.rim import RimCuts
from ocs_design.parts.wheel import Wheel, wheel_parts

pytest.importorskip("ezdxf", reason="ezdxf is the extra [dxf]")
from ezdxf import recover, units
from ezdxf.bbox import extents

from ocs_design.export.dxf import dxf_text

PIECES = {
    f"{name}_{piece.name}": piece
    for name, wheel in {"two": TWO_PIECES, "one": ONE_PIECE, "rim": RIM_ALONE}.items()
    for piece in wheel_parts(wheel)
}


def read(piece, folder):
    """The piece's document; ezdxf finds nothing to fix."""
    path = folder / "piece.dxf"
    path.write_text(dxf_text(piece), encoding="utf-8")
    document, auditor = recover.readfile(path)
    assert not auditor.has_errors
    assert not auditor.has_fixes
    return document


def on_layer(document, layer, kind):
    return document.modelspace().query(f'{kind}[layer=="{layer}"]')


@pytest.mark.parametrize("piece", PIECES.values(), ids=PIECES)
def test_section_and_holes_have_the_volume_of_the_piece(piece, tmp_path):
    """Pappus: the section's volume of revolution, less the holes, is the volume of the piece."""
    document = read(piece, tmp_path)
    assert document.units == units.MM
    (section,) = on_layer(document, "SECTION", "LWPOLYLINE")
    points = np.array(section.get_points("xy"))
    x, r = points.T
    following = np.roll(points, -1, axis=0)
    cross = x * following[:, 1] - following[:, 0] * r
    swept = 2.0 * np.pi * abs(np.sum(cross * (r + following[:, 1])) / 6.0)
    holes = [part.outline.points.tobytes() for part in piece.cut]
    drawn = on_layer(document, "HOLES", "LWPOLYLINE")
    assert len(drawn) == len(set(holes))
    lengths = dict.fromkeys(holes, 0.0)
    for key, cut in zip(holes, piece.cut, strict=True):
        lengths[key] += 1e3 * (cut.high - cut.low)
    removed = sum(
        enclosed_area(outline) * length
        for outline, length in zip(drawn, lengths.values(), strict=True)
    )
    exact = piece.mass_properties().mass / piece.density
    assert (swept - removed) * 1e-9 == pytest.approx(exact, rel=1e-9)


def enclosed_area(polyline):
    """Area of a closed polyline: the polygon's and that between its arcs and their chords."""
    points = np.array(polyline.get_points("xyb"))
    start, end, bulge = points[:, :2], np.roll(points[:, :2], -1, axis=0), points[:, 2]
    angle = 4.0 * np.arctan(bulge)
    radius = np.linalg.norm(end - start, axis=1) / (2.0 * np.sin(angle / 2.0))
    polygon = np.sum(start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1]) / 2.0
    return polygon + np.sum(radius**2 * (angle - np.sin(angle))) / 2.0


def test_holes_are_where_the_wheel_has_them(tmp_path):
    document = read(wheel_parts(TWO_PIECES)[1], tmp_path)
    drawn = np.array([hole.get_points("xyb") for hole in on_layer(document, "HOLES", "LWPOLYLINE")])
    # Two half circles each, which bulge by 1.
    np.testing.assert_array_equal(drawn[:, :, 2], 1.0)
    radii = np.linalg.norm(np.diff(drawn[:, :, :2], axis=1)[:, 0], axis=1) / 2.0
    centres = drawn[:, :, :2].mean(axis=1)
    for ring in (WEB.hub.bolt_ring, WEB.holes):
        of_ring = centres[np.isclose(radii, 1e3 * ring.hole_radius)]
        assert len(of_ring) == ring.count
        np.testing.assert_allclose(np.linalg.norm(of_ring, axis=1), 1e3 * ring.circle_radius)
        angles = np.sort(np.mod(np.degrees(np.arctan2(of_ring[:, 1], of_ring[:, 0])), 360.0))
        np.testing.assert_allclose(np.diff(angles), 360.0 / ring.count)
    assert len(drawn) == WEB.hub.bolts + WEB.holes.count


def test_blind_holes_of_both_faces_are_drawn_once(tmp_path):
    (piece,) = wheel_parts(Wheel(replace(RIM_ALONE.rim, cuts=RimCuts(0.0, 5, 5e-4, 1e-3))))
    assert len(piece.cut) == 10
    assert len(on_layer(read(piece, tmp_path), "HOLES", "LWPOLYLINE")) == 5


def test_the_outline_has_the_diameters_of_the_rim(tmp_path):
    document, rim = read(wheel_parts(RIM_ALONE)[0], tmp_path), RIM_ALONE.rim
    outline = on_layer(document, "OUTLINE", "CIRCLE")
    radii = sorted(circle.dxf.radius for circle in outline)
    assert radii == pytest.approx([1e3 * rim.inner_radius, 1e3 * rim.outer_radius])
    front = extents(outline)
    section = extents(on_layer(document, "SECTION", "LWPOLYLINE"))
    assert section.extmin.x > front.extmax.x + 10.0


def test_bytes_are_the_same_in_every_process():
    """Also with another order of sets."""
    code = (
        "import hashlib; from sample_parts import TWO_PIECES; from ocs_design.export.dxf import "
        "dxf_text; from ocs_design.parts.wheel import wheel_parts; "
        "print(hashlib.sha256(dxf_text(wheel_parts(TWO_PIECES)[0]).encode()).hexdigest())"
    )
    path = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": path}
    process = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    here = hashlib.sha256(dxf_text(wheel_parts(TWO_PIECES)[0]).encode()).hexdigest()
    assert process.stdout.strip() == here


@pytest.mark.parametrize("name", ["two_rim", "two_hub", "one_wheel", "rim_rim"])
def test_the_section_is_that_of_the_stl_file(name, tmp_path):
    """A half plane that meets no hole cuts the STL along the section: same corners, same length."""
    piece = PIECES[name]
    holes = [1e3 * cut.outline.points for cut in piece.cut]
    angle = max(np.linspace(0.0, np.pi, 721)[:-1], key=lambda angle: _clearance(holes, angle))
    (tmp_path / "piece.stl").write_bytes(stl_bytes(part_mesh(piece), "piece", MILLIMETRES))
    mesh = trimesh.load_mesh(tmp_path / "piece.stl")
    lines = trimesh.intersections.mesh_plane(mesh, _normal(angle), np.zeros(3))
    across = lines @ np.array([np.cos(angle), np.sin(angle), 0.0])
    beside = (across > 0.0).all(axis=1)
    cut = np.dstack([lines[beside, :, 2], across[beside]])
    (section,) = on_layer(read(piece, tmp_path), "SECTION", "LWPOLYLINE")
    corners = np.array(section.get_points("xy"))
    heights = 1e3 * np.concatenate([solid.profile[:, 1] for solid in piece.joined])
    corners[:, 0] += heights.min() - corners[:, 0].min()
    length = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1).sum()
    around = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum()
    # Chords of the STL file's circles deviate from them by this much.
    tolerance = 2e-3 * corners[:, 1].max()
    assert length == pytest.approx(around, rel=2e-3)
    ends = cut.reshape(-1, 2)
    assert max(np.linalg.norm(ends - corner, axis=1).min() for corner in corners) < tolerance


def _normal(angle):
    return np.array([-np.sin(angle), np.cos(angle), 0.0])


def _clearance(holes, angle):
    """Least distance of a plane through the axis from the holes; 0 if it meets one."""
    sides = [hole @ _normal(angle)[:2] for hole in holes]
    apart = [np.abs(side).min() if np.ptp(np.sign(side)) == 0.0 else 0.0 for side in sides]
    return min(apart, default=0.0)
