"""Contact of feet, plates, masts and pedestals with the surface below them, sampled at points.

A foot is held where the ring that its screws' lands sweep over all incidences lies entirely on the
trunk: nowhere more than `FLATNESS` below the plane that it stands on, with nothing above that plane
under its base. A plate is held by four screws where the trunk is equally flat under each head or
sleeve.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.device.device import Device, Module
from ocs_design.device.solids import pedestal_of
from ocs_design.parts.carrier_plate import CarrierPlate, Point
from ocs_design.parts.dog_bone import DogBone
from ocs_design.parts.module import part_name
from ocs_design.parts.outline import even_points
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import AROUND_SLOT
from ocs_design.robot.surface import HeightMap

FLATNESS = 1e-3
"""Largest depth of a trunk's surface below the part that stands on it [m]: a washer's thickness."""

INTERFERENCE_MAX = 1e-4
"""Largest height of a trunk's surface above the part's underside [m]: rounding of meshes."""


def heights_at(surface: HeightMap, points: FloatArray) -> FloatArray:
    """Heights of a surface at points in B [m], shape (...) for points of shape (..., 2)."""
    return surface.height(points[..., 0], points[..., 1])


def highest_of(surface: HeightMap, points: FloatArray) -> float:
    """Largest of those heights [m]; -inf: none of the points is over the surface."""
    return float(heights_at(surface, points).max())


def disc_points(middle: Sequence[float], radius: float) -> FloatArray:
    """Points that represent equal areas of a disc [m], shape (n, 2)."""
    return ring_points(middle, 0.0, radius)


def ring_points(middle: Sequence[float], inner: float, outer: float) -> FloatArray:
    """Points that represent equal areas of a ring [m], shape (n, 2)."""
    inner = max(inner, 0.0)
    rings = max(4, min(48, round((outer - inner) / 1e-3)))
    around = max(16, min(180, round(2.0 * pi * outer / 1e-3)))
    return frozen(even_points(inner, outer, rings, around) + np.asarray(middle))


def plate_points(plate: CarrierPlate) -> FloatArray:
    """Points covering a plate in B [m], shape (n, 2)."""
    places = _outline_points(plate.shape) + np.array(plate.position[:2])
    return np.concatenate([places + np.array([row, 0.0]) for row in plate.rows])


@lru_cache(maxsize=64)
def _outline_points(shape: DogBone) -> FloatArray:
    """Points covering an outline [m], shape (n, 2)."""
    wide = shape.half_length if shape.arms > 2 else shape.radius
    xs, ys = (
        np.linspace(-half, half, 1 + int(np.ceil(2.0 * half / max(1e-3, shape.radius / 40.0))))
        for half in (wide, shape.half_length)
    )
    places = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    return frozen(places[shape.holds(places)])


def base_points(pedestal: Pedestal) -> FloatArray:
    """Points covering a pedestal's underside in B [m], shape (n, 2)."""
    half_width, place = pedestal.width / 2.0, pedestal.placement
    ends = (-half_width, half_width), (-pedestal.flange, pedestal.length + pedestal.flange)
    grid = [np.linspace(low, high, 2 + int((high - low) / 1e-3)) for low, high in ends]
    points = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    return points @ place.rotation[:2, :2].T + place.position[:2]


@dataclass(frozen=True)
class FootContact:
    """Contact of a part with the surface below it.

    Attributes:
        name: the part, such as "left foot" or "foot 1".
        on: what it stands on, such as "trunk".
        share: fraction of its underside that is in contact; None: unknown.
        gap: largest gap under its screws' lands [m]; inf: nothing is there; None: unknown.
        interference: height of the surface above its underside [m]; 0: no interference.
        held: whether all its screws' lands are in contact without interference; None: unknown.
        tilted: whether the module is tilted and has no support.
    """

    name: str
    on: str
    share: float | None
    gap: float | None
    interference: float
    held: bool | None
    tilted: bool = False


def under_pedestal(
    surface: HeightMap | None, device: Device, module: Module, pedestal: Pedestal
) -> FootContact:
    """Contact of a pedestal with the trunk; held only if the foot is seated on the pedestal."""
    place = pedestal.placement
    lands = [disc_points(hole, AROUND_SLOT) for hole in pedestal.in_base(pedestal.holes)]
    points = base_points(pedestal), np.concatenate(lands)
    name = part_name("pedestal", module.name)
    contact = _contact(name, surface, points, pedestal.position[2])
    wheel = place.point(pedestal.wheel)
    seated = (
        bool(np.allclose(wheel, module.position, rtol=0.0, atol=1e-6))
        and pedestal.middle >= pedestal_of(device, module).middle - 1e-6
    )
    return replace(contact, held=contact.held and seated)


def contact_of(
    name: str,
    surface: HeightMap | None,
    middle: Point,
    radius: float,
    *,
    plane: float,
    lands: tuple[float, float],
) -> FootContact:
    """Contact of a disc with the trunk, whose screws' lands are between two radii [m]."""
    points = disc_points(middle, radius), ring_points(middle, *lands)
    return _contact(name, surface, points, plane)


def _contact(
    name: str,
    surface: HeightMap | None,
    points: tuple[FloatArray, FloatArray],
    plane: float,
) -> FootContact:
    """Contact with the trunk of a part whose underside is a plane at a height in B [m].

    `points`: of its underside and of its screws' lands, shape (n, 2) each.
    """
    if surface is None:
        return FootContact(name, "trunk", None, None, 0.0, held=None)
    depth, under = (plane - heights_at(surface, part) for part in points)
    share = float(((depth <= FLATNESS) & (depth >= -INTERFERENCE_MAX)).mean())
    gap, interference = max(0.0, float(under.max())), max(0.0, -float(depth.min()))
    held = gap <= FLATNESS and interference <= INTERFERENCE_MAX
    return FootContact(name, "trunk", share, gap, interference, held)
