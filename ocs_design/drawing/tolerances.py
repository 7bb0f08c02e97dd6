"""Standard tolerances of sizes (ISO 286-1, table 1)."""

from bisect import bisect_left
from enum import Enum

_STEPS_MM = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000)
"""Upper ends of the steps of nominal sizes [mm]."""


class Grade(Enum):
    """Widths of the tolerance interval over the steps of nominal sizes [um]."""

    IT7 = (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63, 70, 80, 90)
    IT9 = (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155, 175, 200, 230)
    IT11 = (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400, 440, 500, 560)


def tolerance_width(size: float, grade: Grade) -> float:
    """Width of the tolerance interval of a nominal size [m]; sizes above 1 m as 1 m."""
    step = bisect_left(_STEPS_MM, round(1e3 * size, 9))
    return 1e-6 * grade.value[min(step, len(_STEPS_MM) - 1)]


def plus_minus(size: float, grade: Grade) -> float:
    """Half the width, to the hundredth of a millimetre downwards, at least one [m]."""
    return 1e-5 * max(1.0, (1e5 * tolerance_width(size, grade) / 2.0 + 1e-9) // 1.0)
