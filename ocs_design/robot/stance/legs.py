"""Finds the legs of any legged robot from its kinematic tree."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray, frozen
from ocs_design.robot.mass_properties import MassProperties, combine
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.chain import Chain, chain_of, neutral_posture
from ocs_design.robot.stance.feet import farthest_frame, find_foot, is_wheel
from ocs_design.robot.stance.leg_plane import leg_plane
from ocs_design.robot.tree import Placement, Tree

_SHARE_BELOW_TRUNK = 0.6
_SHARE_AT_REST = 0.2
_LARGEST_HEIGHT = 3.0
_LARGEST_DEVIATION = 0.2
_TWINS = 0.01


@dataclass(frozen=True, eq=False)
class _Limb:
    """A limb, as seen with some direction as up. Its tip is the farthest point known by its frames.

    Attributes:
        last: index of its last body.
        chain: in the root's frame.
        depth: of the stretched limb's tip below the root's origin [m].
        reach: of the stretched limb's tip below the limb's first joint [m].
        at_rest: of the tip below the first joint with all joints at zero [m].
    """

    last: int
    chain: Chain
    depth: float
    reach: float
    at_rest: float


def find_legs(tree: Tree) -> tuple[Leg, ...]:
    """The legs of a robot, in file order; empty if it has none.

    A limb is the chain from a child of some body to the farthest end below it. Legs are two or
    more limbs that

    * branch from the same body (the trunk) and have the same number of joints, two or more,
      a wheel at the end not counted;
    * hang: with all joints at zero their tip is below their first joint, by 20 % of their reach;
    * can lift the robot off the ground: stretched downwards within their limits they reach below
      the centre of mass of the robot, of the trunk, and of each body that carries the trunk, by
      60 % of their reach, and the robot's is not higher above their tips than thrice their reach;
    * reach equally deep, to 20 %;
    * are all of their kind: no other limb of the same trunk has as many joints and the same length.
      With a wrong direction for up, two legs of a quadruped may hang by chance.

    If several sets qualify, the one that reaches deepest wins: a humanoid's arms lose to its legs.
    Arms on a torso or a wheeled base, fingers on a palm and the one arm below a drone fail one of
    the conditions, and so does a hopper: one leg cannot be told from one arm. No shapes are looked
    at, for they may be missing or mere placeholders. Up is the root frame's z axis; if nothing
    stands along it, y and then x are tried, for files of other conventions.
    """
    placements = tree.placements(neutral_posture(tree))
    masses = [
        body.mass_properties.moved(place.rotation, place.position)
        for body, place in zip(tree.bodies, placements, strict=True)
    ]
    for up in np.eye(3)[[2, 1, 0]]:
        legs = _legs_along(tree, placements, masses, up)
        if legs:
            return legs
    return ()


def trunk_body(tree: Tree, legs: Sequence[Leg]) -> int:
    """Index of the body that the legs branch from: the last that all their chains share."""
    shared = set.intersection(*(set(_ancestors(tree, leg.body)) for leg in legs))
    return max(shared)


def leg_chain(tree: Tree, leg: Leg, trunk: int, placements: Sequence[Placement]) -> Chain:
    """The leg's chain from body `trunk` on, seen from the frame that `placements` are given in."""
    first = next(i for i in _ancestors(tree, leg.body) if tree.bodies[i].parent == trunk)
    return chain_of(tree, first, leg.body, placements)


def _ancestors(tree: Tree, body: int) -> Iterator[int]:
    """The body itself, its parent and so on to the root."""
    while body >= 0:
        yield body
        body = tree.bodies[body].parent


def _legs_along(
    tree: Tree, placements: Sequence[Placement], masses: Sequence[MassProperties], up: FloatArray
) -> tuple[Leg, ...]:
    best: list[_Limb] = []
    robot = combine(masses)
    for trunk, ends in _alike(tree):
        limbs = [_limb(chain_of(tree, *each, placements), each[1], up) for each in ends]
        hanging = [limb for limb in limbs if limb is not None]
        carriers = [masses[i] for i in _ancestors(tree, trunk) if masses[i].mass > 0.0]
        legs = _standing(hanging, robot, carriers, up)
        if _leave_twins(tree, ends, {leg.last for leg in legs}):
            continue
        if len(legs) >= 2 and (not best or _depth(legs) > _depth(best)):
            best = legs
    found = tuple(_leg(limb, up) for limb in best)
    # Slides alone, as of a gantry, do not make a leg: nothing bends between hip and foot.
    return found if all(leg.length > 0.0 for leg in found) else ()


def _alike(tree: Tree) -> Iterator[tuple[int, list[tuple[int, int]]]]:
    """Trunks, each with limbs of the same number of joints, as first and last body."""
    ends, driven = _far_ends(tree), _driven_joints(tree)
    sets: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for first, body in enumerate(tree.bodies[1:], start=1):
        last = ends[first]
        hinges = driven[last] - driven[body.parent] - is_wheel(tree.bodies[last])
        sets.setdefault((body.parent, hinges), []).append((first, last))
    for (trunk, hinges), limbs in sets.items():
        if hinges >= 2 and len(limbs) >= 2:
            yield trunk, limbs


def _leave_twins(tree: Tree, limbs: Sequence[tuple[int, int]], chosen: Collection[int]) -> bool:
    """Whether a limb that was not chosen is as long as one that was; each is first and last."""
    lengths = {last: _length(tree, first, last) for first, last in limbs}
    return any(
        abs(lengths[one] - lengths[other]) < _TWINS * lengths[one]
        for one in chosen
        for other in lengths.keys() - chosen
    )


def _length(tree: Tree, first: int, last: int) -> float:
    """Of a limb along its frames [m]."""
    body, length = last, float(np.linalg.norm(farthest_frame(tree.bodies[last])))
    while body != first:
        length += float(np.linalg.norm(tree.bodies[body].placement.position))
        body = tree.bodies[body].parent
    return length


def _far_ends(tree: Tree) -> list[int]:
    """For each body the descendant at the end of the longest path below it, or itself."""
    ends = list(range(len(tree.bodies)))
    lengths = [0.0] * len(tree.bodies)
    for index in range(len(tree.bodies) - 1, 0, -1):
        body = tree.bodies[index]
        length = lengths[index] + float(np.linalg.norm(body.placement.position))
        # At equal lengths the first in the file, which is met last, as a reader would expect.
        if length >= lengths[body.parent]:
            lengths[body.parent], ends[body.parent] = length, ends[index]
    return ends


def _driven_joints(tree: Tree) -> list[int]:
    """Joints that move by themselves, from the root to each body."""
    counts = [0]
    for body in tree.bodies[1:]:
        moves = body.joint is not None and body.joint.mimic is None
        counts.append(counts[body.parent] + moves)
    return counts


def _limb(chain: Chain, last: int, up: FloatArray) -> _Limb | None:
    """The limb, or None if it does not hang at all: most arms and fingers are told from that."""
    tip = farthest_frame(chain.bodies[-1])
    rest = chain.pose(chain.neutral())
    hip = float(up @ rest.origins[0])
    at_rest = hip - float(up @ rest.point(tip))
    if at_rest <= 0.0:
        return None
    lowest = float(up @ chain.pose(chain.stretched(tip, -up)).point(tip))
    return _Limb(last, chain, -lowest, hip - lowest, at_rest)


def _standing(
    limbs: Sequence[_Limb],
    robot: MassProperties,
    carriers: Sequence[MassProperties],
    up: FloatArray,
) -> list[_Limb]:
    """The limbs that hang low, can lift the robot off the ground, and do so to the same height."""
    legs = [
        limb
        for limb in limbs
        if limb.at_rest > _SHARE_AT_REST * limb.reach
        and limb.depth + up @ robot.com < _LARGEST_HEIGHT * limb.reach
        and all(
            limb.depth + up @ each.com > _SHARE_BELOW_TRUNK * limb.reach
            for each in (robot, *carriers)
        )
    ]
    return [leg for leg in legs if _depth(legs) - leg.depth < _LARGEST_DEVIATION * leg.reach]


def _depth(limbs: Sequence[_Limb]) -> float:
    return max(limb.depth for limb in limbs)


def _leg(limb: _Limb, up: FloatArray) -> Leg:
    foot = find_foot(limb.chain, up)
    length = leg_plane(limb.chain, foot.point, up).length
    return Leg(foot.link, limb.last, limb.chain.names, frozen(foot.point), foot.radius, length)
