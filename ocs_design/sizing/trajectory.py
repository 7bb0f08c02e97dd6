"""A maneuver in 3-D over time, as optimal control gives it and the validation tracks it."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Trunk and wheels from the start of a turn to its end; between samples linear.

    Attributes:
        time: from lift-off or release [s], shape (n,), increasing, from 0.
        vertical: the world's upward direction in B, unit vectors, shape (n, 3).
        rate: of the trunk in B [rad/s], shape (n, 3).
        acceleration: of the trunk in B [rad/s^2], shape (n, 3).
        wheel_speed: relative to the trunk [rad/s], shape (n, 2).
        wheel_torque: of the motors at the wheels [N m], shape (n, 2).
        turned: angle that the trunk has turned about the maneuver's axis [rad], shape (n,).
        note: what a reader should know of it; empty if nothing.
    """

    time: FloatArray
    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    turned: FloatArray
    note: str
