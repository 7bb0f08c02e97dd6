"""Gains that keep a gyrostat on its planned trajectory: a time-varying linear-quadratic regulator.

The heading of a trunk with two wheels follows from the path of its tilt, so no constant feedback
can correct it (Krishnan, McClamroch and Reyhanoglu, JGCD 18(2), 1995). Along a path it is linearly
controllable, and the regulator finds the tilt that corrects an error of heading.
"""

import numpy as np
from scipy.linalg import expm, solve_discrete_are

from ocs_design.actuation.drive import PLANNED, DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Trajectory

ERROR_DURING_TURN = np.radians(2.0)
"""Attitude error during the turn at which the regulator uses all torque that the plan leaves
[rad]."""

TILT_AT_END = np.radians(0.3)
"""Tilt at the end that weighs as much as using this torque for the whole time [rad]."""

HEADING_AT_END = np.radians(2.0)
"""The same for a heading, which is corrected by a tilt that must be undone in time [rad]."""

BALANCING_SPEED = 0.2
"""Wheel speed, relative to the no-load speed, that weighs as much when balancing upright."""


def tracking_gains(
    gyrostat: Gyrostat, line: DriveLine, trajectory: Trajectory, share: float = PLANNED
) -> FloatArray:
    """Gains from attitude, rate and wheel speed errors to motor torque, shape (m, n, 6 + n).

    The motors get the planned torque minus gain times error: attitude as the rotation vector from
    the plan in B [rad], rate in B [rad/s], wheel speeds [rad/s]. Discrete Riccati equation from the
    last sample backwards (Anderson and Moore, Optimal Control, 1990, section 2.4). Weights by
    Bryson's rule: `ERROR_DURING_TURN`, `TILT_AT_END` and `HEADING_AT_END` against the torque that a
    plan leaves to the feedback. Rates at the end are weighted by the angle that they would turn in
    the time constant of the first two. About a pivot, the robot has to be held indefinitely after
    the plan: there the final value is that of the steady-state regulator, all torque is available,
    and wheels at `BALANCING_SPEED` weigh as much as `ERROR_DURING_TURN`, so that they come to rest.

    Args:
        gyrostat: robot and device. line: of the drives, without reserve.
        trajectory: m samples; attitudes are not needed.
        share: fraction of the drives that the plan keeps to; `PLANNED` where it uses more.
    """
    wheels, count = gyrostat.axes.shape[1], len(trajectory.time)
    size, inverse = 6 + wheels, gyrostat.inverse_mass_matrix
    system = np.zeros((count, size + wheels, size + wheels))
    system[:, :size] = linearised(
        gyrostat, trajectory.rate, trajectory.wheel_speed, trajectory.vertical
    )
    steps = np.diff(trajectory.time)
    middle = 0.5 * (system[1:] + system[:-1])
    discrete = expm(middle * steps[:, None, None])

    spare_torque = line.torque_limit if np.isfinite(line.torque_limit) else line.stall_torque
    if not np.isfinite(spare_torque):
        spare_torque = float(np.abs(trajectory.wheel_torque).max())
    if not gyrostat.stands:
        spare_torque *= 1.0 - min(share, PLANNED)
    effort = np.eye(wheels) / spare_torque**2
    gains = np.zeros((count, wheels, size))
    if gyrostat.stands:
        # The heading is not controlled.
        about = gyrostat.controlled_axes
        about = about[np.abs(about[:, 2]) < 1.0]
        weight_during = np.zeros((size, size))
        weight_during[:3, :3] = about.T @ about * ERROR_DURING_TURN**-2.0
        weight_during[6:, 6:] = np.eye(wheels) * (BALANCING_SPEED * line.no_load_speed) ** -2.0
        basis = np.zeros((size, 2 * len(about) + wheels))
        basis[:6, : 2 * len(about)] = np.kron(np.eye(2), about.T)
        basis[6:, 2 * len(about) :] = np.eye(wheels)
        last_step = (
            basis.T @ discrete[-1, :size, :size] @ basis,
            basis.T @ discrete[-1, :size, size:],
        )
        weights = basis.T @ weight_during @ basis * steps[-1], effort * steps[-1]
        value = basis @ solve_discrete_are(*last_step, *weights) @ basis.T
    else:
        # Bandwidth of a double integrator under these weights, `omega^4 = q / r g^2`.
        authority = np.abs(inverse[:3, 3:]).max()
        bandwidth = np.sqrt(spare_torque * authority / ERROR_DURING_TURN)
        weight_during = np.diag([ERROR_DURING_TURN**-2.0] * 3 + [0.0] * (3 + wheels))
        at_end = TILT_AT_END**-2.0 * trajectory.time[-1]
        heading = HEADING_AT_END**-2.0 * trajectory.time[-1]
        rates = [at_end / bandwidth**2] * 3
        value = np.diag([at_end, at_end, heading, *rates] + [0.0] * wheels)
    for k in range(count - 2, -1, -1):
        transition, driven = discrete[k, :size, :size], discrete[k, :size, size:]
        weighted = driven.T @ value
        gains[k] = np.linalg.solve(effort * steps[k] + weighted @ driven, weighted @ transition)
        closed = transition - driven @ gains[k]
        value = weight_during * steps[k] + transition.T @ value @ closed
        value = 0.5 * (value + value.T)
    gains[-1] = gains[-2]
    return gains


def linearised(
    gyrostat: Gyrostat,
    rate: FloatArray,
    wheel_speed: FloatArray,
    vertical: FloatArray | None = None,
) -> FloatArray:
    """Matrices A and B of small errors, side by side, shape (m, 6 + n, 6 + 2 n).

    With M and H of the `Gyrostat`, and the attitude error e as the rotation vector in B:

        e_dot = dw - w x e
        M (dw_dot, dW_dot) = (-dw x H - w x (I dw + h A dW), d tau)

    Args:
        gyrostat: with n wheels.
        rate: in B [rad/s], shape (m, 3). wheel_speed: [rad/s], shape (m, n).
        vertical: the world's upward direction u in B, shape (m, 3), where gravity acts about a
            pivot: its torque u x m g l changes by `-m g l x (u x e)`.
    """
    mass, wheels = gyrostat.mass_matrix, wheel_speed.shape[1]
    inverse, rate_cross = gyrostat.inverse_mass_matrix, _cross_matrix(rate)
    momentum = rate @ mass[:3, :3].T + wheel_speed @ mass[:3, 3:].T
    gyroscopic = rate_cross @ mass[:3]
    gyroscopic[:, :, :3] -= _cross_matrix(momentum)
    system = np.zeros((len(rate), 6 + wheels, 6 + 2 * wheels))
    system[:, :3, :3] = -rate_cross
    system[:, :3, 3:6] = np.eye(3)
    system[:, 3:, 3 : 6 + wheels] = -inverse[:, :3] @ gyroscopic
    system[:, 3:, 6 + wheels :] = inverse[:, 3:]
    if vertical is not None and gyrostat.stands:
        tilting = _cross_matrix(gyrostat.gravity_moment[None]) @ _cross_matrix(vertical)
        system[:, 3:, :3] = -inverse[:, :3] @ tilting
    return system


def _cross_matrix(vectors: FloatArray) -> FloatArray:
    """Matrices of `v x`, shape (m, 3, 3)."""
    x, y, z = vectors.T
    none = np.zeros_like(x)
    return np.stack([[none, -z, y], [z, none, -x], [-y, x, none]]).transpose(2, 0, 1)
