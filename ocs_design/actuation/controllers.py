"""Motor controllers: the current that each must carry, and its mass.

The mass is a straight line over the peak phase current, a least-squares fit to seven commercial
boards (listed in `tests/actuation/test_controllers.py`), from bare ones to one with a heat
spreader; the fit gives 0.5 to 2.3 times their mass. Flights last a second or two, so the continuous
rating does not determine the board.
"""

from math import sqrt

from ocs_design.actuation.motor import Motor

PHASE_PER_LINE = 2.0 / sqrt(3.0)
"""Ratio of a phase's sine amplitude to the current of `Motor`: see the docstring of
`actuation.motor`."""


BASE_MASS, MASS_PER_CURRENT = 0.0081, 0.000232
"""Mass at zero current and mass per ampere of the fit [kg, kg/A]."""


def controller_mass(phase_current: float) -> float:
    """Mass of a controller for a peak phase current [A], in kg."""
    return BASE_MASS + MASS_PER_CURRENT * phase_current


def controller_mass_of(motor: Motor) -> float:
    """Mass of the controller that gives a motor its peak torque [kg]; 0: its current is unknown."""
    if motor.peak_torque is None or not motor.torque_constant:
        return 0.0
    return controller_mass(PHASE_PER_LINE * motor.peak_torque / motor.torque_constant)
