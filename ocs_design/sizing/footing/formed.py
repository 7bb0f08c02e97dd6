"""Fronts of blocks that have a trunk's own form, where it is nowhere flat enough for a mast.

The block is milled along the axes of its screws, drilled with the mast, and is the jig through
which the trunk is drilled.
"""

from functools import lru_cache
from math import pi

import numpy as np
from scipy.ndimage import maximum_filter

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.parts.carrier_plate import TOUCH, CarrierPlate
from ocs_design.parts.solids import Relief
from ocs_design.robot.surface import Surface

TILT_MAX = pi / 9.0
"""Steepest that a trunk may be under a screw's head, off square to it [rad].

At 20 degrees a thread is cut all around only 0.36 diameters behind where the drill enters, which
the screws are longer by; a preload pushes downhill by 0.36 of itself, which they are counted with;
and a drill wanders, which the block as a jig prevents.
"""

DEPTH_MAX = 0.025
"""Largest difference of a formed block's thickness [m]: three diameters of M8, and what a ball
cutter of 10 mm reaches down to without a longer one."""

BED = 0.1e-3
"""How far it stays off the trunk, so that it nowhere cuts into it [m]."""

STEP = 2e-3
"""Distance of the corners of its front, at the most [m]."""

LEAST = 6e-3
"""Thickness of a formed block where it is thinnest [m]: to weld it on a tube's wall of 5 mm."""

_FINE = 4
"""Places in a cell at which the trunk is looked at, along either side."""

_DIGITS = 5
"""Digits of thicknesses [m]: a hundredth of a millimetre, as a mill has it."""


@lru_cache(maxsize=4096)
def front_of(back: Surface, half: float, low: float, high: float) -> FloatArray | None:
    """How far back the front of a block is, to the left and upwards [m], shape (m, n).

    None: the trunk is not everywhere beneath it, too deep, or has an edge that it cannot follow.

    Args:
        back: of the trunk. half: of the block's width [m]. low, high: its ends in B [m].
    """
    cells = [int(np.ceil(long / STEP)) for long in (2.0 * half, high - low)]
    left, up = (
        np.linspace(start, end, _FINE * count + 1)
        for start, end, count in zip((-half, low), (half, high), cells, strict=True)
    )
    trunk = back.between(up, left[:, None])
    if not np.isfinite(trunk).all():
        return None
    corners = trunk[::_FINE, ::_FINE]
    # Between its corners a trunk that bulges is higher: they go back by as much as in any cell.
    over = trunk - _between(corners, half, (low, high), left, up)
    highest = maximum_filter(over, 2 * _FINE + 1, mode="constant")[::_FINE, ::_FINE]
    front = corners + np.maximum(highest, 0.0) + BED
    off = _between(front, half, (low, high), left, up) - trunk
    if off.max() > TOUCH or np.ptp(front) > DEPTH_MAX:
        return None
    return frozen(front)


def _between(
    corners: FloatArray, half: float, ends: tuple[float, float], left: FloatArray, up: FloatArray
) -> FloatArray:
    """A front between its corners."""
    return Relief(-half, half, *ends, corners).height(left[:, None], up)


def thicknesses(front: FloatArray, spacer: float) -> tuple[float, tuple[tuple[float, ...], ...]]:
    """Beginning of a flat block of that thickness, and the thickness of the formed one [m].

    Args:
        front: see `front_of`. spacer: thickness where it is thinnest [m].
    """
    plane = round(float(front.max()), 6)
    thick = np.floor((spacer + plane - front) * 10**_DIGITS + 1e-6) / 10**_DIGITS
    rows = np.round(thick, _DIGITS).tolist()
    return plane, tuple(map(tuple, rows))


def off_trunk(back: Surface, plate: CarrierPlate) -> FloatArray | None:
    """How far the front of a plate's formed block is off the trunk, all over it [m]; None: none."""
    relief, mast, (x, y, z) = plate.relief, plate.mast, plate.position
    if relief is None or mast is None:
        return None
    left, up = (
        np.linspace(each[0], each[-1], _FINE * (len(each) - 1) + 1) for each in (relief.x, relief.y)
    )
    face = -(x + mast.face + relief.height(left[:, None], up))
    return np.asarray(face - back.between(z + up, y + left[:, None]))
