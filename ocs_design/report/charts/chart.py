"""A chart as a value: what `svg` draws on a page or into a file."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.report.charts.marks import Mark
from ocs_design.report.charts.scales import Axis

MOST_POINTS = 320
"""Of a line: more than there are pixels."""


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
    # As `array_split` has it: the first ones are longer by one.
    longer = (size + 1) * (len(x) % pieces)
    ends = (*_ends(y[:longer], size + 1), *(longer + end for end in _ends(y[longer:], size)))
    kept = np.unique(np.concatenate([[0], *ends, [len(x) - 1]]))
    return x[kept], y[kept]


def _ends(y: FloatArray, size: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Where the least and the largest of each piece of that size are."""
    rows = y.reshape(-1, size)
    first = np.arange(len(rows)) * size
    return first + rows.argmin(axis=1), first + rows.argmax(axis=1)
