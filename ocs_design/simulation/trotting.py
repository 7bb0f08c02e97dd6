"""A trot on the spot by the joint drives alone: the feet lift in diagonal pairs, turn by turn.

Nothing places the feet by what the trunk does: what calms a robot that is shoved is that its feet
stand apart, and the device.
"""

from collections.abc import Iterable

import numpy as np

from ocs_design.common.arrays import FloatArray, interpolated
from ocs_design.common.errors import SpecificationError
from ocs_design.jumping.jump import LegTrajectory
from ocs_design.jumping.legged_body import obstacle_to_jumping
from ocs_design.requirement.froude import Scale
from ocs_design.requirement.maneuver import Maneuver, Shove
from ocs_design.robot.leg_geometry import LegGeometry, leg_geometries
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import lifted

STEP_HEIGHT = 0.02
"""How high Solo12 lifts its feet [m]; other robots in proportion."""

DUTY = 0.8
"""Share of its stride that a foot is on the ground: all four are for three fifths of it. While two
are in the air a robot with narrow feet topples, and has to be caught again (A1 is not at 0.7)."""

_UNLOADING = 3.0
"""A foot bears nothing from a ninth of its swing on: `3 sin(pi s) = 1`."""

TROTTED = 3.0
"""How long it trots before it is shoved, over how long others stand."""

_QUADRANTS = 4
_SAMPLE = 2e-3
"""[s], between two samples of the references."""

_HEIGHTS = 21


def waiting(
    maneuver: Maneuver, robot: Robot, weight: float, settling: float
) -> tuple[float | None, LegTrajectory | None]:
    """How long a robot waits on the ground until it is shoved [s], and what its legs track.

    It stands until they have given way under its weight, or trots.

    Returns:
        None: it is not shoved; None: the legs hold their posture.

    Args:
        weight: of the robot with what it carries [N].
        settling: how long it stands, and is watched afterwards [s].

    Raises:
        SpecificationError: it is to trot and has no two diagonal pairs of point feet.
    """
    if not isinstance(maneuver, Shove):
        return None, None
    if not maneuver.stride:
        return settling, None
    duration = shoved_at(maneuver.stride, TROTTED * settling)
    return duration, trot(robot, maneuver.stride, settling, duration + settling, weight)


def require_trot(maneuvers: Iterable[Maneuver], robot: Robot) -> None:
    """Refuse what the robot cannot do before anything else is done for it.

    Raises:
        SpecificationError: one of them has it trot, and it cannot.
    """
    if any(isinstance(maneuver, Shove) and maneuver.stride for maneuver in maneuvers):
        _pairs(robot, leg_geometries(robot.tree, robot.trunk, robot.legs))


def trot(
    robot: Robot, stride: float, start: float, duration: float, weight: float
) -> LegTrajectory:
    """What the joints track in a trot on the spot.

    Args:
        stride: of each foot [s].
        start: in which the steps grow from nothing to their height [s]. duration: of all of it [s].
        weight: of the robot with what it carries [N].

    Raises:
        SpecificationError: the robot has no two diagonal pairs of point feet.
    """
    geometries = leg_geometries(robot.tree, robot.trunk, robot.legs)
    height = STEP_HEIGHT * Scale.of(robot).length
    time = np.arange(0.0, duration + _SAMPLE, _SAMPLE)
    growth = np.clip(time / start, 0.0, 1.0)
    # Share of its swing that each foot has behind it, 0 where it stands.
    phase = (time / stride + 0.5 * _pairs(robot, geometries)[:, None]) % 1.0
    swing = np.maximum(phase - DUTY, 0.0) / (1.0 - DUTY)
    share = 1.0 - growth * np.minimum(1.0, _UNLOADING * np.sin(np.pi * swing))
    force = weight * share / share.sum(axis=0)
    lift = height * growth * np.sin(np.pi * swing) ** 2
    legs = [_lifting(each, robot, height, lift[i], force[i]) for i, each in enumerate(geometries)]
    position = np.hstack([angles for angles, _ in legs])
    return LegTrajectory(
        joints=tuple(name for each in geometries for name in each.chain.names),
        time=time,
        position=position,
        velocity=np.gradient(position, _SAMPLE, axis=0),
        torque=np.hstack([torques for _, torques in legs]),
        lift_off=0.0,
    )


def shoved_at(stride: float, earliest: float) -> float:
    """The first instant from `earliest` on at which the first pair of feet lifts [s]."""
    return float((np.ceil(earliest / stride - DUTY) + DUTY) * stride)


def _pairs(robot: Robot, geometries: tuple[LegGeometry, ...]) -> FloatArray:
    """Which of both diagonals each foot is on, shape (feet,)."""
    obstacle = obstacle_to_jumping(robot)
    postures = [np.array([robot.posture[n] for n in each.chain.names]) for each in geometries]
    feet = np.array(
        [
            each.chain.pose(posture).point(each.leg.foot)
            for each, posture in zip(geometries, postures, strict=True)
        ]
    ).reshape(-1, 3)
    quadrants = len(np.unique(np.sign(feet[:, :2]), axis=0))
    if obstacle or not len(feet) == quadrants == _QUADRANTS:
        why = obstacle or "it does not have just one front foot and one rear foot on each side"
        raise SpecificationError(
            f"{robot.name} cannot trot: {why}",
            hint="leave `stride` out of the maneuver: the robot is then shoved while it stands",
        )
    return np.where(feet[:, 0] * feet[:, 1] > 0.0, 0.0, 1.0)


def _lifting(
    each: LegGeometry, robot: Robot, highest: float, lift: FloatArray, force: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Joints of a leg [rad or m] and their torques at k instants, shape (k, n) each.

    The foot goes straight up from the nominal posture.

    Args:
        each: the leg. highest: it lifts its foot [m].
        lift: of the foot [m], shape (k,). force: of the ground on it, upwards [N], shape (k,).
    """
    chain, leg, heights = each.chain, each.leg, np.linspace(0.0, highest, _HEIGHTS)
    posture = np.array([robot.posture[name] for name in chain.names])
    positions = lifted(chain, leg.foot, leg.length, posture, heights)
    # Torques with which the joints hold against 1 N on the foot.
    poses = [chain.pose(values) for values in positions]
    bearing = [-chain.point_jacobian(pose, pose.point(leg.foot))[2] for pose in poses]
    torques = interpolated(lift, heights, np.array(bearing)) * force[:, None]
    return interpolated(lift, heights, positions), torques
