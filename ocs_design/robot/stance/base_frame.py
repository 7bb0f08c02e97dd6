"""The base frame B: x forward, y left, z up, whatever the trunk's own frame is like."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import RobotError
from ocs_design.robot.robot import Leg, Mount
from ocs_design.robot.stance.leg_geometry import SIDEWAYS, axis_name, leg_geometries, up_axis
from ocs_design.robot.tree import Placement, Tree

BASE_FRAME = "ocs_base"
"""Name of the link that is fixed to the trunk where no link of the file has such a frame."""


def with_base_frame(
    tree: Tree, trunk: str, legs: Sequence[Leg]
) -> tuple[Tree, Mount | None, tuple[str, ...]]:
    """The tree with a base frame fixed to `trunk`, if the trunk's own frame is none.

    Which way is up is told by how the legs hang, which way is sideways by the axes that they bend
    about. Front and back look alike: of both the one nearer to the trunk's own x axis is taken.

    Returns:
        The tree; how B is fixed to the trunk, None if the trunk's own frame is B; what to tell.

    Raises:
        RobotError: the frame would be needed, but the file has a link of that name.
    """
    rotation = _base_rotation(tree, trunk, legs) if legs else np.eye(3)
    if np.array_equal(rotation, np.eye(3)):
        return tree, None, ()
    if BASE_FRAME in tree.body_of_link:
        raise RobotError(
            f"the robot already has a link named {BASE_FRAME!r}, which the base frame needs",
            hint="rename that link, or name a link with x forward and z up with --trunk",
        )
    mount = Mount(trunk, Placement(rotation, np.zeros(3)))
    told = (
        f"the frame of the trunk '{trunk}' has not x forward and z up: forward is its "
        f"{axis_name(rotation[:, 0])} axis and up its {axis_name(rotation[:, 2])} axis, "
        f"as the legs tell; "
        f"the base frame '{BASE_FRAME}' is fixed to it accordingly"
    )
    return _with_link(tree, mount), mount, (told,)


def _base_rotation(tree: Tree, trunk: str, legs: Sequence[Leg]) -> FloatArray:
    """B in the trunk's frame: a turn by right angles."""
    up = up_axis(tree, trunk, legs)
    knees = [geometry.plane.axis for geometry in leg_geometries(tree, trunk, legs)]
    if up[2] == 1.0 and not all(abs(axis[0]) > SIDEWAYS for axis in knees):
        return np.eye(3)
    sideways = np.sum(np.abs(knees), axis=0) * (up == 0.0)
    left = np.eye(3)[int(np.argmax(sideways))]
    both = [np.column_stack([np.cross(y, up), y, up]) for y in (left, -left)]
    return max(both, key=np.trace)


def _with_link(tree: Tree, mount: Mount) -> Tree:
    index = tree.body_of_link[mount.link]
    body = tree.bodies[index]
    carrier = replace(
        body,
        links={**body.links, BASE_FRAME: body.links[mount.link] @ mount.placement},
        link_masses={**body.link_masses, BASE_FRAME: 0.0},
    )
    return replace(tree, bodies=(*tree.bodies[:index], carrier, *tree.bodies[index + 1 :]))
