"""Points by which a trunk is looked at under what stands on it: discs, rings, plates, pedestals.

What stands is held where the trunk is within `FLATNESS` below it under every screw, and nowhere
more than `PROUD` above its underside.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import pi

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.dog_bone import DogBone
from ocs_design.parts.pedestal import Pedestal
from ocs_design.robot.surface import Surface

FLATNESS = 1e-3
"""Largest depth of a trunk's surface below what stands on it [m]: a washer's thickness."""

PROUD = 1e-4
"""Largest height of a trunk's surface above what stands on it [m]: rounding of meshes."""


def heights_at(surface: Surface, points: FloatArray) -> FloatArray:
    """Heights of a surface at points in B [m], shape (n,)."""
    return surface.height(points[:, 0], points[:, 1])


def highest_of(surface: Surface, points: FloatArray) -> float:
    """Largest of those heights [m]; -inf: none of the points is over the surface."""
    return float(heights_at(surface, points).max())


def disc_points(middle: Sequence[float], radius: float) -> FloatArray:
    """Points that stand for equal shares of a disc [m], shape (n, 2)."""
    return ring_points(middle, 0.0, radius)


def ring_points(middle: Sequence[float], inner: float, outer: float) -> FloatArray:
    """Points that stand for equal shares of a ring [m], shape (n, 2)."""
    return frozen(_around_middle(max(inner, 0.0), outer) + np.asarray(middle))


@lru_cache(maxsize=64)
def _around_middle(inner: float, outer: float) -> FloatArray:
    """Points of a ring around the origin [m], shape (n, 2)."""
    count = max(4, min(48, round((outer - inner) / 1e-3)))
    around = max(16, min(180, round(2.0 * pi * outer / 1e-3)))
    share = (np.arange(count) + 0.5) / count
    radii = np.sqrt(inner**2 + share * (outer**2 - inner**2))
    # The rim itself, where lands end first.
    angles = (np.arange(around) + 0.5) * 2.0 * pi / around
    rings = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return frozen((radii[:, None, None] * rings).reshape(-1, 2))


def plate_points(plate: CarrierPlate) -> FloatArray:
    """Points all over a plate in B [m], shape (n, 2)."""
    places = _within(plate.shape) + np.array(plate.position[:2])
    return np.concatenate([places + np.array([row, 0.0]) for row in plate.rows])


@lru_cache(maxsize=64)
def _within(shape: DogBone) -> FloatArray:
    """Points all over an outline [m], shape (n, 2)."""
    wide = shape.half_length if shape.arms > 2 else shape.radius
    xs, ys = (
        np.linspace(-half, half, 1 + int(np.ceil(2.0 * half / max(1e-3, shape.radius / 40.0))))
        for half in (wide, shape.half_length)
    )
    places = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    return frozen(places[shape.holds(places)])


def base_points(pedestal: Pedestal) -> FloatArray:
    """Points all over a pedestal's underside in B [m], shape (n, 2)."""
    half, place = pedestal.width / 2.0, pedestal.placement
    ends = (-half, half), (-pedestal.flange, pedestal.length + pedestal.flange)
    grid = [np.linspace(low, high, 2 + int((high - low) / 1e-3)) for low, high in ends]
    points = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    return points @ place.rotation[:2, :2].T + place.position[:2]
