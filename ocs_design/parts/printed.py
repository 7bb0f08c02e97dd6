"""Features shared by all printed parts: walls, ears for screws, and the holes around a motor.

Sizes may be arrays or CasADi symbols: outlines with these can be weighed, but not drawn.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import Any, NamedTuple

import numpy as np

from ocs_design.actuation.fasteners import STEEL, BoltCircle, BoltedJoint, Fastening, Screw, screw
from ocs_design.common.frames import Placement
from ocs_design.parts.moments import MassMoments, Real, point
from ocs_design.parts.shapes import EAR_COUNT, Disc, Eared
from ocs_design.parts.solids import ORIGIN, Prism

WALL = 1.6e-3
"""Thickness of walls, which hold screws without infill: four lines of a 0.4 mm nozzle [m]."""

PANEL = 1.2e-3
"""Thickness of the drum's floor, backed by the foot's plate, and of the lid: six layers of 0.2 mm
[m].

The 10 N of the test finger of IEC 60529 deflect the middle of a lid of 45 mm radius with a clamped
edge by 1.33 mm, and the part over the rim by less than 0.1 mm: W a^2 / (16 pi D), Roark, 7th
edition, table 11.2, case 17, with 1.8 GPa and nu = 0.38 (`housing.lid_sag`).
"""

CLEARANCE = 2.0e-3
"""Clearance between rim and shell on all sides [m]: ten times a printer's error over 100 mm
(0.2 %), and room for a screw's head."""

GUARD_GAP = 0.1e-3
"""Width of the epoxy between a guard ring and its drum, as around a motor's bell [m]; the ring
is that much closer to the rim."""


class Bulk(NamedTuple):
    """Material of parts: density [kg/m^3], yield strength and elastic modulus [Pa]."""

    density: float
    strength: float
    modulus: float


PETG = Bulk(density=1270.0, strength=47e6, modulus=1.8e9)
"""Tougher than PLA, prints without a heated chamber. Density and tensile yield strength along its
layers: Prusament PETG, technical data sheet, Prusa Polymers, 2020, 1.27 g/cm^3 and 47 +- 2 MPa. The
modulus is within the range measured on the related PCTG in any print orientation (Essentium PCTG,
technical data sheet, ISO 527-2: 1.7 to 1.9 GPa); additive.tools/materials/petg has 2 to 3 GPa."""

STRENGTH_ACROSS = 25e6
"""Tensile strength of PETG across its layers, the least of 25 to 38 MPa
(additive.tools/materials/petg) [Pa]."""

PLATE_THICKNESS = 5.0e-3
"""Least thickness of the plate of a foot [m]: at 20 g a module of 0.3 kg, 45 mm above the base,
bends a stem 40 mm wide with 16 MPa. For heavier ones it is thicker, see `foot.plate_thickness`."""

SHOCK = 20.0 * 9.80665
"""Acceleration that feet, and plates under them, must withstand: 20 g [m/s^2]."""

LID_SCREW = screw("M2")

BASE_THICKNESS = 3.0e-3
"""Least thickness of the base of a foot [m]: the trunk's screws press on it."""

BASE_SHARE = 0.6
"""Thickness of a base over that of the foot's plate, unless `BASE_THICKNESS` is more. One moment
bends both: on a carrier plate a base needs 0.58 to 0.59 for `SHOCK`, under modules of 1.2 to
3.2 kg."""

FLOOR = 3.0e-3
"""Least thickness of the floor of a cage [m]: the motor's screws press on it, as the trunk's screws
do on the foot's base."""

FLOOR_SHARE = 0.42
"""Thickness of that floor over that of the foot's plate, unless `FLOOR` is more: it needs 0.12 to
0.42 for `SHOCK`."""

TRUNK_SCREW, TRUNK_SCREW_COUNT = screw("M3"), 2
"""Screws of a foot on the trunk: one through each slot."""

AROUND_SLOT = max(TRUNK_SCREW.head_diameter / 2.0, TRUNK_SCREW.clearance_hole / 2.0 + WALL)
"""Room for heads, or for a wall, around the middle of a slot [m]."""

WASHER, WASHER_ACROSS, WASHER_HEIGHT = "ISO 7093-1 - 3", 9.0e-3, 0.8e-3
"""Large washer for such a screw, its largest diameter and height [m]: ISO 7093-1:2000, table 1."""

WASHER_MASS = pi / 4.0 * (WASHER_ACROSS**2 - 3.2e-3**2) * WASHER_HEIGHT * STEEL
"""Mass of such a washer [kg]; its hole is 3.2 mm wide."""

PRESSURE_SHARE = 0.5
"""Pressure under a head on a print over the yield strength: low, to limit creep."""

UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Rotation from the wheel's frame, z along its axis and y down, to the module's."""


def base_thickness(plate: Real | float) -> Real:
    """Thickness of the base of a foot, from that of its plate [m]."""
    share: Any = BASE_SHARE * plate
    # A number stays a Python float, which can be written to files.
    larger: Any = max if isinstance(share, float) else np.maximum
    thick: Real = larger(BASE_THICKNESS, share)
    return thick


def trunk_screws(plate: float) -> Fastening:
    """Screws of a foot with a plate of this thickness [m], one through each slot."""
    through = float(base_thickness(plate))
    return Fastening(TRUNK_SCREW, TRUNK_SCREW_COUNT, through, BoltedJoint.FOOT_ON_TRUNK)


def ear_radius(ear_screw: Screw) -> float:
    """Radius of an ear's round end: a wall around the widest hole [m]."""
    return ear_screw.clearance_hole / 2.0 + WALL


def ear_axis(radius: Real, ear_screw: Screw) -> Real:
    """Radius of an ear's hole from the axis, so that it stays outside a band of this radius [m]."""
    return radius + ear_screw.clearance_hole / 2.0


def eared(radius: Real, ear_screw: Screw, first: float) -> Eared[Real]:
    """The disc of a band with ears for a screw.

    Args:
        radius: outer radius of the band [m].
        ear_screw: the screw.
        first: angle of the first ear [rad].
    """
    return Eared(radius, ear_axis(radius, ear_screw), ear_radius(ear_screw), first)


def ear_holes(band: Eared[Real], diameter: float, low: Real, high: Real) -> Prism[Real]:
    """Holes in the ears of a band between two heights [m]."""
    radius: Any = diameter / 2.0
    hole: Disc[Real] = Disc(radius, (band.axis, 0.0))
    return Prism(hole, low, high, count=EAR_COUNT, first=band.first)


@dataclass(frozen=True)
class MountHoles:
    """Through holes around the wheel's axis, common to motor, housing and foot.

    The motor is outside, on the foot's plate or in a cage on it; the screws of either go through
    the housing's floor and the plate, with their heads inside.

    Attributes:
        pilot_radius: of the hole in the middle, for shaft and centring collar [m]; 0: none.
        screws: around it, the first of them straight up; None: no others.
    """

    pilot_radius: float = 0.0
    screws: BoltCircle | None = None

    @property
    def reach(self) -> float:
        """Radius within which the holes stay [m]."""
        return self.pilot_radius if self.screws is None else self.screws.reach

    def prisms(
        self, low: float, high: float, placement: Placement = ORIGIN
    ) -> Iterator[Prism[float]]:
        """The holes along the z axis of `placement`, between two coordinates on it [m]."""
        if self.pilot_radius > 0.0:
            yield Prism(Disc(self.pilot_radius), low, high, placement)
        if self.screws is not None:
            hole = Disc(self.screws.hole_radius, (0.0, -self.screws.radius))
            yield Prism(hole, low, high, placement, self.screws.bolts)

    def cut_out(self, thickness: float) -> MassMoments[float]:
        """Negative moments of the holes in a plate of this thickness [m], about its middle."""
        holes = (hole.moments() for hole in self.prisms(-thickness / 2.0, thickness / 2.0))
        return sum(holes, point(0.0)).turned(UPRIGHT).times(-PETG.density)


def half_height(height: Real) -> Real:
    """Distance from the wheel's middle to the outside of floor and lid [m]."""
    return height / 2.0 + (CLEARANCE + PANEL)


def screw_lever(edge: float, slot_radius: float) -> float:
    """Tilting moment on a foot over the largest pull on its two screws [m].

    The foot turns about the edge of its support, and each screw resists in proportion to its
    distance from it; the pull is largest when both screws are on a line square to that edge.
    """
    return 2.0 * (edge**2 + slot_radius**2) / (edge + slot_radius)
