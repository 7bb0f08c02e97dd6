"""The posture in which a legged robot stands."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.chain import neutral_posture
from ocs_design.robot.stance.leg_geometry import (
    LegGeometry,
    leg_geometries,
    standing_height,
    up_axis,
)
from ocs_design.robot.stance.leg_stance import Stance, StanceProblem
from ocs_design.robot.tree import Tree

SHARE_OF_LEG = 0.8
"""A standing robot's feet are at this share of the stretched leg below the hips."""

_STRAIGHTER = (0.85, 0.9, 0.95, 1.0)
"""Shares to try in turn where joint limits forbid the wanted one."""


@dataclass(frozen=True, eq=False)
class Stand:
    """A standing posture.

    Attributes:
        posture: value of every moving joint [rad or m].
        standing_height: of the trunk frame's origin over the ground [m].
        share: distance from hip to foot over the stretched leg, of the most stretched leg.
        misses: distance of each foot from its place below the hip [m].
        tilts: of each sole against the ground [rad].
        warnings: where limits forbid the posture that was wanted.
    """

    posture: Mapping[str, float]
    standing_height: float
    share: float
    misses: tuple[float, ...]
    tilts: tuple[float, ...]
    warnings: tuple[str, ...]


def stand(tree: Tree, trunk: str, legs: Sequence[Leg], share: float = SHARE_OF_LEG) -> Stand | None:
    """The robot with its trunk level and every foot on one ground plane below its hip.

    The ground is so far below the hips that no leg is stretched farther than `share` of its length;
    where limits of some joint forbid that, the legs are kept straighter. Legs with ankles (five
    joints or more) keep their soles as level as they are at zero. Where the limits leave it open,
    the knees of a biped point forward (B's x) and those of a robot with more legs inwards, as
    Solo12 stands. Joints of no leg are at zero, or at the limit nearest to it.

    Returns:
        None for a robot without legs.
    """
    if not legs:
        return None
    geometries = leg_geometries(tree, trunk, legs)
    up = up_axis(tree, trunk, legs)
    stances = tuple(problem.solve() for problem in _problems(geometries, up, share))
    warnings = _complaints(geometries, stances)
    for straighter in (each for each in _STRAIGHTER if warnings and each > share):
        found = _good_stances(_problems(geometries, up, straighter))
        if found is not None:
            warnings = [
                f"joint limits keep the legs from bending to {share:.0%} of their length: "
                f"the robot stands at {straighter:.0%}"
            ]
            stances, share = found, straighter
            break
    posture = _posture(tree, geometries, stances)
    return Stand(
        posture,
        standing_height(tree, trunk, legs, posture),
        share,
        tuple(stance.miss for stance in stances),
        tuple(stance.tilt for stance in stances),
        tuple(warnings),
    )


def _problems(
    geometries: Sequence[LegGeometry], up: FloatArray, share: float
) -> list[StanceProblem]:
    """Each leg's stance, the ground being at `share` of the leg that reaches least."""
    ground = max(
        float(up @ each.plane.hip) - share * each.plane.length - each.leg.foot_radius
        for each in geometries
    )
    sides = _knee_sides(geometries)
    return [
        StanceProblem(each.chain, each.plane, each.leg.foot, _place(each, up, ground), up, side)
        for each, side in zip(geometries, sides, strict=True)
    ]


def _good_stances(problems: Sequence[StanceProblem]) -> tuple[Stance, ...] | None:
    """Every leg's stance, or None as soon as one leg has none that is good."""
    stances: list[Stance] = []
    for problem in problems:
        stances.append(problem.solve())
        if not stances[-1].good:
            return None
    return tuple(stances)


def _place(each: LegGeometry, up: FloatArray, ground: float) -> FloatArray:
    """Where the foot belongs: straight below the hip."""
    return each.plane.hip + up * (ground + each.leg.foot_radius - float(up @ each.plane.hip))


def _knee_sides(geometries: Sequence[LegGeometry]) -> list[FloatArray]:
    """Forward for a biped, else towards the middle of the hips."""
    planes = [each.plane for each in geometries]
    if len(planes) == 2:
        return [plane.forward for plane in planes]
    middle = np.mean([plane.hip for plane in planes], axis=0)
    return [
        plane.forward * (np.sign(plane.forward @ (middle - plane.hip)) or 1.0) for plane in planes
    ]


def _posture(
    tree: Tree, geometries: Sequence[LegGeometry], stances: Sequence[Stance]
) -> Mapping[str, float]:
    posture = dict(neutral_posture(tree))
    for each, stance in zip(geometries, stances, strict=True):
        posture.update(zip(each.chain.names, map(float, stance.values), strict=True))
    return tree.complete(posture)


def _complaints(geometries: Sequence[LegGeometry], stances: Sequence[Stance]) -> list[str]:
    """One sentence for each leg that its limits keep from standing as wanted."""
    return [
        f"leg '{each.leg.name}' cannot stand level below its hip within its joint limits: its foot "
        f"is {1e3 * stance.miss:.0f} mm off and tilted by {np.degrees(stance.tilt):.1f} deg"
        for each, stance in zip(geometries, stances, strict=True)
        if not stance.good
    ]
