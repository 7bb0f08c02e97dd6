"""Postures in which a device has to stand clear of the robot, or may be hit."""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache

import numpy as np

from ocs_design.robot.obstacles.obstacles import Obstacles, Poses, Posture
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance.leg_geometry import leg_geometries
from ocs_design.robot.tree import JointKind

GIVE = 0.4
PITCH_GIVE = 0.7
KNEE_GIVE = 0.5 * np.pi
"""How far the joints of a leg leave the nominal posture, knees and other pitch joints farther than
those that spread or twist the leg [rad]; see docs/theory.md, Placement."""

_SLIDE_GIVE = 0.5
"""Likewise for slides, over their leg's length."""

SAMPLES = 512
"""Postures of each range."""

_OVERSHOOT = 0.1
"""Share of a range that is drawn beyond either end and put at that end, where most is hit."""

Ranges = Mapping[str, tuple[float, float]]
"""Lower and upper value of driven joints [rad or m]; those that are not in it are held."""


def landing_ranges(robot: Robot) -> Ranges:
    """What legs may do about the nominal posture, which their drives hold but not stiffly."""
    gives: dict[str, float] = {}
    for each in leg_geometries(robot.tree, robot.trunk, robot.legs) if robot.legs else ():
        pitch = [each.chain.names[column] for column in each.plane.pitch]
        for name in each.leg.joints:
            slide = _SLIDE_GIVE * each.leg.length
            gives[name] = _give(name, pitch) if _turns(robot, name) else slide
    return {name: _around(robot, name, give) for name, give in gives.items()}


def _give(name: str, pitch: Sequence[str]) -> float:
    """Of a hinge; the second pitch joint is the knee."""
    if name in pitch[1:2]:
        return KNEE_GIVE
    return PITCH_GIVE if name in pitch else GIVE


def full_ranges(robot: Robot, names: Iterable[str]) -> Ranges:
    """Everything within the limits of some joints; hinges at most half a turn to each side."""
    return {name: _around(robot, name, np.pi if _turns(robot, name) else np.inf) for name in names}


def drawn(ranges: Ranges, count: int = SAMPLES) -> Sequence[Posture]:
    """Postures at random within the ranges, the same ones each time; joints move independently."""
    if not ranges:
        return ()
    lower, upper = np.array(list(ranges.values())).T
    unit = np.random.default_rng(0).random((count, len(ranges)))
    share = np.clip(unit * (1.0 + 2.0 * _OVERSHOOT) - _OVERSHOOT, 0.0, 1.0)
    values = lower + share * (upper - lower)
    return [dict(zip(ranges, map(float, row), strict=True)) for row in values]


@lru_cache(maxsize=1)
def landing_poses(obstacles: Obstacles) -> Poses:
    """The nominal posture, and those of `landing_ranges`."""
    return obstacles.poses([{}, *drawn(landing_ranges(obstacles.robot))])


def _turns(robot: Robot, name: str) -> bool:
    return robot.tree.joints[name].kind is JointKind.REVOLUTE


def _around(robot: Robot, name: str, way: float) -> tuple[float, float]:
    """So far to both sides of the nominal posture, within the limits."""
    joint, value = robot.tree.joints[name], robot.posture[name]
    # A posture may lie beyond a limit, and a slide may have none.
    lower, upper = max(joint.lower, value - way), min(joint.upper, value + way)
    return _finite(min(lower, value), value), _finite(max(upper, value), value)


def _finite(limit: float, otherwise: float) -> float:
    return float(limit if np.isfinite(limit) else otherwise)
