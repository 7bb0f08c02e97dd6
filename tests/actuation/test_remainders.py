"""Remainders of exp and log against exact rational sums."""

from fractions import Fraction

import numpy as np
import pytest

from ocs_design.actuation.unit_drive import exp_remainder, log_remainder

POINTS = np.concatenate([np.geomspace(1e-12, 0.999, 200), [0.3, np.nextafter(0.3, 0.0)]])


def exact_exp(z: float) -> float:
    term, total, z = Fraction(1), Fraction(0), Fraction(z)
    for n in range(1, 40):
        term *= -z / n
        total += term if n > 1 else 0
    return float(total)


def exact_log(y: float) -> float:
    """y - log(1 + y), log by the series of 2 artanh(y / (2 + y)), rounded to 2^-200 each step."""
    ratio = Fraction(y) / (2 + Fraction(y))
    square, power, total = ratio**2, ratio, Fraction(0)
    for n in range(1, 120, 2):
        total += 2 * power / n
        power = Fraction(round(power * square * 2**400), 2**400)
    return float(Fraction(y) - total)


@pytest.mark.parametrize(
    ("function", "exact"), [(exp_remainder, exact_exp), (log_remainder, exact_log)]
)
def test_full_precision_at_every_size(function, exact):
    expected = np.array([exact(float(point)) for point in POINTS])
    np.testing.assert_allclose(function(POINTS), expected, rtol=3e-15)


def test_ends():
    assert exp_remainder(np.array(0.0)) == log_remainder(np.array(0.0)) == 0.0
    assert exp_remainder(np.array(1e4)) == 9999.0
    assert exp_remainder(np.array(np.inf)) == np.inf
