"""Lines of simple solids, seen and hidden, against what one counts by hand."""

import numpy as np
import pytest

from ocs_design.export.assembly.line_art import section_lines, view_of, visible_lines
from ocs_design.export.meshes import Mesh, solid_mesh
from ocs_design.parts.shapes import Rectangle
from ocs_design.parts.solids import Prism, hollow_cylinder

VIEW = view_of((1.0, 0.7, 0.5), (0.0, 0.0, 1.0))


def box(size=0.02, low=0.0):
    square = Rectangle(-size / 2.0, size / 2.0, -size / 2.0, size / 2.0)
    return solid_mesh(Prism(square, low, low + size))


def seen(*meshes, view=VIEW):
    turned = [Mesh(mesh.vertices @ view.T, mesh.triangles) for mesh in meshes]
    return visible_lines(turned)


def length(chains):
    return sum(float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum()) for chain in chains)


def projected(vectors):
    return [float(np.linalg.norm((VIEW @ vector)[:2])) for vector in vectors]


def test_the_view_is_a_rotation_with_up_upright():
    np.testing.assert_allclose(VIEW @ VIEW.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(VIEW) == pytest.approx(1.0)
    x, y, _ = VIEW @ [0.0, 0.0, 1.0]
    assert x == pytest.approx(0.0)
    assert y > 0.0


def test_of_a_cube_nine_edges_are_seen():
    """Three of each direction: the three that meet in the hidden corner are not."""
    (chains,) = seen(box())
    assert length(chains) == pytest.approx(3.0 * 0.02 * sum(projected(np.eye(3))), rel=0.02)


def test_what_is_behind_another_is_not_seen():
    near, far = box(), box(0.012)
    behind = Mesh(far.vertices - 0.05 * VIEW[2], far.triangles)
    front, hidden = seen(near, behind)
    assert length(front) == pytest.approx(length(seen(near)[0]))
    assert length(hidden) < 0.05 * length(front)


def test_a_cylinder_shows_its_end_and_its_sides():
    """Seen across its axis: two sides, a straight line for each end."""
    (chains,) = seen(
        solid_mesh(hollow_cylinder(0.0, 0.01, 0.0, 0.03), 64),
        view=view_of((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    )
    points = np.concatenate(chains)
    assert np.ptp(points, axis=0) == pytest.approx([0.02, 0.03], rel=0.01)


def test_the_section_of_a_tube_is_two_rectangles():
    chains = section_lines(solid_mesh(hollow_cylinder(0.01, 0.015, 0.0, 0.03), 64))
    assert len(chains) == 2
    assert length(chains) == pytest.approx(2.0 * 2.0 * (0.005 + 0.03), rel=0.01)
    for chain in chains:
        assert chain[0] == pytest.approx(chain[-1], abs=1e-7)
