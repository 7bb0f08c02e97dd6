"""The base frame B, and the legs in it: chains, planes and the upward axis."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement
from ocs_design.robot.chain import Chain, chain_of, neutral_posture
from ocs_design.robot.legs import LegPlane, leg_plane
from ocs_design.robot.robot import Leg, Mount
from ocs_design.robot.tree import Tree

SIDEWAYS = 0.9
"""Axes whose unit vectors have at least this product point the same way (26 degrees)."""


@dataclass(frozen=True, eq=False)
class LegGeometry:
    """One leg in the base frame B; joints that belong to no leg are at rest.

    Attributes:
        leg: as found in the tree.
        chain: from the body where the legs branch to the foot, in B.
        plane: in which the leg bends, in B.
        up: the same for all legs, see `up_axis`.
    """

    leg: Leg
    chain: Chain
    plane: LegPlane
    up: FloatArray

    @property
    def sprawls(self) -> bool:
        """Whether the leg reaches out sideways and steps by swinging its hip about the vertical.

        A hexapod's knees turn about x even if x points forward. Such a leg has no roll joint.
        """
        driven, plane = self.chain.driven, self.plane
        axes = self.chain.pose(plane.level).axes
        swings = 0 not in plane.pitch and abs(axes[driven[0]] @ self.up) > SIDEWAYS
        rolls = any(abs(axes[row] @ plane.forward) > SIDEWAYS for row in driven)
        return bool(swings and not rolls)

    @property
    def steps_sideways(self) -> bool:
        """Whether the knee turns about B's x axis when the leg bends for a step."""
        return bool(abs(self.plane.axis[0]) > SIDEWAYS and not self.sprawls)


def leg_geometries(tree: Tree, trunk: str, legs: Sequence[Leg]) -> tuple[LegGeometry, ...]:
    """Chain and plane of each leg in B."""
    up, placements = up_axis(tree, trunk, legs), tree.placements_from(trunk, neutral_posture(tree))
    chains = [chain_of(tree, leg.base, leg.body, placements) for leg in legs]
    return tuple(
        LegGeometry(leg, chain, leg_plane(chain, leg.foot, up), up)
        for leg, chain in zip(legs, chains, strict=True)
    )


def up_axis(tree: Tree, trunk: str, legs: Sequence[Leg]) -> FloatArray:
    """The axis of B, with its sign, that points up while the robot stands, shape (3,).

    It is z, unless B follows another convention. Joints between B and the legs' bases are at rest.
    """
    placements = tree.placements_from(trunk, neutral_posture(tree))
    up = np.sum([placements[leg.base].rotation @ leg.up for leg in legs], axis=0)
    axis = int(np.argmax(np.abs(up)))
    return np.asarray(np.eye(3)[axis] * np.sign(up[axis]))


def sole_depths(
    tree: Tree, trunk: str, legs: Sequence[Leg], posture: Mapping[str, float]
) -> list[float]:
    """Height of the trunk frame's origin above each leg's sole at `posture` [m].

    The largest is the height at which the robot stands.
    """
    up = up_axis(tree, trunk, legs)
    placements = tree.placements_from(trunk, posture)
    return [leg.foot_radius - float(up @ placements[leg.body].point(leg.foot)) for leg in legs]


_CURE = "fix a link with x forward and z up to the trunk and name it with --trunk"


def convention_warnings(tree: Tree, trunk: str, legs: Sequence[Leg]) -> list[str]:
    """Warnings that B may not have x forward and z up, judged by how the legs hang and bend."""
    if not legs:
        return []
    geometries = leg_geometries(tree, trunk, legs)
    up = geometries[0].up
    if up[2] < 1.0:
        return [
            f"the legs do not hang along -z of the trunk frame '{trunk}' but along "
            f"{axis_name(-up)}, so roll and pitch are about the wrong axes: {_CURE}"
        ]
    if all(geometry.steps_sideways for geometry in geometries):
        return [
            f"the knees turn about the x axis of the trunk frame '{trunk}', so x seems to point "
            f"sideways, and roll and pitch are swapped: {_CURE}"
        ]
    front = named_front(legs, [geometry.plane.hip for geometry in geometries])
    if abs(front[1]) > abs(front[0]) and all(geometry.sprawls for geometry in geometries):
        return [
            f"the legs named as front legs are beside the others: x of the trunk frame '{trunk}' "
            f"seems to point sideways, and roll and pitch are swapped: {_CURE}"
        ]
    if front[0] < 0.0:
        return [
            f"the legs named as front legs are behind the others: x of the trunk frame "
            f"'{trunk}' seems to point backwards, so flips are reversed: {_CURE}"
        ]
    return []


_ALONG, _ACROSS = 0.7, 0.2
"""Shares of a leg's extent along an axis above which it points along it, or hangs."""


def hanging_warnings(tree: Tree, trunk: str, legs: Sequence[Leg]) -> list[str]:
    """Warning of an axis of B along which all legs point at rest, and that was not taken as down.

    It may be down, or the legs may be folded up or stretched out at zero. They are if they hang as
    assumed in any posture of the file.
    """
    if not legs:
        return []
    up, drops = up_axis(tree, trunk, legs), []
    for posture in (neutral_posture(tree), *tree.named_postures.values()):
        placements = tree.placements_from(trunk, posture)
        hips = [placements[tree.path(leg.base, leg.body)[0]].position for leg in legs]
        tips = [placements[leg.body].point(leg.foot) for leg in legs]
        drops.append(np.array(hips) - np.array(tips))
    lengths = np.linalg.norm(drops, axis=2) + 1e-300
    if ((drops @ up) / lengths > _ACROSS).all(axis=1).any():
        return []
    directions = drops[0] / lengths[0][:, None]
    axis = int(np.argmax(np.abs(directions.sum(axis=0))))
    other = np.eye(3)[axis] * np.sign(directions[0, axis])
    if not (directions @ other > _ALONG).all():
        return []
    return [
        f"at zero the legs point along {axis_name(-other)} of the trunk frame '{trunk}', not along "
        f"{axis_name(-up)}: if that is down, {_CURE}"
    ]


def axis_name(direction: FloatArray) -> str:
    """Name of the axis nearest to a direction, such as `+x`."""
    axis = int(np.argmax(np.abs(direction)))
    return f"{'-' if direction[axis] < 0.0 else '+'}{'xyz'[axis]}"


BASE_FRAME = "ocs_base"
"""Name of the base frame that is added to the trunk if no link of the file has such a frame."""


def with_base_frame(
    tree: Tree, trunk: str, legs: Sequence[Leg]
) -> tuple[Tree, Mount | None, tuple[str, ...]]:
    """The tree with a base frame fixed to `trunk`, unless the trunk's own frame is one.

    Up follows from how the legs hang, sideways from the axes about which they bend. Front and back
    look alike: the legs' names distinguish them; otherwise front is the one nearer to the trunk's
    own x axis.

    Returns:
        The tree; how B is fixed to the trunk, or None if the trunk's frame is B; the warnings.

    Raises:
        RobotError: the frame is needed, but the file already has a link of that name.
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
    warning = (
        f"the frame of the trunk '{trunk}' does not have x forward and z up: forward is its "
        f"{axis_name(rotation[:, 0])} axis and up its {axis_name(rotation[:, 2])} axis, "
        f"judged by the legs; "
        f"the base frame '{BASE_FRAME}' is fixed to it accordingly"
    )
    index = tree.body_of_link[trunk]
    body = tree.bodies[index]
    carrier = replace(
        body,
        links={**body.links, BASE_FRAME: body.links[trunk] @ mount.placement},
        link_masses={**body.link_masses, BASE_FRAME: 0.0},
    )
    bodies = (*tree.bodies[:index], carrier, *tree.bodies[index + 1 :])
    return replace(tree, bodies=bodies), mount, (warning,)


def _base_rotation(tree: Tree, trunk: str, legs: Sequence[Leg]) -> FloatArray:
    """Axes of B in the trunk's frame, turned by right angles, as columns, shape (3, 3)."""
    geometries = leg_geometries(tree, trunk, legs)
    up = geometries[0].up
    planes = [geometry.plane for geometry in geometries]
    front = named_front(legs, [plane.hip for plane in planes])
    if front.any() and all(geometry.sprawls for geometry in geometries):
        # Only the names tell which way such legs walk.
        sideways = np.abs(np.cross(up, front))
        ahead = bool(sideways[1] >= sideways[0])
    else:
        sideways = np.sum([np.abs(plane.axis) for plane in planes], axis=0)
        ahead = not all(geometry.steps_sideways for geometry in geometries)
    if up[2] == 1.0 and ahead:
        return np.eye(3)
    left = np.eye(3)[int(np.argmax(sideways * (up == 0.0)))]
    candidates = [np.column_stack([np.cross(y, up), y, up]) for y in (left, -left)]
    return max(candidates, key=lambda axes: (np.sign(axes[:, 0] @ front).round(6), np.trace(axes)))


_FRONT = re.compile(
    r"front|(?<![a-z])fore(?!arm)|(?<![a-z])(?:f[lr]|[lr]f)(?![a-z])", re.IGNORECASE
)
_REAR = re.compile(r"rear|hind|back|(?<![a-z])(?:[bhr][lr]|[lr]h)(?![a-z])", re.IGNORECASE)


def named_front(legs: Sequence[Leg], hips: Sequence[FloatArray]) -> FloatArray:
    """Vector from the hips of legs named as hind legs to those of front legs [m], shape (3,).

    Zero unless both are named.
    """
    named_as = [(bool(_FRONT.search(leg.name)), bool(_REAR.search(leg.name))) for leg in legs]
    front = [hip for hip, names in zip(hips, named_as, strict=True) if names == (True, False)]
    rear = [hip for hip, names in zip(hips, named_as, strict=True) if names == (False, True)]
    if not front or not rear:
        return np.zeros(3)
    ahead: FloatArray = np.mean(front, axis=0) - np.mean(rear, axis=0)
    return ahead
