"""Inertias as MuJoCo accepts them: its own copy, repaired only where it must be.

MuJoCo refuses a moving body without mass, and one whose principal moments break the triangle
inequality in the last bit. Sizing never sees what is written here.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties, physical_defect
from ocs_design.robot.spec.frames import quaternion

NEGLIGIBLE_MASS = 1e-9
"""What a massless moving body weighs in MuJoCo [kg]; its limit is 1e-15."""
NEGLIGIBLE_INERTIA = 1e-12
"""The smallest principal moment in MuJoCo [kg m^2]; its limit is 1e-15."""


@dataclass(frozen=True, eq=False)
class Inertial:
    """What MuJoCo's `<inertial>` holds.

    Attributes:
        mass: [kg].
        position: centre of mass in the body's frame [m], shape (3,).
        quaternion: of the principal axes in the body's frame (w, x, y, z), shape (4,).
        moments: principal moments of inertia [kg m^2], shape (3,).
        remark: what had to be changed, to be followed by the body's name; None if nothing was.
    """

    mass: float
    position: FloatArray
    quaternion: FloatArray
    moments: FloatArray
    remark: str | None


def inertial(raw: MassProperties) -> Inertial:
    """Mass properties in MuJoCo's form; what it would refuse is changed as little as will do."""
    moments, axes = np.linalg.eigh(raw.inertia)
    if np.linalg.det(axes) < 0.0:
        axes = axes * [-1.0, 1.0, 1.0]
    accepted = nearest_physical_moments(moments, NEGLIGIBLE_INERTIA)
    return Inertial(
        max(raw.mass, NEGLIGIBLE_MASS),
        raw.com,
        quaternion(axes),
        accepted,
        _remark(raw, accepted),
    )


def _remark(raw: MassProperties, accepted: FloatArray) -> str | None:
    defect = physical_defect(raw)
    if defect is not None:
        figures = ", ".join(f"{moment:.4g}" for moment in accepted)
        return f"simulated with the nearest principal moments that exist ({figures} kg m^2)"
    if raw.mass < NEGLIGIBLE_MASS:
        return f"moving links without mass, simulated with {NEGLIGIBLE_MASS:g} kg"
    return None


def nearest_physical_moments(moments: FloatArray, floor: float) -> FloatArray:
    """The principal moments nearest to `moments` (ascending) that a rigid body can have.

    The smallest change in the sense of least squares under `m >= floor` and `m0 + m1 >= m2`: a
    quadratic program so small that trying each set of active constraints solves it exactly.

    Args:
        moments: ascending [kg m^2], shape (3,).
        floor: smallest moment allowed [kg m^2].
    """
    candidates = [
        _with_active(np.array(moments, dtype=np.float64), floor, floored, triangle)
        for floored, triangle in product(range(4), (False, True))
    ]
    allowed = [each for each in candidates if _is_physical(each, floor)]
    return min(allowed, key=lambda each: float(np.sum((each - moments) ** 2)))


def _with_active(moments: FloatArray, floor: float, floored: int, triangle: bool) -> FloatArray:
    """The least change that puts the first `floored` moments on the floor."""
    found = moments.copy()
    found[:floored] = floor
    free = 3 - floored
    if triangle and free:
        excess = found[2] - found[0] - found[1]
        found[floored:2] += excess / free
        # MuJoCo compares to the last bit.
        found[2] = min(found[2] - excess / free, found[0] + found[1])
    return found


def _is_physical(moments: FloatArray, floor: float) -> bool:
    return bool(moments.min() >= floor and moments[0] + moments[1] >= moments.max())
