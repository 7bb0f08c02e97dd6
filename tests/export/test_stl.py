"""The wheel's mesh, read again by trimesh, against the closed form."""

import numpy as np
import pytest
import trimesh
from wheels import PAPER_WHEEL

from ocs_design.export.stl import METRES, MILLIMETRES, wheel_stl

# 32-bit coordinates of binary STL, and the polygon's error of fourth order.
RELATIVE = 1e-7


def saved(wheel, path, units_per_metre):
    path.write_bytes(wheel_stl(wheel, units_per_metre=units_per_metre))
    return path


@pytest.mark.parametrize("unit", [METRES, MILLIMETRES])
def test_mesh_weighs_what_the_rim_weighs(tmp_path, unit, record_property):
    mesh = trimesh.load_mesh(saved(PAPER_WHEEL, tmp_path / "w.stl", unit))
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    mesh.density = PAPER_WHEEL.density / unit**3
    moments = np.array(
        [PAPER_WHEEL.transverse_inertia, PAPER_WHEEL.transverse_inertia, PAPER_WHEEL.spin_inertia]
    )
    error = np.abs(np.diag(mesh.moment_inertia) / unit**2 / moments - 1.0).max()
    record_property("inertia_error", float(error))
    assert error < RELATIVE
    assert mesh.mass == pytest.approx(PAPER_WHEEL.mass, rel=RELATIVE)
    np.testing.assert_allclose(mesh.center_mass, 0.0, atol=1e-9 * unit)


def test_normals_point_outwards(tmp_path):
    mesh = trimesh.load_mesh(saved(PAPER_WHEEL, tmp_path / "w.stl", METRES))
    assert mesh.volume > 0.0
    written = np.frombuffer((tmp_path / "w.stl").read_bytes()[84:], "<f4,<f4,<f4,(9,)<f4,<u2")
    for axis, name in enumerate(("f0", "f1", "f2")):
        np.testing.assert_allclose(written[name], mesh.face_normals[:, axis], atol=1e-4)


def test_bytes_are_the_same_every_time(tmp_path):
    first = saved(PAPER_WHEEL, tmp_path / "a.stl", METRES)
    second = saved(PAPER_WHEEL, tmp_path / "b.stl", METRES)
    assert first.read_bytes() == second.read_bytes()
    assert not first.read_bytes().startswith(b"solid")
