"""One flight as plain data: its time series, figures, poses and verdict."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import FloatArray

UPRIGHT_TILT = np.radians(45.0)
"""Largest angle between trunk z axis and vertical at which a robot counts as standing [rad]."""


@dataclass(frozen=True, eq=False)
class Series:
    """Time series of one run with n wheels; instants are the first axis of every array.

    Attributes:
        time: [s], shape (k,).
        com: centre of mass in the world [m], (k, 3).
        roll, pitch, yaw: of the trunk [rad], pitch and yaw unwrapped, (k,).
        rate: of the trunk in B [rad/s], (k, 3).
        wheel_speed: relative to the trunk [rad/s], (k, n).
        wheel_torque: of the motors [N m], (k, n).
        torque_lowest, torque_highest: that the motors can give at these speeds [N m], (k, n); None:
            not limited.
        contact: whether anything touches the floor, (k,).
        wheels: their names.
        bus_power: of all motors together, drawn (+) or fed back (-), of largest magnitude from
            this instant to the next [W], (k,); None: the winding or the supply is not known.
        bus_current: `bus_power` over the supply voltage [A], (k,).
    """

    time: FloatArray
    com: FloatArray
    roll: FloatArray
    pitch: FloatArray
    yaw: FloatArray
    rate: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    torque_lowest: FloatArray | None
    torque_highest: FloatArray | None
    contact: FloatArray
    wheels: tuple[str, ...]
    bus_power: FloatArray | None = None
    bus_current: FloatArray | None = None

    def columns(self) -> Mapping[str, FloatArray]:
        """Each scalar series by name and unit, as in a CSV file."""
        axes, supply = "xyz", {"bus_power_w": self.bus_power, "bus_current_a": self.bus_current}
        return {
            "time_s": self.time,
            **{f"com_{axis}_m": self.com[:, i] for i, axis in enumerate(axes)},
            "roll_rad": self.roll,
            "pitch_rad": self.pitch,
            "yaw_rad": self.yaw,
            **{f"rate_{axis}_rad_s": self.rate[:, i] for i, axis in enumerate(axes)},
            **self._of_wheels("wheel_speed_{}_rad_s", self.wheel_speed),
            **self._of_wheels("wheel_torque_{}_nm", self.wheel_torque),
            **self._of_wheels("wheel_torque_lowest_{}_nm", self.torque_lowest),
            **self._of_wheels("wheel_torque_highest_{}_nm", self.torque_highest),
            **{name: values for name, values in supply.items() if values is not None},
            "contact": self.contact,
        }

    def _of_wheels(self, name: str, values: FloatArray | None) -> Mapping[str, FloatArray]:
        """One column per wheel; none without values."""
        if values is None:
            return {}
        return {name.format(wheel): values[:, i] for i, wheel in enumerate(self.wheels)}


@dataclass(frozen=True)
class Metrics:
    """Figures of one run; None for a figure that does not exist.

    Attributes:
        touchdown_time: last instant in free flight [s], or when a robot on a pivot is to be
            upright and at rest; None: it never touches the floor.
        touchdown_roll, touchdown_pitch: of the trunk from level at that instant, within half a
            turn [rad]; on a pivot, from the balanced attitude, here and below.
        touchdown_rate: of roll and pitch together at that instant, and of yaw if the wheels can
            control it [rad/s].
        turned_angle: since lift-off, whole turns counted, of pitch unless the maneuver counts those
            about another axis [rad].
        heading_drift: about the vertical since lift-off [rad].
        peak_wheel_speed: in flight [rad/s]. peak_wheel_torque: in flight [N m].
        momentum_error: largest change of angular momentum in flight that no outer torque explains,
            over the largest momentum of wheels and trunk in that flight.
        upright_at_end: trunk within 45 deg of upright and above half its standing height.
        final_roll, final_pitch: at the end, within half a turn [rad].
        roll_swing, pitch_swing: peak to peak after touchdown [rad].
        settling_time: from touchdown until roll and pitch stay within 1 deg of their final values
            [s].
        lift_off_time: first instant in free flight [s], or the start of the shove of a standing
            robot; None: it never leaves the ground.
        rise: of the centre of mass from lift-off to its highest point [m].
        final_wheel_speed: of the faster wheel at the end [rad/s].
        nutation: largest angle per physics step by which the spinning wheels make the trunk
            nutate in flight [rad].
    """

    touchdown_time: float | None
    touchdown_roll: float
    touchdown_pitch: float
    touchdown_rate: float
    turned_angle: float
    heading_drift: float
    peak_wheel_speed: float
    peak_wheel_torque: float
    momentum_error: float
    upright_at_end: bool
    final_roll: float
    final_pitch: float
    roll_swing: float
    pitch_swing: float
    settling_time: float
    lift_off_time: float | None
    rise: float
    final_wheel_speed: float
    nutation: float


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of a model at successive instants.

    Attributes:
        time: [s], shape (n,).
        qpos: of the simulated model, free joint first as (x, y, z) [m] and quaternion (w, x, y, z),
            then joints [rad or m]; shape (n, nq).
        bodies: names of the model's b bodies, without the world.
        position: of their frames in the world [m], shape (n, b, 3).
        attitude: of their frames in the world, quaternions (w, x, y, z), shape (n, b, 4).
        wheel_angle: of each wheel, whole turns counted [rad], shape (n, wheels).
    """

    time: FloatArray
    qpos: FloatArray
    bodies: tuple[str, ...]
    position: FloatArray
    attitude: FloatArray
    wheel_angle: FloatArray


@dataclass(frozen=True, eq=False)
class Run:
    """One flight.

    Attributes:
        scenario: name of the maneuver. ocs: True with the device, False for the bare robot.
        passed: True, False, or None if it cannot be judged. reason: one sentence.
        metrics: None if the simulation became unstable.
        series: time series. note: see `World`.
        poses: to show the flight again; None if none were recorded.
        can_stand: whether the legs bear a level landing from this flight, see `judge`.
        level, stands: see `Verdict`.
    """

    scenario: str
    ocs: bool
    passed: bool | None
    reason: str
    metrics: Metrics | None
    series: Series
    note: str
    can_stand: bool | None
    poses: Poses | None = None
    level: bool | None = None
    stands: bool | None = None

    def __repr__(self) -> str:
        return f"<Run {self.scenario} {'with' if self.ocs else 'without'} device: {self.reason}>"
