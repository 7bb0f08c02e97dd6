"""Attitude and wheel speeds over time, as polynomials and as samples, and initial guesses."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.quaternions import (
    conjugate,
    from_axis_angle,
    product,
    rotated_to_world,
    scaled_vertical,
)
from ocs_design.requirement.boundary import Boundary
from ocs_design.requirement.turns import loop_length
from ocs_design.sizing.trajectory.collocation import (
    BERNSTEIN,
    DEGREE,
    NODES,
    TORQUE_DEGREE,
    bernstein_basis,
)
from ocs_design.sizing.trajectory.gyrostat import NO_AUTHORITY, Gyrostat

_INSIDE = 1e-6
"""Distance inside an interval at which its ends are read: torques may jump between intervals."""

_EVEN = 0.4
"""Fraction of refined intervals that is spread evenly over time."""

_SAMPLES = 16

UNEVEN = 0.2
"""Difference between wheels of an uneven initial guess, relative to their largest speed."""


@dataclass(frozen=True, eq=False)
class Motion:
    """States and torques over k intervals, SI.

    Attributes:
        lengths: of the intervals [s], shape (k,).
        states: attitude and wheel speeds [rad/s] at the nodes of all intervals, which share their
            ends, shape (4 + n, k d + 1) with d = `DEGREE`; about a pivot, the momentum about it in
            the world [N m s] in three additional rows.
        torques: Bernstein coefficients of the motor torques of each interval [N m], shape (n, 3 k).
    """

    lengths: FloatArray
    states: FloatArray
    torques: FloatArray

    @property
    def starts(self) -> FloatArray:
        """Starts of the intervals [s], shape (k,)."""
        return np.append(0.0, np.cumsum(self.lengths)[:-1])

    def state_at(self, times: FloatArray) -> FloatArray:
        """States at given times [s], shape (4 + n, len(times)), or with three additional rows."""
        interval, s = self._locate(times)
        nodes = interval[:, None] * DEGREE + np.arange(DEGREE + 1)
        weights = bernstein_basis(s, DEGREE) @ BERNSTEIN
        return np.asarray(np.einsum("imj,mj->im", self.states[:, nodes], weights))

    def torque_at(self, times: FloatArray) -> FloatArray:
        """Torques [N m], shape (n, len(times)); where two intervals meet, of the later one."""
        interval, s = self._locate(times)
        coefficients = interval[:, None] * (TORQUE_DEGREE + 1) + np.arange(TORQUE_DEGREE + 1)
        return np.asarray(
            np.einsum("imj,mj->im", self.torques[:, coefficients], bernstein_basis(s))
        )

    def torque_within(self, s: FloatArray) -> FloatArray:
        """Torques in every interval at s = 0..1 [N m], shape (k len(s), n), ordered by time."""
        wheels, count = len(self.torques), len(self.lengths)
        coefficients = self.torques.reshape(wheels, count, TORQUE_DEGREE + 1)
        values: FloatArray = np.einsum("ikj,sj->ksi", coefficients, bernstein_basis(s))
        return values.reshape(count * len(s), wheels)

    def uneven(self, gyrostat: Gyrostat) -> "Motion":
        """Nearly the same motion with wheels that do not all move alike.

        Where layout and turn are symmetric, equal motion of the wheels is a saddle point of the
        peak power, which a solver takes long to leave: less power is needed if they brake in turn.
        Wheel speeds that do not move the trunk are kept at the end; otherwise the change is undone.
        """
        wheels = len(self.torques)
        offsets = -np.arange(wheels) / wheels
        idle = offsets - np.linalg.pinv(gyrostat.axes, rcond=NO_AUTHORITY) @ gyrostat.axes @ offsets
        persists = bool(np.abs(idle).max() > NO_AUTHORITY)
        largest = UNEVEN * np.abs(self.states[4 : 4 + wheels]).max()
        speeds = largest * (idle / np.abs(idle).max() if persists else offsets)
        time = self.lengths.sum()
        starts, lengths = self.starts[:, None] / time, self.lengths[:, None] / time
        s = np.append(0.0, (starts + lengths * NODES[1:]).ravel())
        points = (starts + lengths * np.array([0.0, 0.5, 1.0])).ravel()
        share, slope = (
            (s**2, 2.0 * points) if persists else (s**2 * (1.0 - s), 2.0 * points - 3.0 * points**2)
        )
        slope = _parabolas(slope)
        states, driven_inertia = self.states.copy(), gyrostat.spin_inertia + gyrostat.armature
        states[4 : 4 + wheels] += np.outer(speeds, share)
        torques = self.torques + np.outer(driven_inertia * speeds / time, slope)
        return Motion(self.lengths, states, torques)

    def on_intervals(self, lengths: FloatArray) -> "Motion":
        """Nearly the same motion on other intervals."""
        starts = np.append(0.0, np.cumsum(lengths)[:-1])[:, None]
        nodes = starts + lengths[:, None] * NODES[1:]
        ends = starts + lengths[:, None] * np.array([_INSIDE, 0.5, 1.0 - _INSIDE])
        torques = _parabolas(self.torque_at(ends.ravel()))
        return Motion(lengths, self.state_at(np.append(0.0, nodes.ravel())), torques)

    def refined(self, intervals: int) -> "Motion":
        """Nearly the same motion on intervals that are short where the torques change.

        Each takes an equal share of a weighted sum of elapsed time and total variation of the
        torques. The variation is also spread over neighbouring intervals, as a switch moves
        slightly when the mesh is refined.
        """
        count = len(self.lengths)
        torque = self.torque_within(np.linspace(0.0, 1.0, _SAMPLES)).reshape(count, _SAMPLES, -1)
        within = np.abs(np.diff(torque, axis=1)).sum(axis=(1, 2))
        jumps = np.append(np.abs(torque[1:, 0] - torque[:-1, -1]).sum(axis=1), 0.0)
        variation = within + jumps
        spread = np.convolve(np.pad(variation, 1, mode="edge"), [0.25, 0.5, 0.25], mode="valid")
        time_density = self.lengths / self.lengths.sum()
        density = _EVEN * time_density + (1.0 - _EVEN) * spread / max(
            spread.sum(), np.finfo(float).tiny
        )
        cumulated = np.append(0.0, np.cumsum(density / density.sum()))
        edges = np.append(self.starts, self.lengths.sum())
        return self.on_intervals(
            np.diff(np.interp(np.linspace(0.0, 1.0, intervals + 1), cumulated, edges))
        )

    def _locate(self, times: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
        """Interval of each time, and the fraction of it elapsed, 0..1."""
        starts = self.starts
        interval = np.searchsorted(starts, times, side="right") - 1
        return interval, (times - starts[interval]) / self.lengths[interval]


def _parabolas(values: FloatArray) -> FloatArray:
    """Bernstein coefficients of parabolas through values at start, middle and end, (..., 3 k)."""
    coefficients = values.copy()
    coefficients[..., 1::3] = (
        2.0 * values[..., 1::3] - (values[..., 0::3] + values[..., 2::3]) / 2.0
    )
    return coefficients


def _even_mesh(duration: float, intervals: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lengths of even intervals [s], and their nodes and ends as fractions of the time.

    The ends of each interval include its midpoint.
    """
    edges = np.arange(intervals)[:, None] / intervals
    nodes = np.append(0.0, (edges + NODES[1:] / intervals).ravel())
    ends = (edges + np.array([0.0, 0.5, 1.0]) / intervals).ravel()
    return np.full(intervals, duration / intervals), nodes, ends


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Trunk and wheels from the start of a turn to its end, linear between samples.

    Attributes:
        time: from lift-off or release, or the end of a push [s], shape (m,), increasing, from 0.
        vertical: the world's upward direction in B, unit vectors, shape (m, 3).
        rate: of the trunk in B [rad/s], shape (m, 3).
        acceleration: of the trunk in B [rad/s^2], shape (m, 3).
        wheel_speed: relative to the trunk [rad/s], shape (m, n).
        wheel_torque: of the motors at the wheels [N m], shape (m, n); where it jumps, the mean of
            both sides.
        note: remark for the reader; may be empty.
        step_torque: of the motors at start and end of each step, shape (m - 1, 2, n) [N m]; None:
            `wheel_torque` has no jumps.
        attitude: of the trunk, quaternions (w, x, y, z), shape (m, 4); None: only tilt is known.
        gains: from the errors of attitude, as the rotation vector from the plan in B [rad], of rate
            in B [rad/s] and of wheel speeds [rad/s] to the torque subtracted from the planned one
            [N m], shape (m, n, 6 + n); None: the tilt is fed back with constant gains.
    """

    time: FloatArray
    vertical: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    note: str
    step_torque: FloatArray | None = None
    attitude: FloatArray | None = None
    gains: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class FixedAxisTurn:
    """Initial guess: a cubic from one angle and rate to another angle at rest.

    Attributes:
        attitude: at the start, shape (4,). axis: unit vector, in B, shape (3,).
        rate: at the start [rad/s]. angle: at the end, 0 at the start [rad]. duration: [s].
    """

    attitude: FloatArray
    axis: FloatArray
    rate: float
    angle: float
    duration: float

    @classmethod
    def of(cls, boundary: Boundary, attitude: FloatArray, rate: FloatArray) -> "FixedAxisTurn":
        """The turn that a maneuver requires.

        Attitude, shape (4,), and rate of the trunk in B [rad/s], shape (3,), are those at its
        start, which is the end of a push.
        """
        speed = float(np.linalg.norm(rate))
        if speed == 0.0:
            return cls(attitude, boundary.axis, 0.0, boundary.angle, boundary.duration)
        # A push has turned the trunk about the axis of its rate, which must be undone; a brake has
        # set it in motion towards the final attitude.
        vertical, final_vertical = scaled_vertical(attitude), boundary.final_vertical
        tilt_left = float(np.arccos(np.clip(vertical @ final_vertical, -1.0, 1.0)))
        approaches = np.cross(vertical, rate) @ final_vertical > 0.0
        return cls(
            attitude,
            rate / speed,
            speed,
            tilt_left if approaches else -tilt_left,
            boundary.duration,
        )

    def motion(self, gyrostat: Gyrostat, intervals: int) -> Motion:
        """The turn on even intervals with the wheels that drive it, ignoring their limits."""
        lengths, nodes, ends = _even_mesh(self.duration, intervals)
        angle, rate, _ = self._profile(nodes)
        _, _, acceleration = self._profile(ends)
        # Wheel speeds that absorb a momentum of the trunk, per unit of momentum.
        speed_per_momentum = gyrostat.sharing * gyrostat.reaction / gyrostat.spin_inertia
        momentum = gyrostat.inertia @ self.axis
        speeds = speed_per_momentum @ np.outer(momentum, self.rate - rate)
        driven_inertia = gyrostat.spin_inertia + gyrostat.armature
        torques = -driven_inertia * speed_per_momentum @ np.outer(momentum, acceleration)
        attitudes = product(self.attitude, from_axis_angle(self.axis, angle))
        states = [attitudes.T, speeds]
        if gyrostat.stands:
            # The initial guess is a motion without gravity.
            momenta = np.outer(momentum, rate) + gyrostat.spin_inertia * gyrostat.axes @ speeds
            states.append(rotated_to_world(attitudes, momenta.T).T)
        return Motion(lengths, np.vstack(states), torques)

    def _profile(self, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Angle [rad], rate and acceleration at s = 0..1."""
        run, end, time = self.rate * self.duration, self.angle, self.duration
        angle = end * s**2 * (3.0 - 2.0 * s) + run * s * (1.0 - s) ** 2
        slope = 6.0 * end * s * (1.0 - s) + run * (1.0 - s) * (1.0 - 3.0 * s)
        bend = 6.0 * end * (1.0 - 2.0 * s) + run * (6.0 * s - 4.0)
        return angle, slope / time, bend / time**2


@dataclass(frozen=True, eq=False)
class HeadingLoop:
    """Initial guess of a change of heading by wheels that cannot control yaw.

    Without momentum about z such a trunk never turns about its own z axis, and that axis rolls on
    the sphere: after a closed path the heading has changed by the solid angle that the path
    encloses (docs/theory.md, Yaw by two wheels). The shortest such path is a circle of radius b
    with `heading = 2 pi (1 - cos b)`; its direction in B turns by `cot b` per length.

    Attributes:
        attitude: at the start, shape (4,).
        swing: additional turn without heading, a rotation vector in B at the start [rad], shape
            (3,).
        heading: within half a turn [rad].
        initial_direction: of the path in B, from x [rad].
        duration: [s].
    """

    attitude: FloatArray
    swing: FloatArray
    heading: float
    initial_direction: float
    duration: float

    def motion(self, gyrostat: Gyrostat, intervals: int) -> Motion:
        """The loop on even intervals with the wheels that drive it, from rest, ignoring limits."""
        lengths, nodes, ends = _even_mesh(self.duration, intervals)
        speed_per_momentum = -gyrostat.sharing * gyrostat.reaction / gyrostat.spin_inertia
        to_speeds = speed_per_momentum @ gyrostat.inertia
        change = (self._rate(ends + _INSIDE) - self._rate(ends - _INSIDE)) / (2.0 * _INSIDE)
        driven_inertia = gyrostat.spin_inertia + gyrostat.armature
        torques = driven_inertia * to_speeds @ change / self.duration
        return Motion(
            lengths, np.vstack([self._path(nodes).T, to_speeds @ self._rate(nodes)]), torques
        )

    def _path(self, s: FloatArray) -> FloatArray:
        """Attitudes at s = 0..1, shape (len(s), 4).

        In B rotated back by the direction of the path, the rate per length is constant: `(1, 0, cot
        b)`.
        """
        share = s**2 * (3.0 - 2.0 * s)
        radius = np.arccos(1.0 - abs(self.heading) / (2.0 * np.pi))
        bend = np.copysign(1.0 / np.tan(radius), self.heading) if radius else 0.0
        axis = np.array([1.0, 0.0, bend]) / np.hypot(1.0, bend)
        z = np.array([0.0, 0.0, 1.0])
        length = loop_length(self.heading) * share
        turned_back = from_axis_angle(z, -bend * length - self.initial_direction)
        loop = product(from_axis_angle(axis, np.hypot(1.0, bend) * length), turned_back)
        angle = float(np.linalg.norm(self.swing))
        swing = from_axis_angle(self.swing / angle if angle else z, angle * share)
        turned = from_axis_angle(z, self.initial_direction)
        return product(self.attitude, product(swing, product(turned, loop)))

    def _rate(self, s: FloatArray) -> FloatArray:
        """Rate of the trunk in B [rad/s], shape (3, len(s)), by central differences."""
        step = 1e-4
        change = (self._path(s + step) - self._path(s - step)) / (2.0 * step * self.duration)
        return 2.0 * product(conjugate(self._path(s)), change)[:, 1:].T
