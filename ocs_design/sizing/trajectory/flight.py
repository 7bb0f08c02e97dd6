"""Check of a planned maneuver: its torques are integrated again, independently of the collocation.

Rate and wheel speeds follow from the equations of Euler and of the motors, not from conserved
momentum, by classical Runge-Kutta steps on a grid ten times finer than the program's.
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import cross
from ocs_design.common.quaternions import conjugate, product, rotated_to_world, scaled_vertical
from ocs_design.sizing.trajectory.motion import Motion, Trajectory
from ocs_design.sizing.trajectory.transcription import Phase

FINER = 10
"""Steps for each interval of the program."""

VIOLATION_MAX = 1e-5
"""Largest relative violation of a drive's limit that is accepted on the fine grid."""

DEFECT_MAX = 1e-4
"""Largest difference of the trunk's rate, relative to its largest, that is accepted there."""


@dataclass(frozen=True, eq=False)
class Flight:
    """A maneuver integrated on the fine grid, compared with the limits and the program's result.

    Attributes:
        trajectory: on the fine grid.
        violation: largest violation of the drive's limits, relative to each.
        defect: largest difference from the program's own rate, relative to the largest rate.
    """

    trajectory: Trajectory
    violation: float
    defect: float

    @property
    def failure(self) -> str:
        """The error that is too large, in a few words; empty if none is."""
        if self.violation > VIOLATION_MAX:
            return f"the finer grid oversteps a limit by {self.violation:.1e}"
        if self.defect > DEFECT_MAX:
            return f"an integration of its torques differs by {self.defect:.1e}"
        return ""


def fly(phase: Phase, line: DriveLine, motion: Motion) -> Flight:
    """Integrate the torques of a motion from the start of the turn, for this robot and device."""
    boundary, gyrostat, turn = phase.boundary, phase.gyrostat, phase.outline
    wheels = gyrostat.axes.shape[1]
    mass_matrix = gyrostat.mass_matrix
    inverse, gravity_moment = gyrostat.inverse_mass_matrix, gyrostat.gravity_moment

    def slope(state: FloatArray, torque: FloatArray) -> FloatArray:
        """Rates of change of attitude, rate and wheel speeds, shape (7 + n,)."""
        rate = state[4:7]
        trunk_torque = cross(mass_matrix[:3] @ state[4:], rate)
        if gyrostat.stands:
            trunk_torque += cross(scaled_vertical(state[:4]), gravity_moment)
        accelerations = inverse @ np.concatenate([trunk_torque, torque])
        turning = 0.5 * product(state[:4], np.append(0.0, rate))
        return np.concatenate([turning, accelerations])

    steps = np.repeat(motion.lengths / FINER, FINER)
    offsets = np.arange(FINER) / FINER
    first, middle, last = (
        motion.torque_within(offsets + fraction / FINER) for fraction in (0.0, 0.5, 1.0)
    )
    rate = turn.rate * turn.axis
    speed = np.broadcast_to(np.asarray(boundary.wheel_speed), (wheels,))
    state = np.concatenate([turn.attitude, rate, speed])
    states = [state]
    for h, before, halfway, after in zip(steps, first, middle, last, strict=True):
        k1 = slope(state, before)
        k2 = slope(state + h / 2.0 * k1, halfway)
        k3 = slope(state + h / 2.0 * k2, halfway)
        k4 = slope(state + h * k3, after)
        state = state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states.append(state)
    integrated = np.array(states)
    torque = np.vstack([first[:1], (first[1:] + last[:-1]) / 2.0, last[-1:]])
    trajectory = Trajectory(
        time=np.append(0.0, np.cumsum(steps)),
        vertical=scaled_vertical(integrated[:, :4]),
        rate=integrated[:, 4:7],
        acceleration=np.array([slope(*row)[4:7] for row in zip(integrated, torque, strict=True)]),
        wheel_speed=integrated[:, 7:],
        wheel_torque=torque,
        note="",
        step_torque=np.stack([first, last], axis=1),
        attitude=integrated[:, :4],
    )
    planned = motion.state_at(trajectory.time)
    momentum = rotated_to_world(turn.attitude, mass_matrix[:3] @ np.append(rate, speed))
    if gyrostat.stands:
        momentum = planned[4 + wheels :].T
    attitude = planned[:4].T
    momentum_in_trunk = rotated_to_world(
        conjugate(attitude), np.broadcast_to(momentum, (len(attitude), 3))
    )
    trunk_momentum = (
        momentum_in_trunk.T - gyrostat.spin_inertia * gyrostat.axes @ planned[4 : 4 + wheels]
    )
    planned_rate = (gyrostat.mobility @ trunk_momentum).T
    largest = float(np.abs(planned_rate).max())
    difference = float(np.abs(trajectory.rate - planned_rate).max())
    return Flight(
        trajectory,
        # Before and after each jump: both torques may be within limits, and their mean not.
        violation=max(
            limit_violation(trajectory.wheel_speed[:-1], first, line),
            limit_violation(trajectory.wheel_speed[1:], last, line),
        ),
        defect=difference / largest if largest > 0.0 else 0.0,
    )


def limit_violation(speed: FloatArray, torque: FloatArray, line: DriveLine) -> float:
    """Largest relative violation of current, voltage line, speed and power; 0 if none."""
    slope = line.no_load_speed / line.stall_torque
    power = np.sum(torque * (slope * torque + speed), axis=-1)
    return float(
        np.max(
            [
                np.abs(torque).max() / line.torque_limit - 1.0,
                np.abs(speed + slope * torque).max() / line.no_load_speed - 1.0,
                np.abs(speed).max() / line.speed_max - 1.0,
                np.abs(power).max() / (torque.shape[-1] * line.power_max) - 1.0,
                0.0,
            ]
        )
    )
