"""How far a trunk is off level over a flight, in two rows of a terminal."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.arrays import FloatArray
from ocs_design.report.braille import Canvas
from ocs_design.simulation.metrics import Series

HEIGHT = 2
"""Rows of characters, eight dots."""

LEAST_SPAN = np.radians(5.0)
"""Of the plot [rad]: what counts as level is not drawn as if it were not."""


def off_level(roll: ArrayLike, pitch: ArrayLike) -> FloatArray:
    """Angle between the trunk's vertical and the world's [rad]; 0..pi."""
    return np.asarray(np.arccos(np.clip(np.cos(roll) * np.cos(pitch), -1.0, 1.0)))


def tilt_plots(flights: Sequence[Series], width: int) -> tuple[list[str], float]:
    """One plot for each flight, all to one scale, and the tilt at their upper edge [rad]."""
    tilts = [off_level(series.roll, series.pitch) for series in flights]
    end = max(float(series.time[-1]) for series in flights)
    top = max([float(angles.max()) for angles in tilts] + [LEAST_SPAN])
    plots = [
        _plot(series.time / end, angles / top, width)
        for series, angles in zip(flights, tilts, strict=True)
    ]
    return plots, top


def _plot(across: FloatArray, up: FloatArray, width: int) -> str:
    """A curve without gaps, as far as the flight lasts."""
    canvas = Canvas(width, HEIGHT)
    for place in np.linspace(0.0, across[-1], 16 * width):
        canvas.dot(float(place), float(np.interp(place, across, up)))
    return "\n".join(canvas.rows())
