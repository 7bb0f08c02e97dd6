"""Least spin inertia for a change of rate or of momentum (Elroy's Beanie).

A wheel that speeds up by `gamma` relative to the trunk takes momentum from it. The bound is
necessary, not sufficient: it ignores torque, angle and time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.requirement import Requirement

AXES = ("roll", "pitch")
"""Axes about which the wheels can turn the trunk, in the order of all (2,) arrays."""


@dataclass(frozen=True)
class SpinDemand:
    """Demand of one part of the requirement on each wheel, as `design.json` records it.

    Attributes:
        source: name of the maneuver, or `rate change, roll` and `rate change, pitch`.
        incidence: at which it was computed [rad].
        roll_momentum, pitch_momentum: that both wheels take together [N m s].
        spin_inertia: smallest of each wheel [kg m^2]; inf if an axis is out of the wheels' reach.
        torque: of each motor, below which no wheel turns the robot in time [N m]; 0: no time limit.
    """

    source: str
    incidence: float
    roll_momentum: float
    pitch_momentum: float
    spin_inertia: float
    torque: float

    @classmethod
    def of(
        cls,
        source: str,
        incidence: float,
        momentum: FloatArray,
        spin_inertia: float,
        torque: float = 0.0,
    ) -> "SpinDemand":
        """Demand with the momentum about both axes, shape (2,)."""
        roll, pitch = momentum.tolist()
        return cls(source, incidence, roll, pitch, spin_inertia, torque)

    @property
    def momentum(self) -> FloatArray:
        """Roll and pitch momentum that both wheels take together [N m s], shape (2,)."""
        return np.array([self.roll_momentum, self.pitch_momentum])

    @property
    def unreachable_axes(self) -> tuple[str, ...]:
        """Names of the axes that need momentum but cannot get any at this incidence."""
        unreachable = (self.momentum != 0.0) & (authority(self.incidence) < OUT_OF_REACH)
        return tuple(
            axis for axis, is_unreachable in zip(AXES, unreachable, strict=True) if is_unreachable
        )


def elroy_beanie_bound(inertia: float, rate_change: float, wheel_speed_max: float) -> float:
    """The paper's bound as printed, `I_r d / (d + gamma)` [kg m^2] (paper, section 3.1).

    The printed sum results from a sign error: see `corrected_bound`.
    """
    return inertia * rate_change / (rate_change + wheel_speed_max)


def corrected_bound(inertia: float, rate_change: float, wheel_speed_max: float) -> float:
    """The bound that follows from the paper's own momentum, `I_r d / (gamma - d)` [kg m^2].

    With `L = (I_r + I_f) theta_dot + I_f gamma_dot` constant and the wheel at rest on the trunk at
    first, `(I_r + I_f) (theta_dot_0 - theta_dot_1) = I_f gamma_dot`: the trunk loses what the wheel
    gains, so that `(I_r + I_f) d = I_f gamma`. The printed bound is lower by about `2 d / gamma`.

    Args:
        inertia: of the robot without the device, about the axis [kg m^2].
        rate_change: of the trunk, d [rad/s].
        wheel_speed_max: of the wheel relative to the trunk, gamma [rad/s].

    Returns:
        inf where `d >= gamma`: not even a wheel of infinite inertia suffices.
    """
    if rate_change >= wheel_speed_max:
        return float("inf")
    return inertia * rate_change / (wheel_speed_max - rate_change)


def authority(incidence: float) -> FloatArray:
    """Share of one wheel's momentum that falls on roll and on pitch, (sin a, cos a), shape (2,)."""
    return np.array([np.sin(incidence), np.cos(incidence)])


def roll_momentum_per_rate(roll: ArrayLike, yaw_inertia: ArrayLike) -> FloatArray:
    """Momentum about roll per roll rate at the start of a flip, `I_xx (1 + I_xx / I_zz)`.

    The momentum `I_xx p` is fixed in space. After a quarter turn it lies along the trunk's z axis,
    about which wheels with axes across it cannot act, and the trunk turns at `p I_xx / I_zz`
    (docs/theory.md, A roll at lift-off).

    Args:
        roll, yaw_inertia: I_xx and I_zz of robot and device [kg m^2].

    Returns:
        [kg m^2], of the arguments' shape.
    """
    about_roll = np.asarray(roll)
    return np.asarray(about_roll * (1.0 + about_roll / np.asarray(yaw_inertia)))


def bound_curve(rate_changes: ArrayLike, wheel_speeds: ArrayLike) -> FloatArray:
    """Required inertia over the robot's, I_f / I_r, one row per wheel speed (paper, figure 3).

    Args:
        rate_changes: [rad/s], shape (n,).
        wheel_speeds: [rad/s], shape (m,).

    Returns:
        Shape (m, n); inf where the wheel is no faster than the required change.
    """
    change = np.asarray(rate_changes, dtype=np.float64)[np.newaxis, :]
    headroom = np.asarray(wheel_speeds, dtype=np.float64)[:, np.newaxis] - change
    ratio = np.full(headroom.shape, np.inf)
    np.divide(change, headroom, out=ratio, where=headroom > 0.0)
    return ratio


def per_wheel(total: FloatArray, incidence: float) -> float:
    """Demand on each wheel along its own axis, for roll and pitch of both together.

    `(|x| / sin a + |y| / cos a) / 2`, for momenta [N m s], torques [N m] and inertias [kg m^2]: the
    achievable set is a rhombus (docs/theory.md, What a maneuver asks for). An axis without demand
    costs nothing, whatever the incidence; inf if one with demand is out of reach.

    Args:
        total: on roll and on pitch, shape (2,).
        incidence: [rad].
    """
    magnitudes = np.abs(total)
    share = authority(incidence)
    if np.any((magnitudes > 0.0) & (share < OUT_OF_REACH)):
        return float("inf")
    return float(np.divide(magnitudes, share, out=np.zeros(2), where=magnitudes > 0.0).sum() / 2.0)


def spin_demands(
    requirement: Requirement, inertia_at: Callable[[float], FloatArray], incidence: float
) -> tuple[SpinDemand, ...]:
    """Demand on a wheel of each maneuver, and of the rate change about each axis.

    From the gyrostat's momentum `H = I_tot w + A I_w W`: the wheels must take `I_tot d`, which is
    `corrected_bound` with the device counted in the total (docs/theory.md, The robot with its
    wheels: a gyrostat).

    Args:
        requirement: maneuvers, rate change and wheel speed.
        inertia_at: that of the robot with its device at an incidence, wheels braked [kg m^2], shape
            (3, 3): modules that are turned for a maneuver turn their own inertia.
        incidence: of the design; a maneuver's own takes precedence [rad].
    """
    demands = []
    for maneuver in requirement.maneuvers:
        own = incidence if maneuver.incidence is None else maneuver.incidence
        total = TiltInertia.of(inertia_at(own))
        reached = total.within_reach(authority(own), maneuver.tilt_per_drift)
        momentum, slew = maneuver.momentum(reached), maneuver.slew(reached)
        _, pitch = slew.swept if slew.swept.any() else slew.momentum
        # Both wheels of a pair pitch the trunk the same way, but roll it in opposite ways.
        initial_speed = (
            float(np.sign(pitch)) * slew.initial_speed if pitch else abs(slew.initial_speed)
        )
        speed_left = requirement.wheel_speed_max - initial_speed
        spin_inertia = per_wheel(momentum, own) / speed_left if speed_left > 0.0 else float("inf")
        torque = per_wheel(maneuver.least_torque(reached), own)
        demands.append(SpinDemand.of(maneuver.name, own, momentum, spin_inertia, torque))
    if requirement.rate_change is not None:
        total = TiltInertia.of(inertia_at(incidence))
        for axis, momentum in zip(AXES, rate_momenta(total, requirement.rate_change), strict=True):
            source = f"rate change, {axis}"
            spin_inertia = per_wheel(momentum, incidence) / requirement.wheel_speed_max
            demands.append(SpinDemand.of(source, incidence, momentum, spin_inertia))
    return tuple(demands)


def rate_momenta(inertia: TiltInertia, rate_change: float) -> FloatArray:
    """Momenta about roll and pitch for a change of the roll rate, and of the pitch rate [N m s].

    Args:
        inertia: of the robot with its device, wheels braked.
        rate_change: about either axis, one at a time [rad/s].

    Returns:
        Magnitudes, shape (..., 2, 2): axis of the change, axis of the momentum.
    """
    momenta = [inertia.momentum(rate) for rate in np.diag([rate_change, rate_change])]
    return np.abs(np.stack(momenta, axis=-2))
