"""What is left of exp and log after their linear part, to full precision also for small values."""

import numpy as np

from ocs_design.arrays import FloatArray

# Below this the series is used; above it the cancellation costs less than one digit.
_SMALL = 0.3
_EXP_TERMS = tuple(1.0 / n for n in range(13, 2, -1))
_LOG_TERMS = tuple(1.0 / n for n in range(19, 1, -2))


def exp_remainder(z: FloatArray) -> FloatArray:
    """`e^-z - 1 + z` for z >= 0: z^2/2 - z^3/6 + ..."""
    small = np.minimum(z, _SMALL)
    series = np.ones_like(small)
    for term in _EXP_TERMS:
        series = 1.0 - term * small * series
    return np.where(z < _SMALL, small**2 / 2.0 * series, z + np.expm1(-z))


def log_remainder(y: FloatArray) -> FloatArray:
    """`y - log(1 + y)` for y >= 0, with log(1 + y) = 2 artanh(r), r = y / (2 + y)."""
    small = np.minimum(y, _SMALL)
    ratio = small / (2.0 + small)
    square = ratio * ratio
    series = np.zeros_like(square)
    for term in _LOG_TERMS:
        series = square * (term + series)
    return np.where(y < _SMALL, ratio * (small - 2.0 * series), y - np.log1p(y))
