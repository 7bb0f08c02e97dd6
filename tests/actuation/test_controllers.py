"""The estimated mass of motor controllers against commercial ones."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from ocs_design.actuation.controllers import (
    BASE_MASS,
    MASS_PER_CURRENT,
    controller_mass,
    controller_mass_of,
)
from ocs_design.catalogue.motors import motors


@dataclass(frozen=True)
class Controller:
    """Mass [kg] and peak current, amplitude of a phase [A], of a commercial controller."""

    name: str
    mass: float
    peak_current: float
    source: str


_MOTEUS = "README of github.com/mjbots/moteus"
_ODRIVE = "docs.odriverobotics.com/v/latest/hardware"

KNOWN = (
    Controller("ODrive Micro", 0.0081, 7.0, f"{_ODRIVE}/micro-datasheet.html, with its receptacle"),
    Controller("moteus-c1", 0.0089, 20.0, _MOTEUS),
    Controller(
        "Aerostar 30A RVS G2",
        0.033,
        40.0,
        "github.com/DVA490-474-Project-Course/SSL-Hardware-Development, wiki page ESC, with wires",
    ),
    Controller("moteus-r4.11", 0.0142, 100.0, _MOTEUS),
    Controller("moteus-n1", 0.0146, 100.0, _MOTEUS),
    Controller("moteus-x1", 0.0238, 120.0, _MOTEUS),
    Controller("ODrive Pro", 0.072, 120.0, f"{_ODRIVE}/pro-datasheet.html, with heat spreader"),
)


def test_the_estimate_is_a_least_squares_fit():
    current = np.array([each.peak_current for each in KNOWN])
    mass = np.array([each.mass for each in KNOWN])
    slope, base = np.polyfit(current, mass, 1)
    assert pytest.approx(base, rel=0.01) == BASE_MASS
    assert pytest.approx(slope, rel=0.01) == MASS_PER_CURRENT


def test_the_error_of_the_estimate_is_as_documented():
    ratios = [controller_mass(each.peak_current) / each.mass for each in KNOWN]
    assert min(ratios) == pytest.approx(0.5, abs=0.05)
    assert max(ratios) == pytest.approx(2.3, abs=0.1)


def test_a_motor_by_hand():
    """0.55 N m at 0.0212 N m/A are 26 A between two lines, an amplitude of 30 A: 15 g."""
    motor = replace(next(iter(motors().values())), peak_torque=0.55, torque_constant=0.0212)
    assert controller_mass_of(motor) == pytest.approx(0.0151, abs=1e-4)
    assert controller_mass_of(replace(motor, torque_constant=None)) == 0.0
