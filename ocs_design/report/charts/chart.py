"""A chart as a value: lines, areas, points and rules on two axes, in the units of the axes."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.report.charts.scales import Axis

MOST_POINTS = 320
"""Points of a line: more than there are pixels."""


class Ink(StrEnum):
    """Colours by what they say; the style sheet has them for light and for dark.

    The first six are those of M. Okabe and K. Ito ("Color universal design", 2008), told apart by
    colour-blind eyes too; where two lines lie close, one of them is dashed as well.
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
"""Colours of curves, in the order in which they are taken."""


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Points in the units of the axes; `name` goes into the legend."""

    x: FloatArray
    y: FloatArray
    ink: Ink
    name: str = ""


@dataclass(frozen=True, eq=False)
class Line(_Drawn):
    """A curve, or several broken by NaN."""

    dashed: bool = False
    thin: bool = False


@dataclass(frozen=True, eq=False)
class Area(_Drawn):
    """A closed outline, filled faintly."""


@dataclass(frozen=True, eq=False)
class Points(_Drawn):
    """Discs; `hollow` ones are rings. `labels` stand beside them; empty: none."""

    hollow: bool = False
    labels: tuple[str, ...] = ()


@dataclass(frozen=True)
class Rule:
    """A dashed line across the chart at one value of an axis.

    A `label` stands at an upright one; `name` goes into the legend.
    """

    value: float
    upright: bool
    label: str = ""
    ink: Ink = Ink.PLAIN
    name: str = ""


Mark: TypeAlias = Line | Area | Points | Rule


@dataclass(frozen=True)
class Chart:
    """One pair of axes.

    Attributes:
        name: of the file and of the element. title: above it.
        description: what one sees in it, for those who cannot.
        x, y: axes.
        marks: drawn in this order.
        rows: names at y = 0, 1, ... in place of numbers; empty: numbers.
        equal: one unit is as long on both axes.
        height: of the drawing, whose width is always the same [px].
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


def thinned(x: FloatArray, y: FloatArray, most: int = MOST_POINTS) -> tuple[FloatArray, FloatArray]:
    """A line with fewer points that has the same peaks: the least and the largest of each piece."""
    if len(x) <= most:
        return x, y
    pieces, size = most // 2, len(x) // (most // 2)
    # The first pieces are longer by one, as those of `array_split`.
    longer = (size + 1) * (len(x) % pieces)
    ends = (*_ends(y[:longer], size + 1), *(longer + end for end in _ends(y[longer:], size)))
    kept = np.unique(np.concatenate([[0], *ends, [len(x) - 1]]))
    return x[kept], y[kept]


def _ends(y: FloatArray, size: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Indices of the least and of the largest value of each piece of that size."""
    rows = y.reshape(-1, size)
    first = np.arange(len(rows)) * size
    return first + rows.argmin(axis=1), first + rows.argmax(axis=1)
