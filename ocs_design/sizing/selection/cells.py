"""Ranges of incidences that are bounded together."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

CELLS = 18
"""Of the incidence: 5 deg each."""


@dataclass(frozen=True)
class Cell:
    """A range of incidences [rad]; a single one if both are equal."""

    low: float
    high: float

    @property
    def shares(self) -> tuple[float, float]:
        """The largest sine and the largest cosine in it."""
        return float(np.sin(self.high)), float(np.cos(self.low))

    @property
    def least_shares(self) -> tuple[float, float]:
        """The least ones."""
        return float(np.sin(self.low)), float(np.cos(self.high))


def cells_of(incidence: float | None, count: int = CELLS) -> tuple[Cell, ...]:
    """All incidences in `count` equal cells; the one that is stated by itself."""
    if incidence is not None:
        return (Cell(incidence, incidence),)
    edges = np.linspace(0.0, np.pi / 2.0, count + 1)
    return tuple(Cell(float(a), float(b)) for a, b in pairwise(edges))
