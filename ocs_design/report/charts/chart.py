"""Charts as plain data: lines, areas, points and rules on two axes, and the ticks."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from math import ceil, floor, log10
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Distances between ticks, times a power of ten."""

_ANGLE_STEPS = (15.0, 30.0, 45.0, 90.0, 180.0, 360.0)
"""Distances between ticks of degrees, used if the smallest is not too coarse."""

_MOST_LOG_TICKS = 6

_LARGEST_DRAWN = 1e100
"""Largest value that an axis must include: a diverged run may end with NaN or huge values."""

_ROUNDING = 1e-6
"""Spread relative to the largest value below which values count as equal: it is rounding."""

_CLIP_DISTANCE = 1e3
"""Distance beyond the ends at which values are clipped, in lengths of the axis."""

MOST_POINTS = 320
"""Maximum number of points of a line, enough for the pixels of a chart."""


@dataclass(frozen=True)
class Axis:
    """One direction of a chart.

    Attributes:
        label: name of the quantity. unit: its unit, empty for plain numbers.
        low, high: ends. log: whether the scale is logarithmic.
    """

    label: str
    unit: str
    low: float
    high: float
    log: bool = False

    @classmethod
    def around(
        cls, label: str, unit: str, values: Iterable[float], *, room: float = 0.06
    ) -> "Axis":
        """Axis that spans all values that can be drawn, with room at both ends."""
        drawable = np.array([value for value in values if abs(value) < _LARGEST_DRAWN])
        low, high = (float(drawable.min()), float(drawable.max())) if drawable.size else (0.0, 1.0)
        spread = high - low
        span = spread if spread > _ROUNDING * abs(high) else abs(high) or 1.0
        return cls(label, unit, low - room * span, high + room * span)

    @property
    def title(self) -> str:
        """Label with the unit in brackets."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label

    def fractions(self, values: FloatArray | float) -> FloatArray:
        """Positions along the axis, 0 at the low and 1 at the high end."""
        if self.log:
            low, high = log10(self.low), log10(self.high)
            positive = np.where(np.asarray(values) > 0.0, values, self.low * 1e-3)
            return np.asarray((np.log10(positive) - low) / (high - low))
        fractions = (np.asarray(values) - self.low) / (self.high - self.low)
        return np.asarray(np.clip(fractions, -_CLIP_DISTANCE, _CLIP_DISTANCE))

    def ticks(self, count: int = 7) -> list[float]:
        """Round values between the ends."""
        if self.log:
            first, last = ceil(log10(self.low) - 1e-9), floor(log10(self.high) + 1e-9)
            stride = max(1, (last - first) // _MOST_LOG_TICKS)
            powers = [10.0**power for power in range(first, last + 1, stride)]
            if len(powers) > 2:
                return powers
            decades = [10.0**power for power in range(first - 1, last + 1)]
            finer_ticks = (digit * decade for decade in decades for digit in (1, 2, 5))
            return [value for value in finer_ticks if self.low <= value <= self.high]
        smallest_step = (self.high - self.low) / count
        if self.unit == "deg" and smallest_step > _ANGLE_STEPS[0] / 2.0:
            full_turns = 360.0 * ceil(smallest_step / 360.0)
            step = next((step for step in _ANGLE_STEPS if step >= smallest_step), full_turns)
        else:
            power = 10.0 ** floor(log10(smallest_step))
            step = next(
                step * power for step in _STEPS if step * power >= smallest_step * (1.0 - 1e-9)
            )
        first, last = ceil(self.low / step - 1e-9), floor(self.high / step + 1e-9)
        return [round(index * step, 12) for index in range(first, last + 1)]


def tick_text(value: float) -> str:
    """Text of a tick: a plain number if that is short, else with a power of ten."""
    if value == 0.0:
        return "0"
    magnitude = abs(value)
    if 1e-3 <= magnitude < 1e5:
        text = f"{value:,.6g}" if magnitude >= 1e4 else f"{value:.6g}"
        return text.replace("-", "\N{MINUS SIGN}").replace(",", "\N{THIN SPACE}")
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    factor = "" if mantissa == "1.0" else f"{mantissa.removesuffix('.0')}·"
    superscript = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{factor}10{superscript}".replace("-", "\N{MINUS SIGN}")


class Ink(StrEnum):
    """Colours by meaning; the style sheet defines them for light and dark themes.

    The first six are those of M. Okabe and K. Ito ("Color universal design", 2008), which
    colour-blind people can distinguish; where two lines lie close, one is also dashed.
    """

    BLUE = "blue"
    VERMILION = "vermilion"
    GREEN = "green"
    PURPLE = "purple"
    ORANGE = "orange"
    SKY = "sky"
    PLAIN = "plain"
    FAINT = "faint"


SERIES = (Ink.BLUE, Ink.VERMILION, Ink.GREEN, Ink.PURPLE, Ink.ORANGE, Ink.SKY)
"""Colours of curves, in the order of use."""


@dataclass(frozen=True, eq=False)
class _PointMark:
    """Points in the units of the axes; `name` goes into the legend."""

    x: FloatArray
    y: FloatArray
    ink: Ink
    name: str = ""


@dataclass(frozen=True, eq=False)
class Curve(_PointMark):
    """A curve, or several broken by NaN."""

    dashed: bool = False
    thin: bool = False


@dataclass(frozen=True, eq=False)
class FilledArea(_PointMark):
    """A closed outline, filled faintly."""


@dataclass(frozen=True, eq=False)
class Points(_PointMark):
    """Discs, or rings if `hollow`, with optional `labels` beside them."""

    hollow: bool = False
    labels: tuple[str, ...] = ()


@dataclass(frozen=True)
class Rule:
    """A dashed line across the chart at one value of an axis.

    An upright rule may have a `label` beside it; `name` goes into the legend.
    """

    value: float
    upright: bool
    label: str = ""
    ink: Ink = Ink.PLAIN
    name: str = ""


Mark: TypeAlias = Curve | FilledArea | Points | Rule


@dataclass(frozen=True)
class Chart:
    """One pair of axes.

    Attributes:
        name: name of the file and of the element. title: title above the chart.
        description: text alternative for readers who cannot see the chart.
        x, y: axes.
        marks: marks in drawing order.
        rows: names at y = 0, 1, ... in place of numbers; empty: numbers.
        equal: whether both axes have the same scale.
        height: height of the drawing, whose width is fixed [px].
    """

    name: str
    title: str
    description: str
    x: Axis
    y: Axis
    marks: tuple[Mark, ...]
    rows: tuple[str, ...] = ()
    equal: bool = False
    height: float = 250.0


def thinned(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Line with fewer points and the same peaks: the minimum and maximum of each piece."""
    if len(x) <= MOST_POINTS:
        return x, y
    pieces = np.array_split(np.arange(len(x)), MOST_POINTS // 2)
    extremes = [piece[[y[piece].argmin(), y[piece].argmax()]] for piece in pieces]
    kept = np.unique(np.concatenate([[0], *extremes, [len(x) - 1]]))
    return x[kept], y[kept]
