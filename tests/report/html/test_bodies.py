"""Bodies of a GLB against trimesh, which reads it on its own."""

import numpy as np
import pytest
import trimesh
from robots import SOLO12
from wheels import paper_device

from ocs_design.export.glb import robot_glb
from ocs_design.export.robot_model import robot_model
from ocs_design.report.bodies import read_bodies
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
