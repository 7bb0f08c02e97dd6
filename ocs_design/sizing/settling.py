"""Tilt that the wheel law leaves of a push, where the wheels have all that it commands.

See docs/theory.md, From possible to sure.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.boundary import Push
from ocs_design.requirement.froude import Gains

_Complex: TypeAlias = NDArray[np.complex128]

_EQUAL = 1e-5
"""Half the difference of two eigenvalues, times the time, that counts as none."""


def tilt_left_of(
    push: Push,
    gains: Gains,
    time_left: FloatArray,
    *,
    acceleration: FloatArray,
    rate: FloatArray,
    yaw_rate: FloatArray,
) -> FloatArray:
    """Roll and pitch of n robots at touchdown [rad], shape (n, 2).

    With roll and pitch x as the real and imaginary part of one number, the law's feedback is
    `w' = a - K_p x - K_d w`, and a trunk that yaws at W sees its tilt turn: `x' = w - i W x`.

    Args:
        push: its onset and duration. time_left: from its end until touchdown [s], shape (n,).
        acceleration: about roll and pitch, by the push alone [rad/s^2], shape (n, 2).
        rate: of roll and pitch at lift-off [rad/s], shape (n, 2).
        yaw_rate: after the push [rad/s], shape (n,); it grows from zero during the push.
    """
    state = np.stack([np.zeros(len(rate)), rate[:, 0] + 1j * rate[:, 1]], axis=1)
    pushed = np.stack([np.zeros(len(rate)), acceleration[:, 0] + 1j * acceleration[:, 1]], axis=1)
    still = np.zeros_like(pushed)
    for yaw, forced, time in (
        (0.0, still, push.onset),
        (0.5 * yaw_rate, pushed, push.duration),
        (yaw_rate, still, time_left),
    ):
        matrix = np.empty((len(rate), 2, 2), np.complex128)
        matrix[:, 0, 0], matrix[:, 0, 1] = -1j * np.asarray(yaw), 1.0
        matrix[:, 1] = -gains.stiffness, -gains.damping
        # x' = M x + b tends to -M^-1 b.
        rest = -np.linalg.solve(matrix, forced[..., None])[..., 0]
        change = _exponential(matrix, np.broadcast_to(time, len(rate)))
        state = rest + np.einsum("nij,nj->ni", change, state - rest)
    return np.stack([state[:, 0].real, state[:, 0].imag], axis=1)


def _exponential(matrix: _Complex, time: FloatArray) -> _Complex:
    """`exp(M t)`, shape (n, 2, 2); of equal eigenvalues too, as critical damping has them.

    With their mean m and half their difference d it is `e^(m t) (cosh(d t) + (M - m) sinh(d t) /
    d)`.
    """
    mean = np.trace(matrix, axis1=1, axis2=2) / 2.0
    half = np.sqrt(mean**2 - np.linalg.det(matrix))
    first, second = np.exp((mean + half) * time), np.exp((mean - half) * time)
    equal = np.abs(half * time) < _EQUAL
    slope = (first - second) / np.where(equal, 1.0, 2.0 * half)
    slope = np.where(equal, time * np.exp(mean * time), slope)
    across = matrix - mean[:, None, None] * np.eye(2)
    even = 0.5 * (first + second)
    return np.asarray(even[:, None, None] * np.eye(2) + slope[:, None, None] * across)
