"""The carrier plate, on which the feet stand if the trunk is too narrow or too curved for them.

One flat plate of aluminium across the trunk: a ring under each foot, with threads for the foot's
screws, and from its middle an arm to each ring. The arms of a pair form one neck; three or more
form a star. Two screws in each arm hold it on the trunk, each through a sleeve where the trunk lies
lower. Its axes are those of the base frame B, its origin is the middle of its underside. Several
pairs of modules, one behind the other, have one such plate each, at one height and with their own
screws; together they count as one body.

If nothing can stand on top of the trunk, a mast behind it carries the plates one above the other: a
square tube upright on the trunk's back, with an arm of the same tube under each plate. Four screws
through the tube hold it, each in a sleeve that keeps the walls apart. A block in front of the
upright keeps it clear of protrusions; if the trunk is nowhere flat, the block's front is shaped to
the trunk. The strength of all this is computed in `plate_strength`.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import TypeAlias, TypeVar

import numpy as np

from ocs_design.actuation.fasteners import BoltedJoint, Fastening, Screw, ThreadName, screw
from ocs_design.catalogue.materials import material
from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import BACKWARDS, FORWARDS, Placement
from ocs_design.common.ranges import Distance, Length, LengthIfAny, Positive
from ocs_design.parts.dog_bone import DogBone, directions
from ocs_design.parts.printed import AROUND_SLOT, TRUNK_SCREW, Bulk
from ocs_design.parts.shapes import Disc, Rectangle
from ocs_design.parts.solids import Part, Prism, Relief, hollow_cylinder
from ocs_design.robot.mass import MassProperties, combine

MATERIAL = "aluminium-6061-t6"
"""Name in the catalogue of materials."""

_KIND = material(MATERIAL)
assert _KIND.yield_strength is not None and _KIND.elastic_modulus is not None
ALUMINIUM = Bulk(_KIND.density, _KIND.yield_strength, _KIND.elastic_modulus)

SHEAR_MODULUS = 26e9
"""Shear modulus of 6061 [Pa]: Hibbeler, Mechanics of Materials, Appendix C."""

STOCK = (3.0e-3, 4.0e-3, 5.0e-3, 6.0e-3, 8.0e-3, 10.0e-3, 12.0e-3, 15.0e-3, 20.0e-3)
"""Thicknesses of rolled plate commonly in stock, EN 485-4 [m]."""

SAFETY = 2.0
"""Least ratio of yield strength to bending stress."""

SLEEVE_WALL = 2.0e-3
"""Wall of a sleeve around its screw [m]: 7.4 mm outside for M3, wider than the screw's head."""

SLEEVE_MAX = 0.03
"""Longest sleeve under a plate, four times as long as wide for M3 [m]; only posts are longer."""

SHIM = 1.0e-3
"""Length below which a sleeve is easier to make of washers than to cut from tube [m]."""

POST_DEPTH = 1.9
"""Least thread depth of posts over their diameter: in aluminium an M8's full preload is then half
of what strips the thread."""

EDGE = 1.5
"""Least distance of a hole's middle from an edge, over its diameter: EN 1993-1-8, table 3.3,
requires 1.2."""

SLOT_EDGE = max(AROUND_SLOT, EDGE * TRUNK_SCREW.diameter)
"""Least width of a plate on either side of the circle of a foot's slots [m]."""

MAST_YIELD = 115e6 / 1.25
"""Yield strength of 6061-T6 beside a weld, over the partial factor of joints [Pa]: f_o,haz of EN
1999-1-1, table 3.2b, and table 8.1."""

TUBES = (
    *((0.025, 2.0e-3), (0.03, 2.0e-3), (0.04, 2.0e-3), (0.04, 3.0e-3), (0.05, 3.0e-3)),
    *((0.05, 4.0e-3), (0.06, 4.0e-3), (0.08, 4.0e-3), (0.1, 5.0e-3)),
)
"""Sides and walls of square tube commonly in stock [m]; tolerances: EN 755-8."""

TOUCH = 0.5e-3
"""Largest gap between a formed block and the trunk [m], to be filled with loaded epoxy."""

_AROUND = 24
"""Number of points around a screw at which the thickness of a formed block is evaluated."""

Point: TypeAlias = tuple[float, float]

Hole = TypeVar("Hole", Point, float)


@dataclass(frozen=True)
class Mast:
    """Upright square tube on the trunk's back, with an arm of it backwards under each plate.

    Attributes:
        side: of the tube, outside [m]. wall: of the tube [m].
        face: x of the upright's side on the trunk, in the plate's frame [m].
        below, high: distance of its lower and upper end below and above the plate's origin [m].
        overhang: largest distance of an arm above or below the trunk's screws [m].
        spacer: thickness of the block between the upright and the trunk, around the screws [m].
        formed: thickness of a block shaped to the trunk, at the corners of a regular grid over its
            front, first index to the left, second upwards [m]; `spacer` is then about the least.
            Empty: the block is flat.
    """

    side: Distance
    wall: Distance
    face: Distance
    below: Distance
    high: Distance
    overhang: Distance
    spacer: Distance = 0.0
    formed: tuple[tuple[float, ...], ...] = ()

    @property
    def off(self) -> float:
        """Distance of the upright from the trunk where the block is thickest [m]."""
        return max(map(max, self.formed), default=self.spacer)

    @property
    def low(self) -> float:
        """Coordinate z of its lower end [m]."""
        return -self.below

    @property
    def bore(self) -> float:
        """Width of the tube inside [m]."""
        return self.side - 2.0 * self.wall

    @property
    def back(self) -> float:
        """Coordinate x of the upright's other side, where the arms begin [m]."""
        return self.face - self.side

    @property
    def second_moment(self) -> float:
        """Second moment of the tube's area, (a^4 - b^4) / 12 [m^4]."""
        return (self.side**4 - self.bore**4) / 12.0

    def stress(self, bending: float, twisting: float) -> float:
        """Von Mises stress of the tube under a bending and a twisting moment [N m] [Pa].

        M a / (2 I), and Bredt's T / (2 t (a - t)^2): Roark's Formulas for Stress and Strain, 7th
        edition, table A.1 and section 10.3.
        """
        bent = bending * self.side / (2.0 * self.second_moment)
        twisted = twisting / (2.0 * self.wall * (self.side - self.wall) ** 2)
        return sqrt(bent**2 + 3.0 * twisted**2)


@dataclass(frozen=True)
class CarrierPlate:
    """Plate on the trunk that all feet stand on, or one plate for each pair of feet.

    Attributes:
        position: of the middle of its underside, or of all their undersides, in B [m].
        radius: of the discs of its outline (`DogBone`) [m]. half_length: from its middle to any
            end [m]. neck: half of the width of a disc's neck [m].
        thickness: [m].
        across: distance of the middle of each foot from the plate's, the first one's along y [m].
        window: radius of the hole under each foot, 0: none [m].
        feet: positions of the threaded holes for the feet's screws, x and y from its middle, the
            same number for each plate, one plate after the other [m].
        trunk: positions of the holes for the trunk's screws, in the same order; for a mast, y and
            z [m].
        sleeves: length of the sleeve under each hole in `trunk`, 0: none [m].
        thread, foot_thread: of the trunk's screws and of the feet's screws.
        material: name. density: [kg/m^3].
        rows: forward coordinate of the middle of each plate, from the common middle [m].
        levels: height of the underside of each plate above the common one; empty: 0 [m].
        mast: carries the plates; None: the trunk does.
        arms: number of arms of each plate, one for each foot on it.
        sleeve_wall: wall of the sleeves around their screws [m].
    """

    position: tuple[float, float, float]
    radius: Length
    half_length: LengthIfAny
    neck: Distance
    thickness: Length
    across: Distance
    window: Distance
    feet: tuple[Point, ...]
    trunk: tuple[Point, ...]
    sleeves: tuple[float, ...]
    thread: ThreadName = "M3"
    foot_thread: ThreadName = "M3"
    material: str = MATERIAL
    density: Positive = ALUMINIUM.density
    rows: tuple[float, ...] = (0.0,)
    levels: tuple[float, ...] = ()
    mast: Mast | None = None
    arms: int = 2
    sleeve_wall: Length = SLEEVE_WALL

    @property
    def shape(self) -> DogBone:
        """Its outline about its own middle, without holes."""
        return DogBone(self.radius, self.half_length, self.neck, arms=self.arms)

    @property
    def sizes(self) -> tuple[float, float, float]:
        """Length forward, width and thickness of each plate [m]."""
        length, width = np.ptp(self.across * directions(self.arms), axis=0) + 2.0 * self.radius
        return float(length), float(width), self.thickness

    @property
    def shapes(self) -> tuple[DogBone, ...]:
        """Outline of each plate about the common middle, without holes."""
        return tuple(replace(self.shape, x=row) for row in self.rows)

    @property
    def single_plates(self) -> tuple["CarrierPlate", ...]:
        """Every plate on its own, with its own screws."""
        (x, y, z), plates = self.position, []
        trunk, sleeves = ((), ()) if self.mast else (self.trunk, self.sleeves)
        for index, (row, level) in enumerate(zip(self.rows, self.heights, strict=True)):
            feet, held = (
                tuple((along - row, across) for along, across in self.own(holes, index))
                for holes in (self.feet, trunk)
            )
            single = replace(self, position=(x + row, y, z + level), rows=(0.0,), levels=())
            own = self.own(sleeves, index)
            plates.append(replace(single, feet=feet, trunk=held, sleeves=own))
        return tuple(plates)

    @property
    def kinds(self) -> tuple[tuple[int, ...], ...]:
        """Indices of the plates of each kind, which have equal holes and sleeves."""
        kinds: dict[object, list[int]] = {}
        for index, plate in enumerate(self.single_plates):
            # To the micrometre, so that equal plates compare equal.
            holes = np.round((*plate.feet, *plate.trunk), 6)
            kinds.setdefault((holes.tobytes(), plate.sleeves), []).append(index)
        return tuple(map(tuple, kinds.values()))

    @property
    def heights(self) -> tuple[float, ...]:
        """Height of the underside of each plate above the common one [m]."""
        return self.levels or (0.0,) * len(self.rows)

    @property
    def screw_places(self) -> tuple[Placement, ...]:
        """Frames of the trunk's screws in the plate's, z away from the trunk, above the sleeves."""
        if self.mast is None:
            return tuple(Placement(np.eye(3), np.array([x, y, 0.0])) for x, y in self.trunk)
        front = self.mast.face + self.mast.spacer
        return tuple(Placement(BACKWARDS, np.array([front, y, z])) for y, z in self.trunk)

    @property
    def clamped(self) -> float:
        """Thickness clamped by the trunk's screws, without their sleeves [m]."""
        return self.thickness if self.mast is None else self.mast.side + self.mast.spacer

    @property
    def block(self) -> tuple[float, float]:
        """Lower and upper end of a mast's block around its screws, in its own frame [m]."""
        edge = EDGE * self.screw.clearance_hole
        return min(z for _, z in self.trunk) - edge, max(z for _, z in self.trunk) + edge

    @property
    def relief(self) -> Relief | None:
        """The mast's block shaped to the trunk, drilled, in the plate's frame; None: none.

        The block's z axis points forward, away from the upright.
        """
        mast = self.mast
        if mast is None or not mast.formed:
            return None
        half, radius = mast.side / 2.0, self.screw.clearance_hole / 2.0
        place = Placement(FORWARDS, np.array([mast.face, 0.0, 0.0]))
        holes = tuple((*hole, radius) for hole in self.trunk)
        heights = np.array(mast.formed)
        return Relief(-half, half, *self.block, heights, holes, place)

    @property
    def gaps(self) -> tuple[float, ...]:
        """Largest distance of the trunk from plate or spacer around each of its screws [m]."""
        mast, relief = self.mast, self.relief
        if mast is None or relief is None:
            return self.sleeves
        around = self.screw.clearance_hole / 2.0 * directions(_AROUND)
        thick = (float(relief.height(*(around + hole).T).max()) for hole in self.trunk)
        return tuple(max(0.0, thickness - mast.spacer) for thickness in thick)

    @property
    def slopes(self) -> FloatArray:
        """Slope of the block's front under each of the trunk's screws, left and up, shape (n, 2).

        The slope of a plane fitted to the area under the screw's head; 0 without a formed block.
        """
        relief = self.relief
        if relief is None:
            return np.zeros((len(self.trunk), 2))
        around, radius = directions(_AROUND), self.screw.head_diameter / 2.0
        thick = [relief.height(*(radius * around + hole).T) for hole in self.trunk]
        return np.asarray(2.0 / radius * np.array(thick) @ around / _AROUND)

    def own(self, holes: tuple[Hole, ...], index: int) -> tuple[Hole, ...]:
        """Share of the holes that belongs to the plate with this index."""
        count = len(holes) // len(self.rows)
        return holes[index * count : (index + 1) * count]

    @property
    def screw(self) -> Screw:
        """Screw that holds the plate on the trunk."""
        return screw(self.thread)

    @property
    def top(self) -> float:
        """Height of its upper side in B, on which the feet stand [m]."""
        return self.position[2] + self.thickness

    @property
    def sleeve_radius(self) -> float:
        """Radius of the sleeves, outside [m]."""
        return self.screw.clearance_hole / 2.0 + self.sleeve_wall

    @property
    def sleeve_section(self) -> tuple[float, float, float]:
        """Area [m^2], section modulus [m^3] and second moment [m^4] of a sleeve."""
        outside, inside = self.sleeve_radius, self.screw.clearance_hole / 2.0
        second = pi / 4.0 * (outside**4 - inside**4)
        return pi * (outside**2 - inside**2), second / outside, second

    @property
    def screw_lengths(self) -> tuple[float, ...]:
        """Length of each of the trunk's screws under its head [m]."""
        return tuple(
            self.screw.length_through(self.clamped + gap, self.thread_depth) for gap in self.gaps
        )

    @property
    def thread_depth(self) -> float:
        """Least depth of the trunk's threads over their diameter."""
        return POST_DEPTH if self.on_posts else 1.0

    @property
    def on_posts(self) -> bool:
        """Whether its sleeves are posts, by their wall: these are clamped, however short."""
        return self.sleeve_wall > SLEEVE_WALL

    @property
    def fastenings(self) -> tuple[Fastening, ...]:
        """The trunk's screws, grouped by length; each group has its longest sleeve."""
        longest = dict(sorted(zip(self.screw_lengths, self.gaps, strict=True)))
        joint = BoltedJoint.PLATE if self.mast is None else BoltedJoint.MAST
        several, groups = len(longest) > 1, []
        for length, sleeve in longest.items():
            count, through = self.screw_lengths.count(length), self.clamped + sleeve
            group = Fastening(self.screw, count, through, joint, self.thread_depth)
            groups.append(replace(group, several_lengths=several))
        return tuple(groups)

    def net_width(self, across: FloatArray) -> FloatArray:
        """Width of one plate's sections at some y, minus screw holes and windows [m]."""
        whole = 2.0 * self.shape.half_width(across)
        for middle in (self.across, -self.across):
            whole -= 2.0 * _chord(self.window, across - middle)
        for _, y in () if self.mast else self.trunk:
            whole -= 2.0 * _chord(self.screw.clearance_hole / 2.0, across - y)
        return np.asarray(whole)

    @property
    def support(self) -> float:
        """Distance along y from the middle to the outermost support, screws or mast's arm [m]."""
        return self.mast.side / 2.0 if self.mast else max(y for _, y in self.trunk)

    @property
    def half_pattern(self) -> tuple[float, float]:
        """Half the spacing of four screws, forward and sideways; sideways and up on a mast [m]."""
        along, across = np.ptp(np.array(self.trunk), axis=0) / 2.0
        return float(along), float(across)

    @property
    def mass(self) -> float:
        """Mass of plate, sleeves and the trunk's screws [kg]."""
        solid = sum(part.mass() for part, _ in plate_bodies(self))
        return solid + sum(self.screw.mass(length) for length in self.screw_lengths)

    def mass_properties(self) -> MassProperties:
        """Mass properties of plate, sleeves and the trunk's screws in B."""
        return self.own_mass_properties().moved(np.eye(3), np.array(self.position))

    def own_mass_properties(self) -> MassProperties:
        """Mass properties of plate, sleeves and the trunk's screws in its own frame."""
        placed = ((part.mass_properties(), at) for part, at in plate_bodies(self))
        bodies = [body.moved(at.rotation, at.position) for body, at in placed]
        # Screws as points.
        for place, length in zip(self.screw_places, self.screw_lengths, strict=True):
            at, mass = self.clamped - self.screw.centre(length), self.screw.mass(length)
            bodies.append(MassProperties(mass, place.point([0.0, 0.0, at]), np.zeros((3, 3))))
        return combine(bodies)


def steepest(plate: CarrierPlate) -> float:
    """Largest angle between a screw's axis and the trunk's normal under it, by the block [rad]."""
    return float(np.arctan(np.linalg.norm(plate.slopes, axis=1).max(initial=0.0)))


def _chord(radius: float, off: FloatArray) -> FloatArray:
    """Half the chord of a circle at a distance `off` from its middle [m]."""
    return np.asarray(np.sqrt(np.maximum(0.0, radius**2 - off**2)))


def plate_bodies(plate: CarrierPlate) -> Iterator[tuple[Part[float], Placement]]:
    """Plates, mast, formed block and sleeves, each with its placement in the plate's frame."""
    here = Placement.identity()
    yield plate_part(plate), here
    if plate.mast is not None:
        yield mast_part(plate, plate.mast), here
    if plate.relief is not None:
        yield block_part(plate, plate.relief), here
    for place, length in zip(plate.screw_places, plate.sleeves, strict=True):
        if length > 0.0:
            yield sleeve_part(plate, length), place
        if plate.mast is not None:
            far = plate.clamped - plate.mast.wall
            inside = place @ Placement(np.eye(3), np.array([0.0, 0.0, far]))
            yield sleeve_part(plate, plate.mast.bore), inside


def plate_part(plate: CarrierPlate) -> Part[float]:
    """The plate, or all plates in position, with their holes, in the plate's frame."""
    kinds = (
        (plate.feet, screw(plate.foot_thread).tapping_drill),
        (() if plate.mast else plate.trunk, plate.screw.clearance_hole),
    )
    solids, holes = [], []
    middles = (plate.across * directions(plate.arms)).tolist() if plate.window > 0.0 else []
    for index, (shape, low) in enumerate(zip(plate.shapes, plate.heights, strict=True)):
        high = low + plate.thickness
        solids.append(Prism(shape, low, high))
        for places, width in kinds:
            holes += [Prism(Disc(width / 2.0, at), low, high) for at in plate.own(places, index)]
        windows = (Disc(plate.window, (shape.x + x, y)) for x, y in middles)
        holes += [Prism(window, low, high) for window in windows]
    return Part("plate", plate.density, tuple(solids), tuple(holes))


def mast_part(plate: CarrierPlate, mast: Mast) -> Part[float]:
    """The mast's tubes, welded, with the holes for its screws, in the plate's frame."""
    half, bore = mast.side / 2.0, mast.side / 2.0 - mast.wall
    tube, inside = (
        Rectangle(-half_width, half_width, -half_width, half_width) for half_width in (half, bore)
    )
    # Faces that touch must coincide to the last bit: otherwise meshes separate and holes stay shut.
    face, far = mast.face, mast.side - mast.wall
    upright = Rectangle(mast.back, face, -half, half)
    within = Rectangle(face - far, face - mast.wall, -bore, bore)
    levels = [Placement(BACKWARDS, np.array([mast.back, 0.0, z - half])) for z in plate.heights]
    arm = mast.back + plate.neck
    solids, holes = (
        [Prism(standing, mast.low, mast.high), *(Prism(lying, 0.0, arm, at) for at in levels)]
        for standing, lying in ((upright, tube), (within, inside))
    )
    flat = 0.0 if mast.formed else mast.spacer
    walls = (-flat, mast.wall), (far, mast.side)
    if flat > 0.0:
        block = Rectangle(*plate.block, -half, half)
        front = Placement(BACKWARDS, np.array([face, 0.0, 0.0]))
        solids.append(Prism(block, -flat, 0.0, front))
    drilled = Disc(plate.screw.clearance_hole / 2.0)
    for y, z in plate.trunk:
        through = Placement(BACKWARDS, np.array([face, y, z]))
        holes += [Prism(drilled, low, high, through) for low, high in walls]
    return Part("mast", plate.density, tuple(solids), tuple(holes))


def block_part(plate: CarrierPlate, relief: Relief) -> Part[float]:
    """The block shaped to the trunk, in the plate's frame."""
    return Part("block", plate.density, (relief,))


def sleeve_part(plate: CarrierPlate, length: float) -> Part[float]:
    """A sleeve of this length [m], with its upper end at the origin."""
    bore = plate.screw.clearance_hole / 2.0
    return Part(
        "sleeve", plate.density, (hollow_cylinder(bore, plate.sleeve_radius, -length, 0.0),)
    )
