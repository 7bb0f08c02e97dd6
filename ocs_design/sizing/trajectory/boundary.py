"""Maneuvers as boundary value problems: initial state of trunk and wheels, and final conditions.

Attitudes are unit quaternions (w, x, y, z) that turn B into the world.
"""

from dataclasses import dataclass, field

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.quaternions import conjugate, from_axis_angle, product
from ocs_design.requirement.maneuver import Drop, End, Flip, Maneuver, Unforeseen
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.requirement.turns import TurnTo
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
"""Trunk upright, its x axis along the world's."""

HELD_ON = 1.5
"""Time for which a robot that has stood up or recovered is held upright, relative to the time
given."""

_PITCH = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Boundary:
    """A turn of the trunk that ends at rest about all axes that the wheels control.

    Attributes:
        name: of the maneuver.
        attitude: at the start, shape (4,).
        final_attitude: at the end, shape (4,); `end` says which part of it counts.
        axis: unit vector about which the trunk mainly turns, in B, shape (3,).
        angle: of that turn [rad], signed; beyond half a turn it gives the number of revolutions.
        duration: duration of the turn [s].
        end: final condition, one of `End`.
        rate: of the trunk at the start, in B [rad/s], shape (3,).
        wheel_speed: at the start [rad/s], shape (n,) or one for all.
        push: torque on the trunk before the turn, in B [N m], shape (3,).
        push_duration: [s]; the wheels are held until the push ends. 0: no push.
    """

    name: str
    attitude: FloatArray
    final_attitude: FloatArray
    axis: FloatArray
    angle: float
    duration: float
    end: str = End.LEVEL
    rate: FloatArray = field(default_factory=lambda: np.zeros(3))
    wheel_speed: FloatArray | float = 0.0
    push: FloatArray = field(default_factory=lambda: np.zeros(3))
    push_duration: float = 0.0

    @property
    def final_vertical(self) -> FloatArray:
        """The world's upward direction in B at the end, shape (3,)."""
        return vertical_of(self.final_attitude)


def boundary(maneuver: Maneuver, standing_height: float) -> Boundary:
    """The boundary value problem of a maneuver in the air.

    Args:
        standing_height: of the trunk above the ground [m].

    Raises:
        SpecificationError: no time is left after the torque of an unforeseen maneuver.
    """
    x, _, z = np.eye(3)
    if isinstance(maneuver, Drop):
        # From rest, pitched about y and then rolled about x, to level within the fall.
        attitude = product(
            from_axis_angle(_PITCH, maneuver.pitch), from_axis_angle(x, maneuver.roll)
        )
        vertical = vertical_of(attitude)
        # A rate w changes the vertical v by -w x v.
        axis = np.cross([0.0, 0.0, 1.0], vertical)
        length = float(np.linalg.norm(axis))
        axis = axis / length if length > 0.0 else _PITCH
        angle, duration = float(np.arctan2(length, vertical[2])), maneuver.time(standing_height)
        return Boundary(maneuver.name, attitude, UPRIGHT, axis, angle, duration)
    if isinstance(maneuver, Flip):
        angle, final = maneuver.angle, from_axis_angle(_PITCH, maneuver.angle)
        return Boundary(maneuver.name, UPRIGHT, final, _PITCH, angle, maneuver.duration)
    if isinstance(maneuver, Unforeseen):
        if maneuver.time_left <= 0.0:
            raise SpecificationError(
                f"maneuver {maneuver.name!r}: no time is left after its torque",
                hint="Let the torque start earlier, or the robot jump higher.",
            )
        # Back to level in the time left after the torque, from level at its onset.
        return Boundary(
            maneuver.name,
            UPRIGHT,
            UPRIGHT,
            _PITCH,
            0.0,
            maneuver.time_left,
            push=np.array(maneuver.torque),
            push_duration=maneuver.duration,
        )
    if not isinstance(maneuver, TurnTo):
        raise TypeError(f"no boundary is known for a {type(maneuver).__name__}")
    angles = np.array([maneuver.roll, maneuver.pitch, maneuver.yaw])
    final = product(
        from_axis_angle(z, maneuver.yaw),
        product(from_axis_angle(_PITCH, maneuver.pitch), from_axis_angle(x, maneuver.roll)),
    )
    if np.count_nonzero(angles) == 1:
        # About one axis, it may be more than half a turn.
        axis, angle = np.sign(angles), float(np.abs(angles).sum())
    else:
        final = final * np.copysign(1.0, final[0])
        sine = float(np.linalg.norm(final[1:]))
        axis = final[1:] / sine if sine > 0.0 else _PITCH
        angle = 2.0 * float(np.arctan2(sine, final[0]))
    return Boundary(
        maneuver.name,
        UPRIGHT,
        final,
        axis,
        angle,
        maneuver.duration,
        maneuver.end,
        np.array(maneuver.rate),
        maneuver.wheel_speed,
    )


def pivot_boundary(maneuver: Pivoted, gyrostat: Gyrostat) -> Boundary:
    """Turn about a pivot to upright, from a tilt and, after a brake or a push, a rate.

    Args:
        maneuver: of robot and device (`Pivoted.on`).
        gyrostat: of both, about the pivot.
    """
    angle = float(np.linalg.norm(maneuver.tilt))
    axis = maneuver.tilt / angle if angle > 0.0 else _PITCH
    if angle == 0.0 and maneuver.begun.any():
        axis = maneuver.begun / float(np.linalg.norm(maneuver.begun))
    return Boundary(
        name=maneuver.name,
        attitude=product(from_axis_angle(axis, angle), gyrostat.upright),
        final_attitude=gyrostat.upright,
        axis=axis,
        angle=-angle,
        duration=maneuver.duration,
        end=maneuver.end,
        rate=maneuver.begun,
        wheel_speed=maneuver.wheel_speed,
    )


def vertical_of(attitude: FloatArray) -> FloatArray:
    """The world's upward direction in B times the attitude's squared length, shape (..., 3)."""
    w, x, y, z = np.moveaxis(attitude, -1, 0)
    return np.stack(
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z], axis=-1
    )


def turned_into_world(attitude: FloatArray, vectors: FloatArray) -> FloatArray:
    """Vectors of B in the world, shape (..., 3), for attitudes (..., 4)."""
    seen = np.concatenate([np.zeros_like(vectors[..., :1]), vectors], axis=-1)
    return product(product(attitude, seen), conjugate(attitude))[..., 1:]
