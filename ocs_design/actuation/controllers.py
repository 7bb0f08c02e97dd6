"""Motor controllers: the current that each must carry, and its mass.

The mass is a straight line over the peak phase current, the least squares of the boards in `KNOWN`.
Flights last a second or two, so that what heats a board for good does not choose it.
"""

from dataclasses import dataclass
from math import sqrt

from ocs_design.actuation.motor import Motor

PHASE_PER_LINE = 2.0 / sqrt(3.0)
"""Amplitude of a phase's sine over the current of `Motor`: see the text of `actuation.motor`."""


@dataclass(frozen=True)
class Controller:
    """A motor controller that can be bought.

    Attributes:
        name: of it. mass: [kg]. peak_current: amplitude of a phase [A]. source: of both.
    """

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
"""From bare boards to one in a heat spreader: the rule is 0.5 to 2.3 times their mass."""

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
