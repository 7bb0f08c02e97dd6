"""Gains that keep a gyrostat on its planned trajectory: a time-varying linear-quadratic regulator.

The heading of a trunk on two wheels follows from the path of its tilt, so that no constant feedback
corrects it (Krishnan, McClamroch and Reyhanoglu, JGCD 18(2), 1995). Along a path it is controllable
in the linear sense, and the regulator finds which tilt undoes which error of the heading.
"""

import numpy as np
from scipy.linalg import expm

from ocs_design.actuation.drive import PLANNED, DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.sizing.trajectory.flight import Trajectory
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

ON_THE_WAY = np.radians(2.0)
"""Error of attitude that is worth all torque beyond a plan's share, on the way [rad]."""

AT_THE_END = np.radians(0.3)
"""Error of attitude that is worth that torque for the whole time, at the end [rad]."""


def tracking_gains(gyrostat: Gyrostat, line: DriveLine, trajectory: Trajectory) -> FloatArray:
    """Gains from attitude, rate and wheel speed errors to motor torque, shape (m, n, 6 + n).

    The motors get the planned torque minus gain times error: attitude as the rotation vector from
    the plan in B [rad], rate in B [rad/s], wheel speeds [rad/s]. Discrete Riccati equation from the
    last sample backwards (Anderson and Moore, Optimal Control, 1990, section 2.4). Weights by
    Bryson's rule: `ON_THE_WAY` and `AT_THE_END` against
    the torque that a plan leaves to the feedback. Rates count at the end by the angle that they
    would turn in the time constant of the two.

    Args:
        gyrostat: robot and device. line: of the drives, nothing held back.
        trajectory: m samples, with attitude not needed.
    """
    wheels, count = gyrostat.axes.shape[1], len(trajectory.time)
    size, inverse = 6 + wheels, np.linalg.inv(gyrostat.mass_matrix)
    system = np.zeros((count, size + wheels, size + wheels))
    system[:, :size] = linearised(gyrostat, trajectory.rate, trajectory.wheel_speed)
    steps = np.diff(trajectory.time)
    middle = 0.5 * (system[1:] + system[:-1])
    discrete = expm(middle * steps[:, None, None])

    spare = line.torque_limit if np.isfinite(line.torque_limit) else line.stall_torque
    if not np.isfinite(spare):
        spare = float(np.abs(trajectory.wheel_torque).max())
    spare *= 1.0 - PLANNED
    effort = np.eye(wheels) / spare**2
    # Quickness of a double integrator under these weights, `omega^4 = q / r g^2`.
    authority = np.abs(inverse[:3, 3:]).max()
    quickness = np.sqrt(spare * authority / ON_THE_WAY)
    running = np.diag([ON_THE_WAY**-2.0] * 3 + [0.0] * (3 + wheels))
    last = AT_THE_END**-2.0 * trajectory.time[-1]
    value = np.diag([last] * 3 + [last / quickness**2] * 3 + [0.0] * wheels)
    gains = np.zeros((count, wheels, size))
    for k in range(count - 2, -1, -1):
        free, driven = discrete[k, :size, :size], discrete[k, :size, size:]
        weighed = driven.T @ value
        gains[k] = np.linalg.solve(effort * steps[k] + weighed @ driven, weighed @ free)
        closed = free - driven @ gains[k]
        value = running * steps[k] + free.T @ value @ closed
        value = 0.5 * (value + value.T)
    gains[-1] = gains[-2]
    return gains


def linearised(gyrostat: Gyrostat, rate: FloatArray, wheel_speed: FloatArray) -> FloatArray:
    """Matrices A and B of small errors, side by side, shape (m, 6 + n, 6 + 2 n).

    With M and H of the `Gyrostat`, and the attitude error e as the rotation vector in B:

        e_dot = dw - w x e
        M (dw_dot, dW_dot) = (-dw x H - w x (I dw + h A dW), d tau)

    Args:
        gyrostat: with n wheels.
        rate: in B [rad/s], shape (m, 3). wheel_speed: [rad/s], shape (m, n).
    """
    mass, wheels = gyrostat.mass_matrix, wheel_speed.shape[1]
    inverse, turning = np.linalg.inv(mass), _cross_matrix(rate)
    momentum = rate @ mass[:3, :3].T + wheel_speed @ mass[:3, 3:].T
    gyroscopic = turning @ mass[:3]
    gyroscopic[:, :, :3] -= _cross_matrix(momentum)
    system = np.zeros((len(rate), 6 + wheels, 6 + 2 * wheels))
    system[:, :3, :3] = -turning
    system[:, :3, 3:6] = np.eye(3)
    system[:, 3:, 3 : 6 + wheels] = -inverse[:, :3] @ gyroscopic
    system[:, 3:, 6 + wheels :] = inverse[:, 3:]
    return system


def _cross_matrix(vectors: FloatArray) -> FloatArray:
    """Matrices of `v x`, shape (m, 3, 3)."""
    x, y, z = vectors.T
    none = np.zeros_like(x)
    return np.stack([[none, -z, y], [z, none, -x], [-y, x, none]]).transpose(2, 0, 1)
