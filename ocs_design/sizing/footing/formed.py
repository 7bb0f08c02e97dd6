"""Fronts of blocks shaped to the trunk, where it is nowhere flat enough for a mast.

The block is milled along the axes of its screws, drilled together with the mast, and serves as the
jig for drilling the trunk.
"""

from functools import lru_cache
from math import pi

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.parts.carrier_plate import TOUCH, CarrierPlate
from ocs_design.parts.solids import Relief
from ocs_design.robot.surface import HeightMap

TILT_MAX = pi / 9.0
"""Largest slope of a trunk under a screw's head, from square to the screw [rad].

At 20 degrees, the thread is complete only 0.36 diameters behind the drill's entry, so the screws
are longer by that; 0.36 of the preload acts downhill, which the screws are sized for; and the drill
would wander, which the block prevents as a jig.
"""

DEPTH_MAX = 0.025
"""Largest difference of a formed block's thickness [m]: three diameters of M8, and the reach of a
standard 10 mm ball cutter."""

CLEARANCE = 0.1e-3
"""Gap between block and trunk, so that it nowhere interferes [m]."""

STEP = 2e-3
"""Largest distance between grid points of its front [m]."""

THICKNESS_MIN = 6e-3
"""Least thickness of a formed block [m]: enough to weld it to a tube's wall of 5 mm."""

_SAMPLES_PER_CELL = 4
"""Sampling points of the trunk along each side of a cell."""

_DIGITS = 5
"""Digits of thicknesses [m]: a hundredth of a millimetre, the resolution of a mill."""


@lru_cache(maxsize=4096)
def front_of(back: HeightMap, half: float, low: float, high: float) -> FloatArray | None:
    """Backward distances of a block's front on a grid to the left and upwards [m], shape (m, n).

    None: the trunk is not everywhere behind it, is too deep, or has an edge that it cannot follow.
    `half`: of the block's width [m]; `low`, `high`: its ends in B [m].
    """
    cells = [int(np.ceil(length / STEP)) for length in (2.0 * half, high - low)]
    left, up = (
        np.linspace(start, end, _SAMPLES_PER_CELL * count + 1)
        for start, end, count in zip((-half, low), (half, high), cells, strict=True)
    )
    trunk = back.between(up, left[:, None])
    if not np.isfinite(trunk).all():
        return None
    corners = trunk[::_SAMPLES_PER_CELL, ::_SAMPLES_PER_CELL]
    # Few trunks need such a block, and the import takes a tenth of a second.
    from scipy.ndimage import maximum_filter  # noqa: PLC0415

    # Between grid points a bulging trunk is higher: they move back by the most of adjacent cells.
    bulge = trunk - _interpolated(corners, half, (low, high), left, up)
    highest = maximum_filter(bulge, 2 * _SAMPLES_PER_CELL + 1, mode="constant")[
        ::_SAMPLES_PER_CELL, ::_SAMPLES_PER_CELL
    ]
    front = corners + np.maximum(highest, 0.0) + CLEARANCE
    gap = _interpolated(front, half, (low, high), left, up) - trunk
    if gap.max() > TOUCH or np.ptp(front) > DEPTH_MAX:
        return None
    return frozen(front)


def _interpolated(
    corners: FloatArray, half: float, ends: tuple[float, float], left: FloatArray, up: FloatArray
) -> FloatArray:
    """A front interpolated between its grid points."""
    return Relief(-half, half, *ends, corners).height(left[:, None], up)


def block_thicknesses(
    front: FloatArray, spacer: float
) -> tuple[float, tuple[tuple[float, ...], ...]]:
    """Plane where a flat block of that thickness starts, and thicknesses of the formed one [m].

    `front`: see `front_of`; `spacer`: least thickness [m].
    """
    plane = round(float(front.max()), 6)
    thick = np.floor((spacer + plane - front) * 10**_DIGITS + 1e-6) / 10**_DIGITS
    rows = np.round(thick, _DIGITS).tolist()
    return plane, tuple(map(tuple, rows))


def distance_from_trunk(back: HeightMap, plate: CarrierPlate) -> FloatArray | None:
    """Distances of a plate's formed block from the trunk all over its front [m]; None: no block."""
    relief, mast, (x, y, z) = plate.relief, plate.mast, plate.position
    if relief is None or mast is None:
        return None
    left, up = (
        np.linspace(grid[0], grid[-1], _SAMPLES_PER_CELL * (len(grid) - 1) + 1)
        for grid in (relief.x, relief.y)
    )
    face = -(x + mast.face + relief.height(left[:, None], up))
    return np.asarray(face - back.between(z + up, y + left[:, None]))
