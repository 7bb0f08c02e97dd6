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
    return f"{_rounded(float(np.degrees(angle)), digits):.{digits}f} deg"


def tenths(length: float) -> str:
    """Length [m] in tenths of a mm, without its unit."""
    return f"{_rounded(1e3 * length, 1):.1f}"


def signed(ratio: float) -> str:
    """A ratio with its sign and three digits."""
    return f"{_rounded(ratio, 3):+.3f}"


def _rounded(value: float, digits: int) -> float:
    """Adding zero turns a rounded -0.0 into 0.0."""
    return round(value, digits) + 0.0


def inertia(value: float) -> str:
    """Moment of inertia [kg m^2] with four digits."""
    return f"{value:.3e} kg m2"


def megapascals(stress: float) -> str:
    """Stress [Pa] in MPa."""
    return f"{stress / 1e6:.1f} MPa"
