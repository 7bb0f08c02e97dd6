"""Numbers in workshop units (mm, g, degrees), counts and lists, for display."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import rpm, significant, to_unit

Amount = TypeVar("Amount", float, FloatArray)


_WHEEL_INERTIA_MAX = 0.01
"""Moment of inertia [kg m^2] below which it is shown in kg mm^2."""


def in_unit(values: Amount, unit: str) -> Amount:
    """One SI value, or an array of them, in `unit`."""
    return values * to_unit(1.0, unit)


def millimetres(length: float, digits: int = 1) -> str:
    """Length [m] in mm."""
    return f"{length * 1e3:.{digits}f} mm"


def tenths(length: float) -> str:
    """Length [m] in tenths of a mm, without its unit."""
    return f"{_rounded(1e3 * length, 1):.1f}"


def grams(mass: float) -> str:
    """Mass [kg] in g below 1 kg, else in kg."""
    return f"{mass * 1e3:.1f} g" if mass < 1.0 else f"{mass:.3f} kg"


def degrees_number(angle: float, digits: int = 1) -> str:
    """Angle [rad] in degrees, without its unit."""
    return f"{_rounded(float(np.degrees(angle)), digits):.{digits}f}"


def degrees(angle: float, digits: int = 1) -> str:
    """Angle [rad] in degrees."""
    return f"{degrees_number(angle, digits)} deg"


def signed(ratio: float) -> str:
    """A ratio with its sign and three digits."""
    return f"{_rounded(ratio, 3):+.3f}"


def inertia(value: float, digits: int = 4) -> str:
    """Moment of inertia [kg m^2]: that of a wheel in kg mm^2."""
    if value < _WHEEL_INERTIA_MAX:
        return f"{inertia_number(value, digits)} kg mm2"
    return f"{significant(value, digits)} kg m2"


def inertia_number(value: float, digits: int = 4) -> str:
    """Moment of inertia [kg m^2] in kg mm^2, without its unit."""
    return significant(1e6 * value, digits)


def megapascals(stress: float) -> str:
    """Stress [Pa] in MPa."""
    return f"{stress / 1e6:.1f} MPa"


_SHOWN = {"rad/s": rpm, "Pa": megapascals, "m": millimetres, "kg": grams, "rad": degrees}


def quantity(value: float, unit: str) -> str:
    """An SI value in its workshop unit; a ratio in per cent."""
    if not unit:
        return f"{value:.0%}"
    if unit in _SHOWN:
        return _SHOWN[unit](value)
    return f"{value:,.0f} {unit}" if 1e3 <= value < 1e6 else f"{value:.3g} {unit}"


def counted(count: int, noun: str) -> str:
    """Number and noun, as in `1 note` and `3 notes`."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def listed(texts: Sequence[str]) -> str:
    """Texts joined for a sentence, as in `a, b and c`."""
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))


def some_of(names: Sequence[str], most: int = 4) -> str:
    """Names separated by commas; beyond `most`, only how many more there are."""
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


def _rounded(value: float, digits: int) -> float:
    # Adding zero turns a rounded -0.0 into 0.0.
    return round(value, digits) + 0.0
