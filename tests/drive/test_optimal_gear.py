"""The best gear and the least power, against published factors and a search over ratios."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from ocs_design.drive.line import DriveLine
from ocs_design.drive.optimal_gear import Braking, least_peak_power, optimal_ratio
from ocs_design.drive.slew_profile import slew_profile

INERTIA, PHI, STALL, NO_LOAD = 7e-5, 120.0, 0.08, 4000.0
LIMITS = {Braking.REVERSE_VOLTAGE: np.inf, Braking.STALL_TORQUE: 1.0, Braking.INSTANT: np.inf}


def duration(ratio: float, braking: Braking, phi: float = PHI) -> float:
    """Of the quickest slew behind a gear; for an instant brake, of its acceleration alone."""
    stall = STALL * ratio
    line = DriveLine(stall, NO_LOAD / ratio, stall * LIMITS[braking], np.inf)
    if braking is not Braking.INSTANT:
        return float(slew_profile(phi, INERTIA, line).end)

    def lack(whole: float) -> float:
        profile = slew_profile(whole, INERTIA, line)
        return float(profile.angle(profile.brake_from)) - phi

    return float(slew_profile(brentq(lack, phi, 3 * phi, xtol=1e-11), INERTIA, line).brake_from)


@pytest.mark.parametrize("braking", Braking)
def test_no_ratio_is_quicker(braking):
    quickest = minimize_scalar(
        lambda log: duration(np.exp(log), braking),
        bounds=(np.log(0.1), np.log(50.0)),
        method="bounded",
        options={"xatol": 1e-9},
    )
    best = optimal_ratio(
        INERTIA,
        quickest.fun,
        motor_stall_torque=STALL,
        motor_no_load_speed=NO_LOAD,
        braking=braking,
    )
    # The time is flat about its least: half of the digits tell the ratio.
    assert np.exp(quickest.x) == pytest.approx(float(best), rel=1e-6)
    assert duration(float(best), braking) == pytest.approx(quickest.fun, rel=1e-12)
    power = least_peak_power(PHI, INERTIA, quickest.fun, braking)
    assert power == pytest.approx(STALL * NO_LOAD / 4.0, rel=1e-9)


def test_published_factors():
    """x* = 1.8122 and 2.268, 2.463, 1.549 (docs/theory.md)."""
    x = brentq(lambda x: x * np.tanh(x) - 1.5 * np.log(np.cosh(x)), 1.0, 3.0, xtol=1e-14)
    assert x == pytest.approx(1.8122, abs=5e-5)
    assert Braking.REVERSE_VOLTAGE.time_constants == pytest.approx(2.0 * x, rel=1e-10)
    factor = x**3 / (2.0 * np.log(np.cosh(x)) ** 2)
    assert Braking.REVERSE_VOLTAGE.power_factor == pytest.approx(factor, rel=1e-10)
    factors = [braking.power_factor for braking in Braking]
    assert factors == pytest.approx([2.268, 2.463, 1.549], abs=5e-4)
