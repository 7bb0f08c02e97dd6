"""Left and right legs that are not each other's mirror images."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.chain import Chain, neutral_posture
from ocs_design.robot.stance.leg_geometry import placements_in_base
from ocs_design.robot.stance.legs import leg_chain, trunk_body
from ocs_design.robot.tree import Body, Joint, Tree

MASS_SHARE = 0.02
"""Of masses, over the heavier."""

SHIFT_SHARE = 0.02
"""Of joints and centres of mass, over the leg's length."""

INERTIA_SHARE = 0.1
"""Of inertias, over the largest moment of the larger."""

LIMIT_SHARE = 0.02
"""Of a joint's range, effort and speed, over the larger."""

_MIRROR = np.diag([1.0, -1.0, 1.0])
"""At the plane between left and right, in B."""


@dataclass(frozen=True, eq=False)
class _Side:
    """One leg in B, joints at rest.

    Attributes:
        leg: as found. bodies: from hip to foot. origins: of their joints [m], shape (n, 3).
        masses: of the bodies.
    """

    leg: Leg
    bodies: tuple[Body, ...]
    origins: FloatArray
    masses: tuple[MassProperties, ...]


def side_doubts(tree: Tree, trunk: str, legs: Sequence[Leg]) -> Iterator[tuple[str, str]]:
    """What differs between a leg and its mirror image, and on which link of both."""
    placements = placements_in_base(tree, trunk, neutral_posture(tree))
    base = trunk_body(tree, legs) if legs else 0
    sides = [_side(leg, leg_chain(tree, leg, base, placements)) for leg in legs]
    for one, other in _pairs(sides):
        if len(one.bodies) != len(other.bodies):
            yield "legs left and right have not as many joints", f"{one.leg.name}, {other.leg.name}"
            continue
        for index, (body, twin) in enumerate(zip(one.bodies, other.bodies, strict=True)):
            for doubt in _doubts(one, other, index):
                yield doubt, f"{body.name}, {twin.name}"


def _side(leg: Leg, chain: Chain) -> _Side:
    place, bodies, origins, masses = chain.start, chain.bodies, [], []
    for body in bodies:
        place = place @ body.placement
        origins.append(place.position)
        masses.append(body.mass_properties.moved(place.rotation, place.position))
    return _Side(leg, bodies, np.array(origins), tuple(masses))


def _pairs(sides: Sequence[_Side]) -> Iterator[tuple[_Side, _Side]]:
    """Legs on the left, each with the leg whose hip is nearest to where its mirror image has it."""
    left = [side for side in sides if side.origins[0, 1] > 0.0]
    right = [side for side in sides if side.origins[0, 1] < 0.0]
    for side in left if len(left) == len(right) else ():
        image = _MIRROR @ side.origins[0]
        yield side, min(right, key=lambda each: float(np.linalg.norm(each.origins[0] - image)))


def _doubts(one: _Side, other: _Side, index: int) -> Iterator[str]:
    """Of the bodies with this number from the hip."""
    body, twin = one.masses[index], other.masses[index]
    length = max(one.leg.length, other.leg.length)
    if not np.isclose(body.mass, twin.mass, rtol=MASS_SHARE, atol=0.0):
        yield "links that differ in mass from those on the other side"
    if _shift(one.origins[index], other.origins[index]) > SHIFT_SHARE * length:
        yield "joints that do not mirror those on the other side"
    elif max(body.mass, twin.mass) > 0.0 and _shift(body.com, twin.com) > SHIFT_SHARE * length:
        yield "links whose centre of mass does not mirror the other side's"
    elif not _same_inertia(body.inertia, _MIRROR @ twin.inertia @ _MIRROR):
        yield "links whose inertia does not mirror the other side's"
    if not _same_limits(one.bodies[index].joint, other.bodies[index].joint):
        yield "joints whose range, effort or speed differs from the other side's"


def _shift(point: FloatArray, twin: FloatArray) -> float:
    """Distance of a point of B from the mirror image of its twin [m]."""
    return float(np.linalg.norm(point - _MIRROR @ twin))


def _same_inertia(inertia: FloatArray, image: FloatArray) -> bool:
    largest = max(float(np.abs(inertia).max()), float(np.abs(image).max()))
    return bool(np.abs(inertia - image).max() <= INERTIA_SHARE * largest)


def _same_limits(joint: Joint | None, twin: Joint | None) -> bool:
    if joint is None or twin is None:
        return joint is twin
    ours = (joint.upper - joint.lower, joint.effort, joint.velocity)
    theirs = (twin.upper - twin.lower, twin.effort, twin.velocity)
    return bool(np.isclose(ours, theirs, rtol=LIMIT_SHARE, atol=0.0).all())
