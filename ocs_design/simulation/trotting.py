"""A trot on the spot by the joint drives alone: the feet lift in alternating diagonal pairs.

Foot placement does not react to the trunk: only the width of the stance and the device steady a
robot that is shoved.
"""

from collections.abc import Iterable

import numpy as np

from ocs_design.common.arrays import FloatArray, interpolated
from ocs_design.common.errors import SpecificationError
from ocs_design.jumping.jump import LegTrajectory
from ocs_design.jumping.legged_body import obstacle_to_jumping
from ocs_design.requirement.froude import FroudeScale
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.leg_geometry import LegGeometry, leg_geometries
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import lifted

STEP_HEIGHT = 0.02
"""Height to which Solo12 lifts its feet [m]; other robots in proportion."""

DUTY = 0.8
"""Share of its stride that a foot is on the ground: all four are for three fifths of it. While two
are in the air a robot with a narrow stance topples, and must recover (A1 does not at 0.7)."""

_UNLOADING = 3.0
"""A foot is unloaded after a ninth of its swing: `3 sin(pi s) = 1`."""

TROT_TIME = 3.0
"""Time of trotting before the shove, over the time for which robots otherwise stand."""

_QUADRANTS = 4
_SAMPLE = 2e-3
"""Time between two samples of the references [s]."""

_HEIGHTS = 21


def waiting(
    maneuver: Maneuver, robot: Robot, weight: float, settling: float
) -> tuple[float | None, LegTrajectory | None]:
    """Time that a robot waits on the ground for its shove [s], and what its legs track meanwhile.

    It stands until its legs have settled under its weight, or trots.

    Returns:
        Time, None if it is not shoved; trajectory, None if the legs hold their posture.

    Args:
        weight: of the robot with what it carries [N].
        settling: how long it stands, and is simulated after the shove [s].

    Raises:
        SpecificationError: it is to trot but lacks two diagonal pairs of point feet.
    """
    if not maneuver.on_feet:
        return None, None
    if not maneuver.stride:
        return settling, None
    duration = shove_instant(maneuver.stride, TROT_TIME * settling)
    return duration, trot(robot, maneuver.stride, settling, duration + settling, weight)


def require_trot(maneuvers: Iterable[Maneuver], robot: Robot) -> None:
    """Refuse maneuvers with a trot for a robot that cannot trot.

    Raises:
        SpecificationError: one of them needs a trot, and the robot cannot trot.
    """
    if any(maneuver.stride for maneuver in maneuvers):
        _diagonals(robot, leg_geometries(robot.tree, robot.trunk, robot.legs))


def trot(
    robot: Robot, stride: float, start: float, duration: float, weight: float
) -> LegTrajectory:
    """Joint references of a trot on the spot.

    Args:
        stride: period of each foot [s].
        start: time over which the steps grow from zero to full height [s]. duration: in all [s].
        weight: of the robot with what it carries [N].

    Raises:
        SpecificationError: the robot lacks two diagonal pairs of point feet.
    """
    geometries = leg_geometries(robot.tree, robot.trunk, robot.legs)
    height = STEP_HEIGHT * FroudeScale.of(robot).length
    time = np.arange(0.0, duration + _SAMPLE, _SAMPLE)
    growth = np.clip(time / start, 0.0, 1.0)
    # Completed share of each foot's swing; 0 in stance.
    phase = (time / stride + 0.5 * _diagonals(robot, geometries)[:, None]) % 1.0
    swing = np.maximum(phase - DUTY, 0.0) / (1.0 - DUTY)
    share = 1.0 - growth * np.minimum(1.0, _UNLOADING * np.sin(np.pi * swing))
    force = weight * share / share.sum(axis=0)
    lift = height * growth * np.sin(np.pi * swing) ** 2
    legs = [
        _lift_leg(geometry, robot, height, lift[i], force[i])
        for i, geometry in enumerate(geometries)
    ]
    position = np.hstack([angles for angles, _ in legs])
    return LegTrajectory(
        joints=tuple(name for geometry in geometries for name in geometry.chain.names),
        time=time,
        position=position,
        velocity=np.gradient(position, _SAMPLE, axis=0),
        torque=np.hstack([torques for _, torques in legs]),
        lift_off=0.0,
    )


def shove_instant(stride: float, earliest: float) -> float:
    """First instant not before `earliest` at which the first pair of feet lifts [s]."""
    return float((np.ceil(earliest / stride - DUTY) + DUTY) * stride)


def _diagonals(robot: Robot, geometries: tuple[LegGeometry, ...]) -> FloatArray:
    """Diagonal that each foot is on, 0 or 1, shape (feet,)."""
    obstacle = obstacle_to_jumping(robot)
    postures = [
        np.array([robot.posture[n] for n in geometry.chain.names]) for geometry in geometries
    ]
    feet = np.array(
        [
            geometry.chain.pose(posture).point(geometry.leg.foot)
            for geometry, posture in zip(geometries, postures, strict=True)
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


def _lift_leg(
    geometry: LegGeometry, robot: Robot, highest: float, lift: FloatArray, force: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Joints of a leg [rad or m] and their torques at k instants, shape (k, n) each.

    The foot goes straight up from the nominal posture.

    Args:
        geometry: the leg. highest: largest lift of its foot [m].
        lift: of the foot [m], shape (k,). force: of the ground on it, upwards [N], shape (k,).
    """
    chain, leg, heights = geometry.chain, geometry.leg, np.linspace(0.0, highest, _HEIGHTS)
    posture = np.array([robot.posture[name] for name in chain.names])
    positions = lifted(chain, leg.foot, leg.length, posture, heights)
    # Joint torques that balance 1 N on the foot.
    poses = [chain.pose(values) for values in positions]
    torques_per_force = [-chain.point_jacobian(pose, pose.point(leg.foot))[2] for pose in poses]
    torques = interpolated(lift, heights, np.array(torques_per_force)) * force[:, None]
    return interpolated(lift, heights, positions), torques
