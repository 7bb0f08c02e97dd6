"""The gear ratio at which a motor turns a trunk soonest, and the least motor power for a turn.

For a motor without current limit, behind a gear of ratio N without loss, the quickest slew by phi
takes t with

    ln cosh x = phi / (2 w_0 T),    x = t / (2 T),    T = I_red w_0 / tau_s,

w_0 = w_m / N, tau_s = N tau_m. The power w_m tau_m / 4 = w_0 tau_s / 4 is the motor's peak power
whatever N, and comes to `I_red phi^2 / t^3 x^3 / (2 (ln cosh x)^2)`: least at
`x tanh x = 1.5 ln cosh x`, x = 1.8122. Equally, at that x the ratio turns the trunk soonest. The
other ways to brake have their own t / T (docs/theory.md, What a motor can do; the scaling is that
of Libby, Johnson, Chang-Siu, Full and Koditschek, IEEE T-RO 32(6), 2016). With I_b the body's
inertia and xi = I_red / I_b, phi = theta / xi, `I_red phi^2` is `I_b theta^2 / xi`.
"""

from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.arrays import FloatArray


class Braking(Enum):
    """How a wheel is braked, by the quickest slew's t / T and its P t^3 / (I_red phi^2)."""

    REVERSE_VOLTAGE = (3.6244844019, 2.2682861529)
    """Full reverse voltage, up to twice the stall torque: x = t / (2 T) = 1.8122."""
    STALL_TORQUE = (3.9560574755, 2.4631484195)
    """Reverse torque, at most that at stall."""
    INSTANT = (2.1491257999, 1.5490157794)
    """By a brake that takes no time."""

    @property
    def time_constants(self) -> float:
        """t / T at the optimum."""
        return self.value[0]

    @property
    def power_factor(self) -> float:
        """P t^3 / (I_red phi^2) at the optimum."""
        return self.value[1]


def optimal_ratio(
    reduced_inertia: ArrayLike,
    duration: ArrayLike,
    *,
    motor_stall_torque: ArrayLike,
    motor_no_load_speed: ArrayLike,
    braking: Braking = Braking.REVERSE_VOLTAGE,
) -> FloatArray:
    """N*, `sqrt((t / T)* I_red w_m / (t tau_m))`, that of a motor no stronger than it must be.

    Args:
        reduced_inertia: I_red without the motor's own share [kg m^2].
        duration: t [s].
        motor_stall_torque: tau_m [N m]. motor_no_load_speed: w_m [rad/s].
        braking: of the wheel.
    """
    impulse = np.asarray(duration) * np.asarray(motor_stall_torque)
    momentum = np.asarray(reduced_inertia) * np.asarray(motor_no_load_speed)
    return np.asarray(np.sqrt(braking.time_constants * momentum / impulse))


def least_peak_power(
    phi: ArrayLike,
    reduced_inertia: ArrayLike,
    duration: ArrayLike,
    braking: Braking = Braking.REVERSE_VOLTAGE,
) -> FloatArray:
    """Peak power that a motor needs behind its best gear [W].

    Args:
        phi: angle of the wheel [rad]. reduced_inertia: I_red [kg m^2]. duration: t [s].
        braking: of the wheel.
    """
    work = np.asarray(reduced_inertia) * np.asarray(phi) ** 2
    return np.asarray(braking.power_factor * work / np.asarray(duration) ** 3)
