"""The legs as they stand in the base frame: chains, planes, and which way is up."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.chain import Chain, neutral_posture
from ocs_design.robot.stance.leg_plane import LegPlane, leg_plane
from ocs_design.robot.stance.legs import leg_chain, trunk_body
from ocs_design.robot.tree import Placement, Tree

SIDEWAYS = 0.9
"""Smallest product of a knee's axis with the x axis of a frame whose x points sideways."""


@dataclass(frozen=True, eq=False)
class LegGeometry:
    """One leg in the base frame B, joints of no leg at rest.

    Attributes:
        leg: as found in the tree.
        chain: from the body where the legs branch to the foot, in B.
        plane: in which the leg bends, in B.
    """

    leg: Leg
    chain: Chain
    plane: LegPlane


def placements_in_base(
    tree: Tree, trunk: str, posture: Mapping[str, float]
) -> tuple[Placement, ...]:
    """Frame of each body in the base frame B, the frame of the link `trunk`."""
    placements = tree.placements(posture)
    index = tree.body_of_link[trunk]
    to_base = (placements[index] @ tree.bodies[index].links[trunk]).inverse()
    return tuple(to_base @ placement for placement in placements)


def leg_geometries(tree: Tree, trunk: str, legs: Sequence[Leg]) -> tuple[LegGeometry, ...]:
    """Chain and plane of each leg in B."""
    up = up_axis(tree, trunk, legs)
    return tuple(
        LegGeometry(leg, chain, leg_plane(chain, leg.foot, up))
        for leg, chain in zip(legs, _chains(tree, trunk, legs), strict=True)
    )


def up_axis(tree: Tree, trunk: str, legs: Sequence[Leg]) -> FloatArray:
    """The axis of B, either way, along which the legs hang when all joints are at zero, shape (3,).

    It is z, unless B follows another convention.
    """
    hang = np.zeros(3)
    for chain, leg in zip(_chains(tree, trunk, legs), legs, strict=True):
        rest = chain.pose(chain.neutral())
        hang += rest.origins[0] - rest.point(leg.foot)
    axis = int(np.argmax(np.abs(hang)))
    return np.asarray(np.eye(3)[axis] * np.sign(hang[axis]))


def standing_height(
    tree: Tree, trunk: str, legs: Sequence[Leg], posture: Mapping[str, float]
) -> float:
    """Height of the trunk frame's origin over its lowest sole at `posture` [m]."""
    up = up_axis(tree, trunk, legs)
    placements = placements_in_base(tree, trunk, posture)
    return max(
        leg.foot_radius
        - float(up @ (placements[leg.body].rotation @ leg.foot + placements[leg.body].position))
        for leg in legs
    )


def convention_warnings(tree: Tree, trunk: str, legs: Sequence[Leg]) -> list[str]:
    """Doubts whether B has x forward and z up, from how the legs hang and bend."""
    if not legs:
        return []
    cure = "fix a link with x forward and z up to the trunk and name it with --trunk"
    up = up_axis(tree, trunk, legs)
    if up[2] < 1.0:
        return [
            f"the legs do not hang along -z of the trunk frame '{trunk}' but along "
            f"{axis_name(-up)}, so roll and pitch are not what they seem: {cure}"
        ]
    axes = [geometry.plane.axis for geometry in leg_geometries(tree, trunk, legs)]
    if all(abs(axis[0]) > SIDEWAYS for axis in axes):
        return [
            f"the knees turn about the x axis of the trunk frame '{trunk}', so x seems to point "
            f"sideways, and roll and pitch are swapped: {cure}"
        ]
    return []


def axis_name(direction: FloatArray) -> str:
    """As in `+x`: the axis that it is nearest to."""
    axis = int(np.argmax(np.abs(direction)))
    return f"{'-' if direction[axis] < 0.0 else '+'}{'xyz'[axis]}"


def _chains(tree: Tree, trunk: str, legs: Sequence[Leg]) -> list[Chain]:
    placements = placements_in_base(tree, trunk, neutral_posture(tree))
    base = trunk_body(tree, legs)
    return [leg_chain(tree, leg, base, placements) for leg in legs]
