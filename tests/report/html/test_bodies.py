"""Bodies of a GLB against trimesh, which reads it on its own, and with fewer triangles."""

import numpy as np
import pytest
import trimesh
from robots import SOLO12
from wheels import paper_device

from ocs_design.common.frames import Placement
from ocs_design.export.glb import robot_glb
from ocs_design.export.robot_model import robot_model
from ocs_design.report.bodies import ShownBody, Surface, read_bodies
from ocs_design.report.html.decimation import clustered, decimated
from ocs_design.robot.reader import read_robot

UPRIGHT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


@pytest.fixture(scope="module")
def glb(tmp_path_factory):
    robot = read_robot(SOLO12)
    path = tmp_path_factory.mktemp("glb") / "robot.glb"
    path.write_bytes(robot_glb(robot_model(robot, paper_device()).compiled, robot.posture))
    return path


def corners(bodies):
    """Corners of all triangles, in B, shape (n, 3, 3)."""
    return np.concatenate(
        [
            (s.vertices @ body.placement.rotation.T + body.placement.position)[s.faces]
            for body in bodies
            for s in body.surfaces
        ]
    )


def test_every_triangle_is_where_trimesh_has_it(glb):
    theirs = trimesh.load(glb).to_geometry()
    expected = np.sort(theirs.triangles_center @ UPRIGHT, axis=0)
    found = np.sort(corners(read_bodies(glb.read_bytes())).mean(axis=1), axis=0)
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_bodies_have_the_names_of_the_links(glb):
    names = [body.name for body in read_bodies(glb.read_bytes())]
    assert {"base_link", "ocs_left_flywheel", "ocs_right_flywheel"} <= set(names)
    assert len(set(names)) == len(names)


GREY = (0.5, 0.5, 0.5, 1.0)


def body(mesh, name="link"):
    surface = Surface(np.array(mesh.vertices), np.array(mesh.faces), GREY)
    return ShownBody(name, Placement.identity(), (surface,))


def mesh_of(shown):
    (surface,) = shown.surfaces
    return trimesh.Trimesh(surface.vertices, surface.faces, process=False)


def triangles_of(bodies):
    return sum(len(surface.faces) for each in bodies for surface in each.surfaces)


def box():
    mesh = trimesh.creation.box(extents=(0.3, 0.2, 0.1))
    for _ in range(5):
        mesh = mesh.subdivide()
    return mesh


def test_a_box_keeps_its_edges_and_its_volume():
    fine = box()
    (coarse,) = decimated([body(fine)], 1500)
    assert len(fine.faces) > 12_000
    assert triangles_of([coarse]) <= 1500
    found = mesh_of(coarse)
    np.testing.assert_allclose(found.bounds, fine.bounds, atol=1e-9)
    assert found.volume == pytest.approx(fine.volume, rel=5e-3)


def test_a_ball_stays_round():
    fine = trimesh.creation.icosphere(subdivisions=5, radius=0.2)
    (coarse,) = decimated([body(fine)], 2000)
    radii = np.linalg.norm(mesh_of(coarse).vertices, axis=1)
    np.testing.assert_allclose(radii, 0.2, rtol=0.02)


def test_what_is_small_enough_stays_as_it_is_with_equal_points_as_one():
    soup = trimesh.creation.box()
    loose = trimesh.Trimesh(
        soup.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    (found,) = decimated([body(loose)], 100)
    (surface,) = found.surfaces
    assert (len(surface.vertices), len(surface.faces)) == (8, 12)
    assert mesh_of(found).volume == pytest.approx(1.0, rel=1e-3)


def test_the_device_is_drawn_finer_than_its_robot():
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.2)
    robot, device = decimated([body(ball), body(ball, "ocs_left_flywheel")], 4000)
    assert triangles_of([device]) > 3 * triangles_of([robot])


def test_no_triangle_is_without_area_or_there_twice():
    found = clustered(body(box()).surfaces[0], 0.013)
    assert (mesh_of(ShownBody("x", Placement.identity(), (found,))).area_faces > 0.0).all()
    assert len(np.unique(np.sort(found.faces, axis=1), axis=0)) == len(found.faces)
