"""Meshes that only show are left out where they would outweigh everything else."""

import numpy as np
import pytest
from anatomy import tree_of
from robots import ROBOTS

from ocs_design.robot.mujoco_bodies import VISUAL_BYTES, oversized_visuals
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot


@pytest.mark.parametrize(
    ("name", "left_out"),
    [
        ("go1_description/urdf/go1", {"trunk.dae"}),
        ("b1_description/urdf/b1", {"trunk.dae"}),
        ("anymal_b_simple_description/robots/anymal", {"anymal_base.dae"}),
        ("go2_description/urdf/go2", set()),
        ("solo_description/robots/solo12", set()),
    ],
)
def test_the_largest_go_first(name, left_out):
    tree = tree_of(name)
    found = oversized_visuals(tree)
    assert {path.name for path in found} == left_out
    shown = {
        shape.mesh
        for body in tree.bodies
        for shape in body.shapes
        if shape.mesh is not None and not shape.collides
    }
    assert sum(path.stat().st_size for path in shown - found) <= VISUAL_BYTES


def test_what_is_left_out_is_told_and_something_else_shown():
    built = build_spec(read_robot(ROBOTS / "go1_description/urdf/go1.urdf"))
    told = "meshes too large to be shown in the MuJoCo model, left out: trunk.dae"
    assert built.warnings == (told,)
    trunk = built.spec.body("base")
    visible = [geom for geom in trunk.geoms if geom.group == 0]
    assert visible
    assert np.all([geom.contype == 1 for geom in visible])
