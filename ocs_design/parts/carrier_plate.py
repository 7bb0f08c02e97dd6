"""The carrier plate: what both feet stand on where the trunk is too narrow or too curved for them.

One flat plate of aluminium across the trunk: a ring under each foot, around the circle of its
screws, whose threads are in it, and a neck between both rings. Four screws in the neck hold it on
the trunk, each through a sleeve where the trunk lies lower there. Its axes are those of the base
frame B, its origin the middle of its underside. Several pairs of modules, one behind the other,
have as many equal plates at one height, each with screws of its own; together they are one body.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import acos, asin, pi, sqrt, tan
from typing import TypeAlias, TypeVar

import numpy as np

from ocs_design.actuation.fasteners import Fastening, Screw, screw
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.moments import MassMoments
from ocs_design.parts.outline import Outline
from ocs_design.parts.part import Part
from ocs_design.parts.printed import SHOCK
from ocs_design.parts.shapes import Disc, flat
from ocs_design.parts.solids import Prism, hollow_cylinder
from ocs_design.robot.mass import MassProperties, combine

MATERIAL, DENSITY, YIELD_STRENGTH = "aluminium-6061-t6", 2710.0, 255e6
"""Name in the catalogue of materials, density [kg/m^3], yield strength [Pa]: Hibbeler, Mechanics
of Materials, Appendix C."""

MODULUS = 69e9
"""Of 6061 [Pa], as in the catalogue of materials."""

STOCK = (3.0e-3, 4.0e-3, 5.0e-3, 6.0e-3, 8.0e-3, 10.0e-3, 12.0e-3, 15.0e-3, 20.0e-3)
"""Thicknesses of rolled plate, EN 485-4 sizes that are kept in stock [m]."""

SAFETY = 2.0
"""Least ratio of yield strength to bending stress."""

SLEEVE_WALL = 2.0e-3
"""Wall of a sleeve around its screw [m]: 7.4 mm outside for M3, wider than the screw's head."""

EDGE = 1.5
"""Least distance of a hole's middle from an edge, over its diameter: EN 1993-1-8, table 3.3, asks
for 1.2."""

_SECTIONS = 101
"""Sections between a screw and the middle of a foot whose stress is looked at."""

Point: TypeAlias = tuple[float, float]

Hole = TypeVar("Hole", Point, float)


FILLET = 10.0e-3
"""Radius between neck and ends [m], or what there is room for: a cutter's, and no sharp notch."""


def bending_stress(mass: float, arm: float, width: float, thickness: float) -> float:
    """Stress in a plate that carries a mass at the end of a cantilever, under `SHOCK` [Pa].

    M = m a L and sigma = 6 M / (w t^2): Roark's Formulas for Stress and Strain, 7th edition, table
    8.1, case 1a, with the section modulus of a rectangle.

    Args:
        mass: of what it carries [kg].
        arm: from its support to the mass [m].
        width, thickness: of the section, less its holes [m].
    """
    return 6.0 * mass * SHOCK * arm / (width * thickness**2)


def twisting_stress(mass: float, arm: float, width: float, thickness: float) -> float:
    """Shear stress in a plate that a mass above it twists, under `SHOCK` across its length [Pa].

    T = m a h, and tau = 3 T / (w t^2) (1 + 0.6095 q + 0.8865 q^2 - 1.8023 q^3 + 0.91 q^4), q = t/w:
    Roark's Formulas for Stress and Strain, 7th edition, table 10.1, case 4.

    Args:
        mass: of what it carries [kg].
        arm: of the mass above the plate [m].
        width, thickness: of the section, less its holes; the thickness is the lesser [m].
    """
    q = thickness / width
    series = 1.0 + 0.6095 * q + 0.8865 * q**2 - 1.8023 * q**3 + 0.91 * q**4
    return 3.0 * mass * SHOCK * arm / (width * thickness**2) * series


@dataclass(frozen=True)
class DogBone:
    """Two discs on the y axis with a neck between them, rounded where they meet.

    With a neck as wide as the discs it is a rectangle with half a disc at either end.

    Attributes:
        radius: of the discs [m].
        half_length: from the middle to either end, along y [m].
        neck: half of the neck's width, at most the radius [m].
        x: of its middle [m].
    """

    radius: float
    half_length: float
    neck: float
    x: float = 0.0

    @property
    def across(self) -> float:
        """Distance of either disc's middle from its own [m]."""
        return self.half_length - self.radius

    @property
    def fillet(self) -> float:
        """Radius of the rounding, so that two of them have room on either side [m]."""
        beyond = self.radius - self.neck
        if beyond <= 0.0:
            return FILLET
        room = self.across**2 - self.radius**2 + self.neck**2
        return min(FILLET, 0.95 * room / (2.0 * beyond))

    @property
    def straight(self) -> float:
        """Half the length of the neck's straight sides [m]."""
        reach, out = self.radius + self.fillet, self.neck + self.fillet
        return self.across - sqrt(max(0.0, reach**2 - out**2))

    @property
    def meets(self) -> tuple[float, float]:
        """Point where a rounding meets its disc, x and y [m]."""
        share = self.radius / (self.radius + self.fillet)
        out = self.neck + self.fillet
        return share * out, self.across - share * (self.across - self.straight)

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return self.moments.mass

    @property
    def moments(self) -> MassMoments[float]:
        """Moments about the origin, of unit density: about its middle four times a quarter's.

        int x dy, int x^3 / 3 dy and int x y^2 dy along the neck, x = w, along the rounding, x = w +
        f - q(s) with s = y - y_0, and along the disc, x = q(s) with s = y - c; see `_Circle`.
        """
        w, f, r, c, low = self.neck, self.fillet, self.radius, self.across, self.straight
        _, top = self.meets
        area, cubes, second = w * low, w**3 * low, w * low**3 / 3.0
        # The rounding: of its tangent's distance less a circle.
        a, end, gone = w + f, top - low, _Circle(f, 0.0, top - low)
        area += a * end - gone.one
        cubes += a**3 * end - 3.0 * a**2 * gone.one - gone.cube
        cubes += 3.0 * a * (f**2 * end - end**3 / 3.0)
        second += a * ((low + end) ** 3 - low**3) / 3.0 - gone.about(low)
        disc = _Circle(r, top - c, r)
        area, cubes, second = area + disc.one, cubes + disc.cube, second + disc.about(c)
        area *= 4.0
        return flat(area, 4.0 / 3.0 * cubes + area * self.x**2, 4.0 * second, x=self.x * area)

    def outline(self) -> Outline:
        """The neck's sides, and the discs between their roundings."""
        (x, y), low, middle = self.meets, self.straight, np.array([self.x, 0.0])
        if self.neck >= self.radius:
            corners = [[x, -low], [x, low], [-x, low], [-x, -low]]
            return Outline(np.array(corners) + middle, np.array([0.0, 1.0, 0.0, 1.0]))
        right = [[self.neck, -low], [self.neck, low], [x, y]]
        corners = [*right, *([-along, across] for along, across in reversed(right[1:]))]
        corners += [[-self.neck, -low], [-x, -y], [x, -y]]
        angle = acos((self.neck + self.fillet) / (self.radius + self.fillet))
        inward, around = -tan(angle / 4.0), tan((pi + 2.0 * angle) / 4.0)
        bulges = [0.0, inward, around, inward, 0.0, inward, around, inward]
        return Outline(np.array(corners) + middle, np.array(bulges))

    def half_width(self, across: FloatArray) -> FloatArray:
        """Half its width at some distances from its middle along y, 0 beyond its ends [m]."""
        off, f = np.abs(across), self.fillet
        _, top = self.meets
        within = np.clip(off - self.straight, 0.0, f)
        rounded = self.neck + f - np.sqrt(f**2 - within**2)
        disc = np.sqrt(np.maximum(0.0, self.radius**2 - (off - self.across) ** 2))
        return np.asarray(np.where(off < top, rounded, disc))


@dataclass(frozen=True)
class _Circle:
    """Integrals along a piece of a circle, q(s) = sqrt(r^2 - s^2), in closed form.

    Attributes:
        radius: r [m]. low, high: between which s goes [m].
    """

    radius: float
    low: float
    high: float

    @property
    def one(self) -> float:
        """Integral of q: (s q + r^2 asin(s/r)) / 2 [m^2]."""
        return self._between(lambda s, q: (s * q + self.radius**2 * asin(s / self.radius)) / 2.0)

    @property
    def cube(self) -> float:
        """Integral of q^3: s q^3 / 4 + 3/4 r^2 times that of q [m^4]."""
        own = self._between(lambda s, q: s * q**3 / 4.0)
        return own + 0.75 * self.radius**2 * self.one

    def about(self, offset: float) -> float:
        """Integral of (s + offset)^2 q [m^4].

        That of s q is -q^3 / 3, that of s^2 q is -s q^3 / 4 and r^2 / 4 times that of q.
        """
        first = self._between(lambda _, q: -(q**3) / 3.0)
        own = self._between(lambda s, q: -s * q**3 / 4.0) + self.radius**2 / 4.0 * self.one
        return own + 2.0 * offset * first + offset**2 * self.one

    def _between(self, primitive: Callable[[float, float], float]) -> float:
        low, high = (
            primitive(s, sqrt(max(0.0, self.radius**2 - s**2))) for s in (self.low, self.high)
        )
        return high - low


@dataclass(frozen=True)
class CarrierPlate:
    """Plate on the trunk that both feet stand on, or one plate for each pair of feet.

    Attributes:
        position: of the middle of its underside, or of all their undersides, in B [m].
        radius, half_length, neck: of its outline; see `DogBone` [m].
        thickness: [m].
        across: of the middle of each foot from its own, along y to both sides [m].
        window: radius of the hole under each foot, 0: none [m].
        feet: of the holes with threads for the feet's screws, x and y from its middle, as many for
            each plate, one plate after the other [m].
        trunk: of the holes for the trunk's screws, likewise [m].
        sleeves: length of the sleeve under each of those, 0: none [m].
        thread, foot_thread: of both kinds of screws.
        material: name. density: [kg/m^3].
        rows: forward coordinate of the middle of each plate from the common one [m].
    """

    position: tuple[float, float, float]
    radius: float
    half_length: float
    neck: float
    thickness: float
    across: float
    window: float
    feet: tuple[Point, ...]
    trunk: tuple[Point, ...]
    sleeves: tuple[float, ...]
    thread: str = "M3"
    foot_thread: str = "M3"
    material: str = MATERIAL
    density: float = DENSITY
    rows: tuple[float, ...] = (0.0,)

    @property
    def shape(self) -> DogBone:
        """Its outline about its own middle, without holes."""
        return DogBone(self.radius, self.half_length, self.neck)

    @property
    def shapes(self) -> tuple[DogBone, ...]:
        """Outline of each plate about the common middle, without holes."""
        return tuple(replace(self.shape, x=row) for row in self.rows)

    @property
    def each(self) -> tuple["CarrierPlate", ...]:
        """Every plate on its own, with the screws that are its own."""
        x, y, z = self.position
        return tuple(
            replace(
                self,
                position=(x + row, y, z),
                feet=tuple((along - row, across) for along, across in self._own(self.feet, index)),
                trunk=tuple(
                    (along - row, across) for along, across in self._own(self.trunk, index)
                ),
                sleeves=self._own(self.sleeves, index),
                rows=(0.0,),
            )
            for index, row in enumerate(self.rows)
        )

    def _own(self, holes: tuple[Hole, ...], index: int) -> tuple[Hole, ...]:
        """What of the holes is of one plate."""
        count = len(holes) // len(self.rows)
        return holes[index * count : (index + 1) * count]

    @property
    def screw(self) -> Screw:
        """Screw that holds it on the trunk."""
        return screw(self.thread)

    @property
    def top(self) -> float:
        """Height of its upper side in B, on which the feet stand [m]."""
        return self.position[2] + self.thickness

    @property
    def sleeve_radius(self) -> float:
        """Radius of the sleeves, outside [m]."""
        return self.screw.clearance_hole / 2.0 + SLEEVE_WALL

    @property
    def screw_lengths(self) -> tuple[float, ...]:
        """Length of each of the trunk's screws under its head [m]."""
        return tuple(self.screw.length_through(self.thickness + each) for each in self.sleeves)

    @property
    def fastenings(self) -> tuple[Fastening, ...]:
        """The trunk's screws, those of one length together; each through its longest sleeve."""
        longest = dict(sorted(zip(self.screw_lengths, self.sleeves, strict=True)))
        return tuple(
            Fastening(
                self.screw,
                self.screw_lengths.count(length),
                self.thickness + sleeve,
                f"plate on trunk{f', {1e3 * length:.0f} mm long' if len(longest) > 1 else ''}; "
                "longer if its thread begins deeper",
            )
            for length, sleeve in longest.items()
        )

    def net_width(self, across: FloatArray) -> FloatArray:
        """Width of one plate's sections at some y less screw holes and its windows [m]."""
        whole = 2.0 * self.shape.half_width(across)
        for middle in (self.across, -self.across):
            whole -= 2.0 * _chord(self.window, across - middle)
        for _, y in self.trunk:
            whole -= 2.0 * _chord(self.screw.clearance_hole / 2.0, across - y)
        return np.asarray(whole)

    def stress(self, mass: float, height: float) -> float:
        """Largest stress under `SHOCK` along any one axis, of bending or twisting [Pa].

        Down, a module bends the plate between the trunk's outermost screws and itself; sideways it
        bends the neck by its height as an arm; forward it twists the neck. Shear counts sqrt(3)
        times (von Mises). The ring under a foot is bent by what is down alone: the foot's base
        spreads the rest.

        Args:
            mass: of a module [kg].
            height: of the module's middle above the plate [m].
        """
        if len(self.rows) > 1:
            return max(plate.stress(mass, height) for plate in self.each)
        start = max(y for _, y in self.trunk)
        across = np.linspace(start, self.across, _SECTIONS)
        widths, arms = self.net_width(across), self.across - across
        down = max(
            bending_stress(mass, arm, width, self.thickness)
            for arm, width in zip(arms.tolist(), widths.tolist(), strict=True)
        )
        narrow = float(widths[arms >= self.window].min(initial=widths[0]))
        sideways = bending_stress(mass, height, narrow, self.thickness)
        forward = twisting_stress(mass, height, narrow, self.thickness)
        return max(down, sideways, sqrt(3.0) * forward)

    def frequency(self, mass: float) -> float:
        """First mode of a module up and down on its plate, the trunk's screws held [Hz].

        Mohr's integral of the cantilever from the outermost screws to the middle of the foot, whose
        sections are those of `net_width`; the module is a point, the plate weighs nothing.

        Args:
            mass: of a module [kg].
        """
        if len(self.rows) > 1:
            return min(plate.frequency(mass) for plate in self.each)
        start = max(y for _, y in self.trunk)
        across = np.linspace(start, self.across, _SECTIONS)
        second = self.net_width(across) * self.thickness**3 / 12.0
        arms = self.across - across
        compliance = np.trapezoid(arms**2 / (MODULUS * second), across)
        return float(1.0 / np.sqrt(compliance * mass) / (2.0 * pi))

    @property
    def mass(self) -> float:
        """Mass of plate, sleeves and the trunk's screws [kg]."""
        return sum(body.mass for body in self._bodies())

    def mass_properties(self) -> MassProperties:
        """Mass properties of plate, sleeves and the trunk's screws in B."""
        return self.own_mass_properties().moved(np.eye(3), np.array(self.position))

    def own_mass_properties(self) -> MassProperties:
        """Mass properties of plate, sleeves and the trunk's screws in its own frame."""
        return combine(self._bodies())

    def _bodies(self) -> Iterator[MassProperties]:
        """Mass properties of everything in the plate's own frame, screws as points."""
        yield plate_part(self).mass_properties()
        for (x, y), sleeve, length in zip(
            self.trunk, self.sleeves, self.screw_lengths, strict=True
        ):
            here = np.array([x, y, 0.0])
            if sleeve > 0.0:
                yield sleeve_part(self, sleeve).mass_properties().moved(np.eye(3), here)
            up = np.array([0.0, 0.0, self.thickness - self.screw.centre(length)])
            yield MassProperties(self.screw.mass(length), here + up, np.zeros((3, 3)))


def _chord(radius: float, off: FloatArray) -> FloatArray:
    """Half the chord of a circle so far off its middle [m]."""
    return np.asarray(np.sqrt(np.maximum(0.0, radius**2 - off**2)))


def plate_part(plate: CarrierPlate) -> Part[float]:
    """The plate, or all plates in their places, with its holes, in its own frame."""
    kinds = (
        (plate.feet, screw(plate.foot_thread).tapping_drill),
        (plate.trunk, plate.screw.clearance_hole),
    )
    holes = [
        Prism(Disc(diameter / 2.0, place), 0.0, plate.thickness)
        for places, diameter in kinds
        for place in places
    ]
    if plate.window > 0.0:
        holes += [
            Prism(Disc(plate.window, (row, side * plate.across)), 0.0, plate.thickness)
            for row in plate.rows
            for side in (1.0, -1.0)
        ]
    solids = tuple(Prism(shape, 0.0, plate.thickness) for shape in plate.shapes)
    return Part("plate", plate.density, solids, tuple(holes))


def sleeve_part(plate: CarrierPlate, length: float) -> Part[float]:
    """A sleeve of that length, its upper end at the origin."""
    bore = plate.screw.clearance_hole / 2.0
    return Part(
        "sleeve", plate.density, (hollow_cylinder(bore, plate.sleeve_radius, -length, 0.0),)
    )
