"""The housing around a wheel: it keeps fingers and legs out, and carries the motor.

A drum with a floor, and a lid as guard, with four ears around the band for the lid's screws. Both
are modelled in the wheel's frame, the floor at -z, and printed in this orientation: with floor or
lid on the bed, nothing overhangs.

Sizes of a rim, its outer radius R and height h [m], are numbers, arrays that broadcast, or CasADi
symbols.
"""

from dataclasses import dataclass, field
from math import pi
from typing import Generic

from ocs_design.actuation.fasteners import IN_PLASTIC, STEEL, BoltedJoint, Fastening, Screw
from ocs_design.common.errors import PartError
from ocs_design.parts.moments import MassMoments, Real, cylinder_mass
from ocs_design.parts.printed import (
    CLEARANCE,
    GUARD_GAP,
    LID_SCREW,
    PANEL,
    PETG,
    UPRIGHT,
    WALL,
    MountHoles,
    ear_holes,
    eared,
    half_height,
)
from ocs_design.parts.shapes import EAR_COUNT, Disc, Eared
from ocs_design.parts.solids import Part, Prism, Region

FIRST_EAR = pi / 4.0
"""Angle of the first ear from the x axis [rad]: none protrudes below, above, in front or behind."""

LID_SCREWS = Fastening(LID_SCREW, EAR_COUNT, PANEL, BoltedJoint.LID, IN_PLASTIC)


def housing_outer_radius(outer_radius: Real) -> Real:
    """Outer radius of the band around a rim [m]."""
    return outer_radius + (CLEARANCE + WALL)


@dataclass(frozen=True)
class Housing(Generic[Real]):
    """Drum and lid around a rim.

    Attributes:
        rim_radius, rim_height: outer radius and height of the rim [m].
        mount: holes in the floor.
        lid_screw: screw of the ears outside the band, tapped into the drum's; None: no ears.
        guard_wall: of the steel ring in the band that contains a bursting rim [m]; 0: none.
    """

    rim_radius: Real
    rim_height: Real
    mount: MountHoles = field(default_factory=MountHoles)
    lid_screw: Screw | None = None
    guard_wall: float = 0.0

    @property
    def radius(self) -> Real:
        """Outer radius of the band [m]."""
        return housing_outer_radius(self.rim_radius) + self.guard_wall

    @property
    def inner_radius(self) -> Real:
        """Inner radius of the band [m]."""
        return self.radius - WALL

    @property
    def half_height(self) -> Real:
        """Distance from the wheel's middle to the outside of floor and lid [m]."""
        return half_height(self.rim_height)

    @property
    def guard_radius(self) -> Real:
        """Inner radius of a guard ring [m]; the glue outside makes it that much narrower."""
        return self.rim_radius + CLEARANCE - GUARD_GAP

    @property
    def guard_height(self) -> Real:
        """Height of a guard ring, from the floor to the lid [m]."""
        return self.rim_height + 2.0 * CLEARANCE

    @property
    def band(self) -> Region[Real]:
        """The band's disc, with ears if there is a screw for them."""
        if self.lid_screw is None:
            return Disc(self.radius)
        return eared(self.radius, self.lid_screw, FIRST_EAR)


def housing_parts(housing: Housing[float]) -> tuple[Part[float], Part[float]]:
    """Drum and lid, each of one piece.

    Raises:
        PartError: the mount's holes do not fit the floor.
    """
    mount, room = housing.mount, housing.inner_radius - housing.guard_wall
    if mount.reach > room - WALL:
        raise PartError(
            f"holes up to {1e3 * mount.reach:.4g} mm from the axis do not fit the "
            f"housing's floor of {1e3 * room:.4g} mm",
            hint="choose a smaller motor, or allow a larger outer radius",
        )
    drum, lid = undrilled(housing)
    holes = mount.prisms(-housing.half_height, -housing.half_height + PANEL)
    return Part(drum.name, drum.density, drum.solids, (*drum.holes, *holes)), lid


def undrilled(housing: Housing[Real]) -> tuple[Part[Real], Part[Real]]:
    """Drum and lid without the mount's holes; see `Housing` for sizes."""
    low, high, held = -housing.half_height, housing.half_height, housing.lid_screw
    floor, under = low + PANEL, high - PANEL
    band: Region[Real] = housing.band
    room: Prism[Real] = Prism(Disc(housing.inner_radius), floor, under)
    drum, lid = Prism(band, low, under), Prism(band, under, high)
    if held is None or not isinstance(band, Eared):
        return Part("drum", PETG.density, (drum,), (room,)), Part("lid", PETG.density, (lid,))
    threads = ear_holes(band, held.tapping_drill, floor, under)
    passages = ear_holes(band, held.clearance_hole, under, high)
    return Part("drum", PETG.density, (drum,), (room, threads)), Part(
        "lid", PETG.density, (lid,), (passages,)
    )


FINGER = 10.0
"""Force of the test finger of IEC 60529 [N]."""

PETG_POISSON = 0.38
"""Poisson's ratio of PETG, taken as that of PET (MatWeb, overview of polyesters: 0.37 to 0.40)."""


def lid_sag(housing: Housing[float]) -> float:
    """Deflection of the middle of a lid with a clamped edge under `FINGER` [m].

    W a^2 / (16 pi D), D = E t^3 / (12 (1 - nu^2)): Roark's Formulas for Stress and Strain, 7th
    edition, table 11.2, case 17.
    """
    stiffness = PETG.modulus * PANEL**3 / (12.0 * (1.0 - PETG_POISSON**2))
    return FINGER * housing.inner_radius**2 / (16.0 * pi * stiffness)


def guard_ring(housing: Housing[Real]) -> Part[Real]:
    """The ring of mild steel in the drum, in the wheel's frame."""
    half, inside = housing.guard_height / 2.0, housing.guard_radius
    room: Prism[Real] = Prism(Disc(inside), -half, half)
    return Part("guard", STEEL, (Prism(Disc(inside + housing.guard_wall), -half, half),), (room,))


def housing_moments(housing: Housing[Real]) -> MassMoments[Real]:
    """Moments of drum, lid and guard ring in the module's frame, without the mount's holes."""
    drum, lid = undrilled(housing)
    printed = drum.moments() + lid.moments()
    whole = printed + guard_ring(housing).moments() if housing.guard_wall else printed
    return whole.turned(UPRIGHT)


def housing_mass_per_height(outer_radius: Real, guard_wall: float = 0.0) -> Real:
    """Change of the mass of band, ears and guard ring with the rim's height [kg/m]."""
    across = housing_outer_radius(outer_radius) + guard_wall
    room, thread = Disc(across - WALL), pi / 4.0 * LID_SCREW.tapping_drill**2
    printed = eared(across, LID_SCREW, FIRST_EAR).area - room.area - EAR_COUNT * thread
    middle = outer_radius + (CLEARANCE - GUARD_GAP + guard_wall / 2.0)
    steel: Real = middle * (2.0 * pi * guard_wall)
    return PETG.density * printed + STEEL * steel


@dataclass(frozen=True)
class PlainDrum:
    """A closed drum without ears, holes and foot: lighter than any housing."""

    def mass(self, outer_radius: Real, height: Real) -> Real:
        """Mass of both discs and the band [kg]."""
        across, inside = housing_outer_radius(outer_radius), height + 2.0 * CLEARANCE
        discs = 2.0 * pi * PETG.density * PANEL * across**2
        return discs + cylinder_mass(across - WALL, across, inside, PETG.density)

    def mass_per_height(self, outer_radius: Real, height: Real) -> Real:
        """Change of the band's mass with the height, R held [kg/m]."""
        across = housing_outer_radius(outer_radius) + 0.0 * height
        return pi * PETG.density * WALL * (2.0 * across - WALL)
