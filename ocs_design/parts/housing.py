"""The housing as it is printed: a drum with a floor, and a lid that is its guard.

Both stand around the wheel in the wheel's frame, the floor at -z, and are printed as they stand:
floor or lid on the bed, nothing overhangs.
"""

from dataclasses import dataclass, field
from math import pi

from ocs_design.exceptions import PartError
from ocs_design.fasteners import Screw
from ocs_design.parts.ears import ear_axis, ear_holes, ear_radius, eared
from ocs_design.parts.mount import Mount
from ocs_design.parts.outline import Outline, circle
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism
from ocs_design.sizing.housing import (
    DENSITY,
    WALL,
    half_height,
    housing_outer_radius,
)

FIRST_EAR = pi / 4.0
"""Angle from the x axis [rad]: nothing stands out below, above, before and behind."""


@dataclass(frozen=True)
class Housing:
    """Drum and lid around a rim.

    Attributes:
        rim_radius, rim_height: outer ones of the rim [m].
        mount: holes in the floor.
        lid_screw: of the ears outside the band, cut into the drum's; None: no ears.

    Raises:
        PartError: the mount's holes do not fit the floor.
    """

    rim_radius: float
    rim_height: float
    mount: Mount = field(default_factory=Mount)
    lid_screw: Screw | None = None

    def __post_init__(self) -> None:
        if self.mount.reach > self.inner_radius - WALL:
            raise PartError(
                f"holes up to {1e3 * self.mount.reach:.4g} mm from the axis do not fit the "
                f"housing's floor of {1e3 * self.inner_radius:.4g} mm",
                hint="choose a smaller motor, or allow a larger outer radius",
            )

    @property
    def radius(self) -> float:
        """Of the band, outside [m]."""
        return housing_outer_radius(self.rim_radius)

    @property
    def inner_radius(self) -> float:
        """Of the band, inside [m]."""
        return self.radius - WALL

    @property
    def half_height(self) -> float:
        """From the wheel's middle to the outside of floor and lid [m]."""
        return half_height(self.rim_height)

    @property
    def ear_reach(self) -> float:
        """Radius that the ears stay within [m]."""
        if self.lid_screw is None:
            return self.radius
        return ear_axis(self.radius, self.lid_screw) + ear_radius(self.lid_screw)


def housing_parts(housing: Housing) -> tuple[Part, Part]:
    """Drum and lid, each of one piece."""
    return _drum(housing), _lid(housing)


def _drum(housing: Housing) -> Part:
    low, high = -housing.half_height, housing.half_height - WALL
    floor, screw = low + WALL, housing.lid_screw
    room = Prism(circle(housing.inner_radius), floor, high)
    threads = () if screw is None else _ear_holes(housing, screw, screw.tapping_drill)
    cut = (
        room,
        *housing.mount.holes(low, floor),
        *(Prism(hole, floor, high) for hole in threads),
    )
    return Part("drum", DENSITY, (Prism(_outline(housing), low, high),), cut)


def _lid(housing: Housing) -> Part:
    low, high, screw = housing.half_height - WALL, housing.half_height, housing.lid_screw
    holes = () if screw is None else _ear_holes(housing, screw, screw.clearance_hole)
    plate = Prism(_outline(housing), low, high)
    return Part("lid", DENSITY, (plate,), tuple(Prism(hole, low, high) for hole in holes))


def _ear_holes(housing: Housing, screw: Screw, diameter: float) -> list[Outline]:
    return ear_holes(housing.radius, screw, diameter, FIRST_EAR)


def _outline(housing: Housing) -> Outline:
    """The band's circle, with ears where they are wanted."""
    screw = housing.lid_screw
    return circle(housing.radius) if screw is None else eared(housing.radius, screw, FIRST_EAR)
