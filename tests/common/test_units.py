"""Quantities: reading, printing, rounding and errors."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.common.errors import QuantityError
from ocs_design.common.units import (
    UNITS,
    Dimension,
    ceiled,
    floored,
    format_quantity,
    parse_quantity,
    si_unit,
    to_unit,
    written_unit,
)

ALL_UNITS = [(dimension, unit) for dimension, units in UNITS.items() for unit in units]
FINITE = st.floats(-1e12, 1e12).filter(lambda x: x == 0.0 or abs(x) > 1e-200)


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("30mm", Dimension.LENGTH, 0.03),
        ("35 mm", Dimension.LENGTH, 0.035),
        ("1 in", Dimension.LENGTH, 0.0254),
        ("30", Dimension.LENGTH, 30.0),
        ("102g", Dimension.MASS, 0.102),
        ("24V", Dimension.VOLTAGE, 24.0),
        ("2 rad/s", Dimension.ANGULAR_SPEED, 2.0),
        ("2rad / s", Dimension.ANGULAR_SPEED, 2.0),
        ("36 km/h", Dimension.SPEED, 10.0),
        ("9.81m/s^2", Dimension.ACCELERATION, 9.81),
        ("9.81 m/s²", Dimension.ACCELERATION, 9.81),
        ("7.11e-5kg m^2", Dimension.INERTIA, 7.11e-5),
        ("7.11e-5 kg*m^2", Dimension.INERTIA, 7.11e-5),
        ("7.11e-5 kg·m²", Dimension.INERTIA, 7.11e-5),
        ("711 g cm^2", Dimension.INERTIA, 7.11e-5),
        ("3kgm2", Dimension.INERTIA, 3.0),
        ("1 N m", Dimension.TORQUE, 1.0),
        ("20mN m", Dimension.TORQUE, 0.02),
        ("20 mNm", Dimension.TORQUE, 0.02),
        ("215MPa", Dimension.STRESS, 215e6),
        ("0.04 N m s", Dimension.ANGULAR_MOMENTUM, 0.04),
        ("80%", Dimension.RATIO, 0.8),
        ("-.5e1 s", Dimension.TIME, -5.0),
        ("\N{MINUS SIGN}5e\N{MINUS SIGN}1 s", Dimension.TIME, -0.5),
        ("1e-999999 mm", Dimension.LENGTH, 0.0),
        *((f"{angle}deg", Dimension.ANGLE, math.radians(angle)) for angle in (1, 40, 360, -12.5)),
        ("7200rpm", Dimension.ANGULAR_SPEED, 2 * math.pi * 7200 / 60),
    ],
)
def test_quantities_are_read_exactly(text, dimension, expected):
    """Degrees and revolutions, which have no finite value in radians, to the last bit."""
    inexact = text.endswith(("deg", "rpm"))
    value = pytest.approx(expected, rel=3e-16) if inexact else expected
    assert parse_quantity(text, dimension, "x") == value


@pytest.mark.parametrize(
    ("text", "unit"), [("9.81m/s2", "m/s2"), ("3 kg m2", "kg m2"), ("-2.5e3", ""), (30, "")]
)
def test_a_unit_that_ends_with_a_digit_is_one(text, unit):
    assert written_unit(text) == unit


@given(number=st.one_of(FINITE, st.integers(-(10**12), 10**12)))
def test_bare_numbers_are_si(number):
    assert parse_quantity(number, Dimension.LENGTH, "x") == number
    assert parse_quantity(repr(number), Dimension.LENGTH, "x") == number


@given(value=FINITE, unit=st.sampled_from(ALL_UNITS))
def test_printing_and_reading_are_inverse(value, unit):
    dimension, name = unit
    text = format_quantity(value, name, digits=17)
    assert parse_quantity(text, dimension, "x") == pytest.approx(value, rel=5e-16, abs=0.0)


@given(number=st.decimals(-1000, 1000, places=3), unit=st.sampled_from(ALL_UNITS))
def test_spaces_in_a_unit_are_free(number, unit):
    dimension, name = unit
    spaced = parse_quantity(f"  {number}  {name} ", dimension, "x")
    assert parse_quantity(f"{number}{name.replace(' ', '')}", dimension, "x") == spaced
    assert parse_quantity(f"{number} {name.replace(' ', '*')}", dimension, "x") == spaced


@pytest.mark.parametrize("dimension", Dimension)
def test_the_si_unit_comes_first(dimension):
    assert dimension is Dimension.RATIO or next(iter(UNITS[dimension].values())) == 1
    assert si_unit(dimension)


def test_spellings_of_units_are_unique():
    spellings = [spelling for _, name in ALL_UNITS for spelling in {name, name.replace(" ", "")}]
    assert len(spellings) == len(set(spellings))


def test_conversion_and_formatting():
    assert to_unit(0.03, "mm") == 30.0
    assert format_quantity(0.0300004, "mm") == "30 mm"
    assert format_quantity(754.0, "rpm", 3) == "7200 rpm"
    assert format_quantity(0.25, "%") == "25%"
    assert format_quantity(math.inf, "mm") == "inf mm"


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("", "empty"),
        ("   ", "empty"),
        ("nan", "finite number"),
        ("inf", "finite number"),
        ("1e999", "not finite"),
        ("1e308 km/h", "km/h"),
        (math.nan, "not finite"),
        (math.inf, "not finite"),
        (10**400, "not finite"),
        ("30 furlong", "unknown unit 'furlong'"),
        ("5 m s", "unknown unit 'm s'"),
        ("30MM", "unknown unit 'MM'"),
        ("0 furlong", "unknown unit 'furlong'"),
        ("30V", "unit of voltage, not of length"),
        ("0x10", "unknown unit 'x10'"),
        ("1_000", "unknown unit"),
        ("٣ mm", "finite number"),
        ("thirty", "finite number"),
        ("9" * 10_000, "9..."),
        (True, "not a number"),
        (None, "not a number"),
        ([1], "not a number"),
    ],
)
def test_errors_have_a_hint(value, message):
    with pytest.raises(QuantityError, match=message) as caught:
        parse_quantity(value, Dimension.LENGTH, "flywheel.r_max")
    assert caught.value.message.startswith("flywheel.r_max: ")
    assert "mm" in caught.value.hint or "finite" in caught.value.hint


@pytest.mark.parametrize("value", ["twice", None])
def test_a_ratio_is_a_bare_number_or_per_cent(value):
    """The example of the hint can be read."""
    with pytest.raises(QuantityError) as caught:
        parse_quantity(value, Dimension.RATIO, "flywheel.stress_safety")
    assert caught.value.hint == "Write a bare number, or a percentage, as in '150%'."
    assert parse_quantity("150%", Dimension.RATIO, "") == 1.5


@given(text=st.text(max_size=80))
def test_any_text_is_a_finite_number_or_a_quantity_error(text):
    try:
        number = parse_quantity(text, Dimension.TORQUE, "x")
    except QuantityError:
        return
    assert math.isfinite(number)


@pytest.mark.parametrize(
    ("value", "digits", "below", "above"),
    [
        (0.996, 2, "0.99", "1.00"),
        (1.0 - 1e-12, 2, "1.00", "1.00"),
        (99.99, 1, "99.9", "100.0"),
        (100.0 / 0.996, 0, "100", "101"),
        (-0.05, 1, "-0.1", "0.0"),
    ],
)
def test_rounding_down_and_up(value, digits, below, above):
    """Margins are rounded down and demands up."""
    assert (floored(value, digits), ceiled(value, digits)) == (below, above)
