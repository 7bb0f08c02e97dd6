"""Motor controllers: the current that each must carry, and its mass.

The mass is a straight line over the peak phase current, the least squares of seven boards that can
be bought (`tests/actuation/test_controllers.py` has them), from bare ones to one in a heat
spreader: the rule is 0.5 to 2.3 times their mass. Flights last a second or two, so that what heats
a board for good does not choose it.
"""

from math import sqrt

from ocs_design.actuation.motor import Motor

PHASE_PER_LINE = 2.0 / sqrt(3.0)
"""Amplitude of a phase's sine over the current of `Motor`: see the text of `actuation.motor`."""


BASE_MASS, MASS_PER_CURRENT = 0.0081, 0.000232
"""Mass at no current, and what each ampere adds, of the rule [kg, kg/A]."""


def controller_mass(phase_current: float) -> float:
    """Mass of a controller by its peak phase current [kg]."""
    return BASE_MASS + MASS_PER_CURRENT * phase_current


def controller_mass_of(motor: Motor) -> float:
    """Mass of the controller that gives a motor its peak torque [kg]; 0: its current is unknown."""
    if motor.peak_torque is None or not motor.torque_constant:
        return 0.0
    return controller_mass(PHASE_PER_LINE * motor.peak_torque / motor.torque_constant)
