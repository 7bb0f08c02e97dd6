"""What the air in its housing takes from a wheel (docs/monte_carlo.md, The wheel's air).

The faces drag as an enclosed disc (Daily and Nece, J. Basic Engineering 82, 1960, 217-230), the rim
as a cylinder in a wider one: Couette flow, exact, then with vortices and turbulent (Bilgen and
Boulos, J. Fluids Engineering 95, 1973, 122-126). Every regime is a power of the Reynolds number,
and the one that drags most is the one that holds.
"""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Flywheel
from ocs_design.simulation.imperfections import AirDrag
from ocs_design.sizing.housing import CLEARANCE

AIR_DENSITY = 1.225
"""Of the standard atmosphere at sea level, 15 degrees [kg/m^3] (ISO 2533)."""

AIR_VISCOSITY = 1.4607e-5
"""Kinematic, of the same [m^2/s]."""

_SPEEDS = np.concatenate([[0.0], np.geomspace(0.1, 2e4, 600)])
"""Close enough for straight lines to be within 1e-3 of the formulas [rad/s]."""


def air_drag(wheel: Flywheel, gap: float = CLEARANCE) -> AirDrag:
    """Of a wheel in its housing, `gap` [m] away from it all round."""
    turning = _SPEEDS[1:]
    torque = disc_drag(turning, wheel.outer_radius, gap) + cylinder_drag(
        turning, wheel.outer_radius, wheel.height, gap
    )
    return AirDrag(_SPEEDS, np.concatenate([[0.0], torque]))


def disc_drag(speed: FloatArray, radius: float, gap: float) -> FloatArray:
    """On both faces of a disc between two walls [N m], `C rho W^2 R^5 / 2`.

    Laminar and turbulent, each with merged and with separate boundary layers.

    Args:
        speed: positive [rad/s].
        radius: of the disc [m]. gap: from a face to its wall [m].
    """
    reynolds, ratio = speed * radius**2 / AIR_VISCOSITY, gap / radius
    coefficient = np.max(
        [
            2.0 * np.pi / (ratio * reynolds),
            3.70 * ratio**0.1 / reynolds**0.5,
            0.080 / (ratio ** (1.0 / 6.0) * reynolds**0.25),
            0.102 * ratio**0.1 / reynolds**0.2,
        ],
        axis=0,
    )
    return np.asarray(0.5 * coefficient * AIR_DENSITY * speed**2 * radius**5)


def cylinder_drag(speed: FloatArray, radius: float, height: float, gap: float) -> FloatArray:
    """On the outside of a cylinder in a wider one [N m], `C pi rho W^2 R^4 h / 2`.

    Args:
        speed: positive [rad/s].
        radius: of the cylinder [m]. height: [m]. gap: between the two [m].
    """
    reynolds = speed * radius * gap / AIR_VISCOSITY
    narrow, wider = (gap / radius) ** 0.3, (1.0 + gap / radius) ** 2
    coefficient = np.max(
        [
            8.0 * wider / (wider - 1.0) * (gap / radius) / reynolds,
            2.0 * narrow / reynolds**0.6,
            1.03 * narrow / reynolds**0.5,
            0.065 * narrow / reynolds**0.2,
        ],
        axis=0,
    )
    return np.asarray(0.5 * np.pi * coefficient * AIR_DENSITY * speed**2 * radius**4 * height)
