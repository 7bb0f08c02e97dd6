"""Feet of a device before their support is known, and the footing that is found for them."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import ceil, copysign, log, sqrt
from typing import Any, TypeVar

import numpy as np

from ocs_design.actuation.tilt_inertia import OUT_OF_REACH
from ocs_design.common.arrays import FloatArray
from ocs_design.device.device import Device, Module, with_supports
from ocs_design.device.layout import Layout
from ocs_design.parts.carrier_plate import CarrierPlate, Point
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import AROUND_SLOT
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.sizing.place import SPACING, Place, Size, module_size, wheel_size

Result = TypeVar("Result")

SENSES = (1.0, -1.0)

SAME_PLACE = 1e-9
"""Distance between places that are equal except for rounding [m]."""

_SIZE_RATIO = 1.02
"""Ratio of sizes, or of masses, of modules that count as nearly equal."""

_SIZE_FIELDS = "radius", "slot_radius", "reach", "height", "mass"
"""Fields of feet whose increase makes modules harder to hold."""


@dataclass(frozen=True)
class Feet:
    """Feet of a device.

    Attributes:
        x: forward coordinate of the origin of `bases`, in B [m].
        bases: centres of the feet's bases relative to (x, 0) [m]; those of a pair are left and
            right.
        slopes: 1 where a base's front screw is on its left, -1 where it is on its right; empty
            where any foot is tilted.
        radius: of the bases [m].
        slot_radius: radius of the screw circle [m].
        reach: radius around each that its module stays within [m].
        height: of the wheels' centres above the undersides [m].
        mass: of one module [kg].
    """

    x: float
    bases: tuple[Point, ...]
    slopes: tuple[float, ...]
    radius: float
    slot_radius: float
    reach: float
    height: float
    mass: float

    @property
    def size(self) -> Size[float]:
        """Space that each module takes."""
        return Size(self.reach, self.height)

    @property
    def centers(self) -> list[Point]:
        """Centres of the bases in B [m]."""
        return [(self.x + along, across) for along, across in self.bases]

    @property
    def lands(self) -> tuple[float, float]:
        """Radii between which the lands of a foot's screws are, whatever the incidence [m]."""
        return self.slot_radius - AROUND_SLOT, self.slot_radius + AROUND_SLOT

    @property
    def y(self) -> float:
        """Lateral coordinate of the first base, positive left [m]."""
        return self.bases[0][1]

    @cached_property
    def rows(self) -> tuple[float, ...]:
        """Distance of each plate's centre ahead of x [m]; empty where no plate can carry the feet.

        Each pair has one plate, and so has a ring of three or more.
        """
        if self.arms > 2:
            return (0.0,)
        pairs = list(zip(self.bases[::2], self.bases[1::2], strict=False))
        mirrored = all(np.allclose(right, (x, -y), atol=SAME_PLACE) for (x, y), right in pairs)
        in_pairs = 2 * len(pairs) == len(self.bases) == len(self.slopes) and mirrored
        return tuple(x for (x, _), _ in pairs) if in_pairs else ()

    @cached_property
    def arms(self) -> int:
        """Number of feet on each plate: all where they are evenly spaced on a circle, else two."""
        count = len(self.bases)
        upright = count > 2 and len(self.slopes) == count
        ring = upright and np.allclose(self.y * directions(count), self.bases, atol=SAME_PLACE)
        return count if ring else len(SENSES)

    @property
    def screws(self) -> tuple[Point, ...]:
        """Positions of their screws from (x, 0) [m], at 45 degrees to the lateral direction."""
        off = self.slot_radius / sqrt(2.0)
        return tuple(
            (x + sense * off, y + sense * slope * off)
            for (x, y), slope in zip(self.bases, self.slopes, strict=True)
            for sense in SENSES
        )


@dataclass(frozen=True, eq=False)
class Footing:
    """Place of modules and their plate or pedestals, before the modules are chosen.

    Attributes:
        place: of the modules, as a function of their size.
        plate: plate for the largest possible modules; None: they stand on the trunk.
        pedestals: pedestals under tilted modules.
    """

    place: Place
    plate: CarrierPlate | None
    pedestals: tuple[Pedestal, ...] = ()

    @property
    def supports(self) -> tuple[CarrierPlate | Pedestal, ...]:
        """Parts between the feet and the trunk."""
        return (*(() if self.plate is None else (self.plate,)), *self.pedestals)

    def added_to(self, robot: MassProperties) -> MassProperties:
        """The robot with plate and pedestals, later replaced by the chosen device's own."""
        return with_supports(robot, self.supports)


def device_size(device: Device) -> Size[float]:
    """Space that each module takes."""
    wheel, mount = device.flywheel, device.mount
    if device.wheels_alone:
        return wheel_size(wheel.outer_radius, wheel.height)
    return module_size(
        wheel.outer_radius + device.guard_wall,
        max(wheel.height, mount.room),
        mount.behind(device.motor),
        mount.holes.reach,
        foot_plate=device.foot_plate,
    )


def feet_of(device: Device) -> Feet:
    """Feet of a device that has them."""
    foot = device.foot
    places = np.array([module.position[:2] for module in device.modules])
    x = float(places[:, 0].mean())
    bases = tuple((float(along) - x, float(across)) for along, across in places)
    size = device_size(device)
    slopes = slopes_of(np.stack([module.axis for module in device.modules], axis=1))
    base = foot.base_radius, foot.slot_radius, size.reach, size.wheel_height
    return Feet(x, bases, slopes, *base, device.module_mass)


def ring_of(layout: Layout, reach: float) -> tuple[Point, ...]:
    """Centres of the feet's bases, around their common centre, for modules of this radius [m]."""
    return tuple((SPACING * reach * x, SPACING * reach * y) for x, y, _ in layout.ring)


def slopes_of(axes: FloatArray) -> tuple[float, ...]:
    """Sides of each foot's screws (`Feet.slopes`); axes in B, shape (3, n)."""
    if np.abs(axes[2]).max() > OUT_OF_REACH:
        return ()
    return tuple(copysign(1.0, x * y) for x, y in axes[:2].T.tolist())


def is_tilted(module: Module) -> bool:
    """Whether a module's foot is tilted."""
    return float(module.frame[2, 2]) < 1.0 - OUT_OF_REACH


@dataclass(frozen=True, eq=False)
class FailedSearches:
    """Searches for footings on one robot that have failed.

    A search takes longest where it fails: modules that are larger and heavier in every respect than
    ones for which it failed are assumed to fail too, without a search.

    Attributes:
        feet: for which it failed, by layout, name of the search and its options.
    """

    feet: dict[tuple[object, ...], list[Feet]] = field(default_factory=dict)

    def run(
        self,
        search: Callable[..., Result | None],
        robot: Robot,
        feet: Feet,
        layout: Layout,
        *options: bool,
        rounding: Callable[[float], int] = ceil,
    ) -> Result | None:
        """Result of a search for modules of nearly this size, at any position.

        Sizes and mass are rounded up by at most 2 % (`rounding`), or down (`floor`), so that nearly
        equal modules share one search.
        """
        figures: dict[str, Any] = {
            name: _SIZE_RATIO ** rounding(log(getattr(feet, name), _SIZE_RATIO))
            for name in _SIZE_FIELDS
        }
        rounded = replace(feet, x=0.0, bases=(), **figures)
        failed = self.feet.setdefault((layout, search.__name__, *options), [])
        if any(
            rounded.slopes == other.slopes
            and all(getattr(other, name) <= getattr(rounded, name) for name in _SIZE_FIELDS)
            for other in failed
        ):
            return None
        result = search(robot, rounded, layout, *options)
        if result is None:
            failed.append(rounded)
        return result
