"""The rule for controllers' masses against what can be bought."""

from dataclasses import replace

import numpy as np
import pytest

from ocs_design.actuation.controllers import (
    BASE_MASS,
    KNOWN,
    MASS_PER_CURRENT,
    controller_mass,
    controller_mass_of,
)
from ocs_design.catalogue.motors import motors


def test_the_rule_is_the_least_squares_of_the_known_ones():
    current = np.array([each.peak_current for each in KNOWN])
    mass = np.array([each.mass for each in KNOWN])
    slope, base = np.polyfit(current, mass, 1)
    assert pytest.approx(base, rel=0.01) == BASE_MASS
    assert pytest.approx(slope, rel=0.01) == MASS_PER_CURRENT


def test_the_rule_is_as_far_off_as_it_says():
    ratios = [controller_mass(each.peak_current) / each.mass for each in KNOWN]
    assert min(ratios) == pytest.approx(0.5, abs=0.05)
    assert max(ratios) == pytest.approx(2.3, abs=0.1)


def test_a_motor_by_hand():
    """0.55 N m of 0.0212 N m/A are 26 A through two lines, 30 A of a phase's sine: 15 g."""
    motor = replace(next(iter(motors().values())), peak_torque=0.55, torque_constant=0.0212)
    assert controller_mass_of(motor) == pytest.approx(0.0151, abs=1e-4)
    assert controller_mass_of(replace(motor, torque_constant=None)) == 0.0
