"""Quantities with units on input and output; SI inside.

A quantity is a bare number in SI, or a number with its unit: `30mm`, `7200rpm`, `7.11e-5 kg m^2`.
The factors are exact and the product is rounded once, so that `30mm` is exactly the float 0.03.
"""

import math
import re
from enum import StrEnum
from fractions import Fraction
from reprlib import repr as shortened

from ocs_design.common.errors import QuantityError, UsageError

LARGEST = 1e15
"""Largest value (SI): far above any quantity used here, with a finite fifth power."""

MILLIMETRES = 1000.0
"""Millimetres per metre; files for workshops and printers are in millimetres."""

CELL_NOMINAL, CELL_FULL = 3.7, 4.2
"""Voltages of one lithium-polymer cell [V], as specified by makers of packs."""

STANDARD_GRAVITY = 9.81
"""Gravity on Earth [m/s^2], as in the paper."""

LONGEST_QUANTITY = 64
"""Longest text of a quantity [characters]; long exponents would cost time."""


class Dimension(StrEnum):
    """What a quantity measures; the value is its name in messages."""

    LENGTH = "length"
    MASS = "mass"
    ANGLE = "angle"
    TIME = "time"
    SPEED = "speed"
    ACCELERATION = "acceleration"
    ANGULAR_SPEED = "angular speed"
    TORQUE = "torque"
    ANGULAR_MOMENTUM = "angular momentum"
    IMPULSE = "impulse"
    DAMPING = "damping"
    INERTIA = "moment of inertia"
    VOLTAGE = "voltage"
    CURRENT = "current"
    POWER = "power"
    STRESS = "stress"
    RATIO = "ratio"


_PI = Fraction(math.pi)
_MILLI = Fraction(1, 1000)
_CENTI = Fraction(1, 100)
_MICRO = Fraction(1, 10**6)
_ONE = Fraction(1)

UNITS: dict[Dimension, dict[str, Fraction]] = {
    Dimension.LENGTH: {
        "m": _ONE,
        "mm": _MILLI,
        "cm": _CENTI,
        "um": _MICRO,
        "in": Fraction("0.0254"),
    },
    Dimension.MASS: {"kg": _ONE, "g": _MILLI, "mg": _MICRO, "lb": Fraction("0.45359237")},
    Dimension.ANGLE: {
        "rad": _ONE,
        "deg": _PI / 180,
        "°": _PI / 180,
        "mrad": _MILLI,
        "rev": 2 * _PI,
    },
    Dimension.TIME: {"s": _ONE, "ms": _MILLI, "us": _MICRO, "min": Fraction(60)},
    Dimension.SPEED: {"m/s": _ONE, "mm/s": _MILLI, "cm/s": _CENTI, "km/h": Fraction(5, 18)},
    Dimension.ACCELERATION: {"m/s2": _ONE, "mm/s2": _MILLI, "cm/s2": _CENTI},
    Dimension.ANGULAR_SPEED: {
        "rad/s": _ONE,
        "rpm": _PI / 30,
        "deg/s": _PI / 180,
        "°/s": _PI / 180,
        "rev/s": 2 * _PI,
        "rev/min": _PI / 30,
    },
    Dimension.TORQUE: {"N m": _ONE, "mN m": _MILLI, "N cm": _CENTI, "N mm": _MILLI},
    Dimension.ANGULAR_MOMENTUM: {"N m s": _ONE, "mN m s": _MILLI, "kg m2/s": _ONE},
    Dimension.IMPULSE: {"N s": _ONE, "mN s": _MILLI, "kg m/s": _ONE},
    Dimension.DAMPING: {"N m s/rad": _ONE, "mN m s/rad": _MILLI, "uN m s/rad": _MICRO},
    Dimension.INERTIA: {
        "kg m2": _ONE,
        "kg cm2": Fraction(1, 10**4),
        "kg mm2": _MICRO,
        "g m2": _MILLI,
        "g cm2": Fraction(1, 10**7),
        "g mm2": Fraction(1, 10**9),
    },
    Dimension.VOLTAGE: {"V": _ONE, "mV": _MILLI},
    Dimension.CURRENT: {"A": _ONE, "mA": _MILLI},
    Dimension.POWER: {"W": _ONE, "kW": Fraction(1000), "mW": _MILLI},
    Dimension.STRESS: {
        "Pa": _ONE,
        "kPa": Fraction(10**3),
        "MPa": Fraction(10**6),
        "GPa": Fraction(10**9),
        "N/mm2": Fraction(10**6),
    },
    Dimension.RATIO: {"%": _CENTI},
}
"""Exact SI value of each unit, by dimension, the SI unit first; products have a space."""


_UNIT_OF_SPELLING = {
    spelling: (dimension, unit)
    for dimension, factors in UNITS.items()
    for unit in factors
    for spelling in (unit, unit.replace(" ", ""))
}
_QUANTITY = re.compile(
    r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*", re.DOTALL
)

_PACK = re.compile(r"\s*([0-9]{1,3})\s*[sS]\s*")


def parse_quantity(value: object, dimension: Dimension, where: str) -> float:
    """The SI value of a bare number or of a number with its unit.

    Args:
        value: a number, or text such as `30mm`.
        dimension: what the number must measure.
        where: the option or key, for the message.

    Raises:
        QuantityError: not a finite number, an unknown unit or one of another dimension, or more
            than `LARGEST`.
    """
    if isinstance(value, str):
        match = _matched(value) if len(value) <= LONGEST_QUANTITY else None
        if match is None:
            shown = value if len(value) <= LONGEST_QUANTITY else f"{value[:LONGEST_QUANTITY]}..."
            empty, what = not value.strip(), f"{shown!r} is not a finite number with a unit"
            hint = f"Write {_example(dimension)}."
            raise QuantityError(f"{where}: {'is empty' if empty else what}", hint=hint)
        figure, unit = match.groups()
        factor = _factor(unit, dimension, value, where) if unit else _ONE
        number = _finite(float(figure), repr(value), where)
        # Below the smallest double, a fraction would have a giant denominator.
        if number != 0.0:
            number = _finite(Fraction(figure) * factor, repr(value), where)
    elif isinstance(value, bool) or not isinstance(value, (int, float)):
        raise QuantityError(
            f"{where}: {shortened(value)} is not a number", hint=f"Write {_example(dimension)}."
        )
    else:
        number = _finite(value, "the number", where)
    if abs(number) > LARGEST:
        raise QuantityError(f"{where}: {value} is out of range", hint="Check its unit.")
    return number


def parse_positive(text: str, dimension: Dimension, option: str) -> float:
    """The SI value of an option that must be positive.

    Raises:
        QuantityError, UsageError: it cannot be read, or is not positive.
    """
    value = parse_quantity(text, dimension, option)
    if value <= 0.0:
        raise UsageError(f"{option} {text}: must be positive")
    return value


def written_unit(value: object) -> str:
    """The unit that a readable `value` was written in; empty for a bare number."""
    match = _matched(value) if isinstance(value, str) else None
    return match[2] if match else ""


def _matched(text: str) -> re.Match[str] | None:
    """A number and the text after it; word processors write a minus sign for the hyphen."""
    return _QUANTITY.fullmatch(text.replace("\N{MINUS SIGN}", "-"))


def si_unit(dimension: Dimension) -> str:
    """Name of the unit that a bare number is in."""
    return "parts of 1" if dimension is Dimension.RATIO else next(iter(UNITS[dimension]))


def to_unit(value: float, unit: str) -> float:
    """The SI `value` converted to `unit`."""
    dimension, name = _UNIT_OF_SPELLING[_normalised(unit)]
    # Infinite bounds are shown, too, but cannot be fractions.
    return float(Fraction(value) / UNITS[dimension][name]) if math.isfinite(value) else value


def format_quantity(value: float, unit: str, digits: int = 4) -> str:
    """The SI `value` in `unit` for display, as in `30 mm`; `parse_quantity` reads it back."""
    space = "" if unit in {"%", "°"} else " "
    return f"{significant(to_unit(value, unit), digits)}{space}{unit}"


def rpm_number(speed: float) -> str:
    """Angular speed [rad/s] in rpm with thousands separators, without its unit."""
    return f"{speed * 30.0 / math.pi:,.0f}"


def rpm(speed: float) -> str:
    """Angular speed [rad/s] in rpm, for display only: numbers with commas cannot be parsed."""
    return f"{rpm_number(speed)} rpm"


def significant(value: float, digits: int) -> str:
    """A number with this many significant digits, written as 1610, not as 1.61e+03."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+0" in text else text


def round_outwards(value: float, *, upwards: bool, digits: int = 3) -> float:
    """`value` to this many significant digits, rounded up if `upwards`, else down."""
    if value == 0.0 or not math.isfinite(value):
        return value
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    # A figure with no more digits than that is unchanged.
    scaled = round(value / unit, 6)
    return (math.ceil(scaled) if upwards else math.floor(scaled)) * unit


def _factor(unit: str, dimension: Dimension, text: str, where: str) -> Fraction:
    """Exact SI value of `unit`, which must measure `dimension`."""
    known_unit = _UNIT_OF_SPELLING.get(_normalised(unit))
    hint = f"Units of {dimension}: {_known(dimension)}; a bare number is in {si_unit(dimension)}."
    if known_unit is None:
        pack = _PACK.fullmatch(text) if dimension is Dimension.VOLTAGE else None
        if pack is not None:
            count = int(pack[1])
            nominal, full = (f"{count * volts:.4g} V" for volts in (CELL_NOMINAL, CELL_FULL))
            cells = f"{count}S is {nominal} nominal, {full} full: give the voltage under load."
            hint = f"{cells} {hint}"
        else:
            # With a decimal point, or nothing, for its comma, and the unit's usual capitals.
            bare, meant = text.strip(" ,;."), []
            known = {name.casefold(): name for name in UNITS[dimension]}
            # A comma before three digits may separate thousands.
            for comma in (".", "") if re.search(r"[0-9],[0-9]{3}(?![0-9])", bare) else (".",):
                match = _QUANTITY.fullmatch(re.sub(r"(?<=[0-9]),(?=[0-9])", comma, bare, count=1))
                likely = _normalised(match[2]).casefold() if match else ""
                if match and (not likely or likely in known):
                    meant.append(f"{match[1]}{known.get(likely, '')}")
            if meant:
                hint = f"Did you mean {' or '.join(meant)}? {hint}"
        what = "contains a comma" if "," in unit else f"has the unknown unit {unit!r}"
        raise QuantityError(f"{where}: {text.strip()!r} {what}", hint=hint)
    if known_unit[0] is not dimension:
        raise QuantityError(
            f"{where}: {text.strip()!r} has a unit of {known_unit[0]}, not of {dimension}",
            hint=hint,
        )
    return UNITS[dimension][known_unit[1]]


def _normalised(unit: str) -> str:
    """One spelling for `kg*m^2`, `kg·m²` and `kg  m**2`."""
    for written, meant in (("**", "^"), ("^", ""), ("²", "2"), ("µ", "u"), ("μ", "u"), ("º", "°")):
        unit = unit.replace(written, meant)
    unit = re.sub(r"\s*/\s*", "/", unit)
    return re.sub(r"\s*[*·⋅]\s*|\s+", " ", unit).strip()


def floored(value: float, digits: int) -> str:
    """`value` rounded down to `digits` decimals, tolerating a thousandth of the last digit."""
    return f"{math.floor(round(value * 10**digits, 3)) / 10**digits:.{digits}f}"


def ceiled(value: float, digits: int) -> str:
    """`value` rounded up to `digits` decimals, tolerating a thousandth of the last digit."""
    return f"{math.ceil(round(value * 10**digits, 3)) / 10**digits:.{digits}f}"


def _finite(value: float | Fraction, text: str, where: str) -> float:
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise QuantityError(f"{where}: {text} is not finite", hint="Write a finite number.")
    return number


def _known(dimension: Dimension) -> str:
    return ", ".join(UNITS[dimension])


def _example(dimension: Dimension) -> str:
    if dimension is Dimension.RATIO:
        return "a bare number, or a percentage, as in '150%'"
    unit = next(iter(UNITS[dimension]))
    return f"a number in SI or with a unit, as in '1 {unit}' ({_known(dimension)})"
