"""SI numbers as people at the bench read them: mm, g, rpm, degrees."""

import numpy as np


def millimetres(length: float, digits: int = 1) -> str:
    """Length [m] in mm."""
    return f"{length * 1e3:.{digits}f} mm"


def grams(mass: float) -> str:
    """Mass [kg] in g below 1 kg, else in kg."""
    return f"{mass * 1e3:.1f} g" if mass < 1.0 else f"{mass:.3f} kg"


def rpm(speed: float) -> str:
    """Angular speed [rad/s] in rpm with thousands apart."""
    return f"{speed * 30.0 / np.pi:,.0f} rpm"


def degrees(angle: float, digits: int = 1) -> str:
    """Angle [rad] in degrees."""
    # Adding zero turns a rounded -0.0 into 0.0.
    return f"{round(float(np.degrees(angle)), digits) + 0.0:.{digits}f} deg"


def inertia(value: float) -> str:
    """Moment of inertia [kg m^2] with four digits."""
    return f"{value:.3e} kg m2"


def megapascals(stress: float) -> str:
    """Stress [Pa] in MPa."""
    return f"{stress / 1e6:.1f} MPa"


def newton_metres(torque: float) -> str:
    """Torque [N m]."""
    return f"{torque:.3g} N m"
