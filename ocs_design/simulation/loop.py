"""Delay margin of the wheels' control loop, discretised as it runs.

The torque is held from one control instant to the next, so the linear plant is exact between them:
`x' = A_d x + B_d tau`, `tau = -K x`. With the same delay in all motors, the loop of n wheels is
stable if n single loops are, whose gains are the eigenvalues of `K (z - A_d)^-1 B_d`
(Postlethwaite and MacFarlane, A Complex Variable Approach to the Analysis of Linear Multivariable
Feedback Systems, 1979).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from ocs_design.common.arrays import FloatArray, stacked_columns
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.target import Target
from ocs_design.simulation.wheel_law import WheelLaw
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Trajectory
from ocs_design.sizing.trajectory.tracking import linearised

_GRID = 4000
"""Number of frequencies between which crossings are searched."""

_INSTANTS = 21
"""Number of instants of a plan at which margins are computed."""

_GROWTH_ALLOWANCE = 0.1
"""Allowance for rounding in a motion's growth rate, closed loop over open loop [1/s]."""

_DIFFERENCE_STEP = 1e-4
"""Step of the central differences that linearise the law [rad, rad/s]: their error is of the order
of its square, plus rounding of one in 1e12."""


@dataclass(frozen=True)
class LoopMargins:
    """Margins of a loop that is closed once per period.

    Attributes:
        crossover: frequency with loop gain one at which the margin is smallest [rad/s].
        phase: margin there [rad].
        delay: margin, beyond the loop's own hold [s].
    """

    crossover: float
    phase: float
    delay: float


def loop_margins(
    state: FloatArray, control: FloatArray, feedback: FloatArray, period: float
) -> LoopMargins:
    """The smallest margins of a state feedback whose command is held.

    Args:
        state: A of the continuous plant, shape (m, m). control: B, shape (m, n).
        feedback: K, shape (n, m). period: [s].

    Returns:
        Margins at the crossover with the smallest delay margin; an infinite delay if the gain is
        below one at every frequency. All are zero if the loop is unstable without any delay, as one
        held for too long is.
    """
    size, inputs = control.shape
    discrete = expm(period * np.block([[state, control], [np.zeros((inputs, size + inputs))]]))
    step, gain = discrete[:size, :size], discrete[:size, size:]
    open_loop, closed_loop = (
        np.abs(np.linalg.eigvals(a)).max() for a in (step, step - gain @ feedback)
    )
    # Motions that the wheels do not reach may grow as without them: a trunk that spins about its
    # intermediate axis.
    if closed_loop > max(open_loop, 1.0) * np.exp(_GROWTH_ALLOWANCE * period):
        return LoopMargins(0.0, 0.0, 0.0)

    def eigenvalues(frequency: FloatArray) -> NDArray[np.complex128]:
        z = np.exp(1j * period * frequency)[:, None, None]
        loop = feedback @ np.linalg.solve(z * np.eye(size) - step, gain + 0j * z)
        values = np.linalg.eigvals(loop).astype(np.complex128)
        return np.take_along_axis(values, np.argsort(np.abs(values), axis=1), axis=1)

    frequency = np.geomspace(1e-4, 1.0, _GRID) * np.pi / period
    level = np.log(np.maximum(np.abs(eigenvalues(frequency)), 1e-300))
    before, which = np.nonzero(level[:-1] * level[1:] <= 0.0)
    if not before.size:
        return LoopMargins(0.0, np.pi, np.inf)
    first, last = level[before, which], level[before + 1, which]
    part = first / np.where(first == last, 1.0, first - last)
    crossing = frequency[before] * (frequency[before + 1] / frequency[before]) ** part
    at_crossing = np.take_along_axis(eigenvalues(crossing), which[:, None], axis=1)[:, 0]
    phase = np.angle(-at_crossing)
    delays = np.mod(phase, 2.0 * np.pi) / crossing
    smallest = int(np.argmin(delays))
    return LoopMargins(
        float(crossing[smallest]), float(np.abs(phase[smallest])), float(delays[smallest])
    )


def level_margins(law: WheelLaw, body: Gyrostat, period: float) -> LoopMargins:
    """Margins of a law in one world about level flight at rest, within the motors' limits."""
    n = body.axes.shape[1]
    linear = replace(law, limits=stacked_columns([MotorLimits(np.inf, 0.0, np.inf)]))
    none = np.zeros((1, 3))
    level = Target(np.array([[0.0, 0.0, 1.0]]), none, none, np.zeros((1, n)), np.zeros(1, bool))

    def torque(state: FloatArray) -> FloatArray:
        roll, pitch = state[:2]
        vertical = np.array([[-pitch, roll, 1.0]])
        commanded = linear.torque(vertical, state[None, 3:6], state[None, 6:], level, period)
        return np.asarray(commanded[0])

    steps = _DIFFERENCE_STEP * np.eye(6 + n)
    feedback = -np.stack(
        [(torque(e) - torque(-e)) / (2.0 * _DIFFERENCE_STEP) for e in steps], axis=1
    )
    system = linearised(body, none, np.zeros((1, n)))[0]
    return loop_margins(system[:, : 6 + n], system[:, 6 + n :], feedback, period)


def plan_margins(trajectory: Trajectory, body: Gyrostat, period: float) -> LoopMargins:
    """Smallest margins along a trajectory with gains, frozen at each instant; `period` [s]."""
    assert trajectory.gains is not None, "only gains have margins"
    size = trajectory.gains.shape[2]
    systems = linearised(body, trajectory.rate, trajectory.wheel_speed, trajectory.vertical)
    instants = np.linspace(0, len(systems) - 1, _INSTANTS).astype(int)
    margins = [
        loop_margins(systems[k, :, :size], systems[k, :, size:], trajectory.gains[k], period)
        for k in instants
    ]
    return min(margins, key=lambda margin: margin.delay)
