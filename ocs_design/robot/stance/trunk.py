"""Finds the link that carries the device."""

from collections.abc import Sequence

from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.legs import trunk_body
from ocs_design.robot.tree import Tree


def find_trunk(tree: Tree, legs: Sequence[Leg]) -> str:
    """The link whose frame is the base frame B: where the legs branch, else the heaviest body's.

    For a humanoid that is the pelvis: the device belongs where the legs' reaction arrives, and the
    chest turns against it. Of the links that are joined into the body, the first is taken, whose
    frame is the body's own; for usual robots it is the root link, the frame of Pinocchio's
    free-flyer.
    """
    if legs:
        return tree.bodies[trunk_body(tree, legs)].name
    return max(tree.bodies, key=lambda body: body.mass_properties.mass).name
