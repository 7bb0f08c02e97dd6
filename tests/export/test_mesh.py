"""Meshes of parts, weighed by trimesh, against the closed form."""

import numpy as np
import pytest
import trimesh
from sample_parts import PARTS

from ocs_design.export.meshes import Mesh, part_mesh
from ocs_design.parts.solids import Part

SECTIONS = (32, 64, 128, 256)
ORDER_OF_ARCS, ORDER_OF_CIRCLES = 2.5, 3.8
"""Least orders of convergence: third and fourth, less a margin for steps of the chords."""

FINEST = 2e-6
"""Largest relative error of the inertia with the most sections; with the fewest it is 1e-3."""

WITH_ARCS = {"drum", "lid", "cage", "foot", "slotted"}


def weighed(part: Part, sections: int) -> trimesh.Trimesh:
    """The mesh in millimetres, since trimesh merges points closer than 1e-8."""
    mesh = part_mesh(part, sections)
    scaled = trimesh.Trimesh(1e3 * mesh.vertices, mesh.triangles)
    scaled.density = part.density * 1e-9
    return scaled


@pytest.mark.parametrize("part", PARTS.values(), ids=PARTS)
def test_mesh_is_one_closed_body_that_converges_to_the_closed_form(part, record_property):
    meshes, exact = [weighed(part, sections) for sections in SECTIONS], part.mass_properties()
    finest = meshes[-1]
    assert finest.is_watertight
    assert finest.is_winding_consistent
    assert finest.body_count == 1
    assert finest.area_faces.min() > 0.0
    np.testing.assert_allclose(finest.center_mass * 1e-3, exact.com, atol=1e-8)
    # Every polygon has the area of its arc.
    assert [mesh.mass for mesh in meshes] == pytest.approx([exact.mass] * 4, rel=1e-12)
    # Relative errors of the largest entry of the inertia tensor.
    errors = [np.abs(mesh.moment_inertia * 1e-6 - exact.inertia).max() for mesh in meshes]
    relative = np.array(errors) / exact.inertia.max()
    record_property("inertia_errors", dict(zip(SECTIONS, relative.tolist(), strict=True)))
    order = np.log2(relative[0] / relative[-1]) / np.log2(SECTIONS[-1] / SECTIONS[0])
    assert order > (ORDER_OF_ARCS if part.name in WITH_ARCS else ORDER_OF_CIRCLES)
    assert relative[0] < 1e-3
    assert relative[-1] < FINEST


def test_equal_points_become_one_vertex():
    corners = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[-0.0, 0, 0], [0, 1, 0], [0, 0, 1]]])
    mesh = Mesh.of_corners(corners)
    assert len(mesh.vertices) == 4
    np.testing.assert_array_equal(mesh.corners, corners)
