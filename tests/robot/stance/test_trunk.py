"""The trunk of every real robot, as a person would name it."""

import pytest
from anatomy import ANATOMY, LEGGED, legs_of, tree_of

from ocs_design.robot.stance.trunk import find_trunk


@pytest.mark.parametrize("name", ANATOMY)
def test_trunk(name):
    tree = tree_of(name)
    assert find_trunk(tree, legs_of(name)) == ANATOMY[name][0]


@pytest.mark.parametrize("name", LEGGED)
def test_base_frame_is_the_frame_of_the_free_flyer(name):
    tree = tree_of(name)
    root = tree.bodies[0]
    assert find_trunk(tree, legs_of(name)) == root.name
    assert (root.links[root.name].position == 0.0).all()
