"""The carrier plate: what the feet stand on where the trunk is too narrow or too curved for them.

One flat plate of aluminium across the trunk: a ring under each foot, around the circle of its
screws, whose threads are in it, and from its middle an arm to each ring. A pair's arms are one
neck; three and more are a star. Two screws in each arm hold it on the trunk, each through a sleeve
where the trunk lies lower there. Its axes are those of the base frame B, its origin the middle of
its underside. Several pairs of modules, one behind the other, have as many equal plates at one
height, each with screws of its own; together they are one body.

Where nothing stands on top of the trunk, a mast carries the plates behind it, one above the other:
a square tube upright on its back, with an arm of the same tube under each plate. Four screws
through the tube hold it, each in a sleeve that keeps the walls apart.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import acos, asin, hypot, inf, pi, sin, sqrt, tan
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.fasteners import Fastening, Screw, screw
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.joints import pattern_use
from ocs_design.parts.moments import MassMoments
from ocs_design.parts.outline import Outline
from ocs_design.parts.part import Part
from ocs_design.parts.printed import SHOCK
from ocs_design.parts.shapes import Disc, Rectangle, flat
from ocs_design.parts.solids import Prism, hollow_cylinder
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.robot.tree import BACKWARDS, Placement

MATERIAL, DENSITY, YIELD_STRENGTH = "aluminium-6061-t6", 2710.0, 255e6
"""Name in the catalogue of materials, density [kg/m^3], yield strength [Pa]: Hibbeler, Mechanics
of Materials, Appendix C."""

MODULUS = 69e9
"""Modulus of 6061 [Pa], as in the catalogue of materials."""

STOCK = (3.0e-3, 4.0e-3, 5.0e-3, 6.0e-3, 8.0e-3, 10.0e-3, 12.0e-3, 15.0e-3, 20.0e-3)
"""Thicknesses of rolled plate, EN 485-4 sizes that are kept in stock [m]."""

SAFETY = 2.0
"""Least ratio of yield strength to bending stress."""

SLEEVE_WALL = 2.0e-3
"""Wall of a sleeve around its screw [m]: 7.4 mm outside for M3, wider than the screw's head."""

POST_DEPTH = 1.9
"""Depth of the threads of posts over their diameter, at least: aluminium then bears all of M8's
preload with half of what strips it."""

EDGE = 1.5
"""Least distance of a hole's middle from an edge, over its diameter: EN 1993-1-8, table 3.3, asks
for 1.2."""

MAST_YIELD = 115e6 / 1.25
"""Of 6061-T6 beside a weld, over the partial factor of joints [Pa]: f_o,haz of EN 1999-1-1, table
3.2b, and table 8.1."""

TUBES = (
    (0.025, 2.0e-3),
    (0.03, 2.0e-3),
    (0.04, 2.0e-3),
    (0.04, 3.0e-3),
    (0.05, 3.0e-3),
    (0.05, 4.0e-3),
    (0.06, 4.0e-3),
    (0.08, 4.0e-3),
    (0.1, 5.0e-3),
)
"""Sides and walls of square tube that is kept in stock [m]; tolerances: EN 755-8."""

_SECTIONS = 101
"""Sections between a screw and the middle of a foot whose stress is looked at."""

Point: TypeAlias = tuple[float, float]

Lengths: TypeAlias = float | FloatArray

Hole = TypeVar("Hole", Point, float)


FILLET = 10.0e-3
"""Radius between neck and ends [m], or what there is room for: a cutter's, and no sharp notch."""


def directions(arms: int) -> FloatArray:
    """Unit vectors along so many arms, evenly around, the first one to the left, shape (n, 2)."""
    angles = 2.0 * pi * np.arange(arms) / arms
    # No sine of half a turn leaves rounding errors in the files.
    return np.round(np.stack([-np.sin(angles), np.cos(angles)], axis=1), 15) + 0.0


def bending_stress(mass: float, arm: Lengths, width: Lengths, thickness: Lengths) -> FloatArray:
    """Stress in a plate that carries a mass at the end of a cantilever, under `SHOCK` [Pa].

    M = m a L and sigma = 6 M / (w t^2): Roark's Formulas for Stress and Strain, 7th edition, table
    8.1, case 1a, with the section modulus of a rectangle.

    Args:
        mass: of what it carries [kg].
        arm: from its support to the mass [m].
        width, thickness: of the section, less its holes [m].
    """
    return np.asarray(6.0 * mass * SHOCK * arm / (width * thickness**2))


def twisting_stress(mass: float, arm: float, width: float, thickness: Lengths) -> FloatArray:
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
    return np.asarray(3.0 * mass * SHOCK * arm / (width * thickness**2) * series)


@dataclass(frozen=True)
class DogBone:
    """Discs evenly around a middle, with a neck from there to each, rounded where they meet.

    Two have one neck between them, along y. With a neck as wide as the discs it is a rectangle with
    half a disc at either end.

    Attributes:
        radius: of the discs [m].
        half_length: from the middle to any end, that of the first disc along y [m].
        neck: half of a neck's width, at most the radius [m].
        x: of its middle [m].
        arms: how many discs there are, two or more.
    """

    radius: float
    half_length: float
    neck: float
    x: float = 0.0
    arms: int = 2

    @property
    def across(self) -> float:
        """Distance of any disc's middle from its own [m]."""
        return self.half_length - self.radius

    @property
    def hub(self) -> float:
        """How far along an arm its sides are those of the next ones [m]; 0: of two, in line."""
        return 0.0 if self.arms == 2 else self.neck / tan(pi / self.arms)

    @property
    def fits(self) -> bool:
        """Whether discs are clear of each other, and a neck is seen between them."""
        return min(self.across * sin(pi / self.arms), self.across - self.hub) >= self.radius

    @property
    def fillet(self) -> float:
        """Radius of the rounding, so that two of them have room on either side [m]."""
        beyond = self.radius - self.neck
        if beyond <= 0.0:
            return FILLET
        room = (self.across - self.hub) ** 2 - self.radius**2 + self.neck**2
        return min(FILLET, 0.95 * room / (2.0 * beyond))

    @property
    def straight(self) -> float:
        """Distance from the middle at which the neck's straight sides end [m]."""
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
        """Moments about the origin, of unit density: about its middle those of half an arm's.

        int x dy, int x^3 / 3 dy and int x y^2 dy along the hub, x = w y / h, along the neck, x = w,
        along the rounding, x = w + f - q(s) with s = y - y_0, and along the disc, x = q(s) with s =
        y - c; see `_Circle`.
        """
        w, f, r, c, low = self.neck, self.fillet, self.radius, self.across, self.straight
        _, top = self.meets
        h = self.hub
        area, cubes, second = w * (low - h / 2.0), w**3 * (low - 0.75 * h), w * low**3 / 3.0
        second -= w * h**3 / 12.0
        # The rounding: of its tangent's distance less a circle.
        a, end, gone = w + f, top - low, _Circle(f, 0.0, top - low)
        area += a * end - gone.one
        cubes += a**3 * end - 3.0 * a**2 * gone.one - gone.cube
        cubes += 3.0 * a * (f**2 * end - end**3 / 3.0)
        second += a * ((low + end) ** 3 - low**3) / 3.0 - gone.about(low)
        disc = _Circle(r, top - c, r)
        area, cubes, second = area + disc.one, cubes + disc.cube, second + disc.about(c)
        around = flat(2.0 * area, 2.0 / 3.0 * cubes, 2.0 * second).around(self.arms)
        return around.moved(self.x, 0.0, 0.0)

    def outline(self) -> Outline:
        """The necks' sides, and the discs between their roundings."""
        (x, y), low, middle = self.meets, self.straight, np.array([self.x, 0.0])
        # The right side of the first arm, seen from the middle, and its disc up to the left side.
        right, bulges = [[self.neck, low]], [1.0]
        if self.neck < self.radius:
            angle = acos((self.neck + self.fillet) / (self.radius + self.fillet))
            inward, around = -tan(angle / 4.0), tan((pi + 2.0 * angle) / 4.0)
            right, bulges = [[self.neck, low], [x, y]], [inward, around, inward]
        arm, bulges = [*right, *([-off, along] for off, along in reversed(right))], [*bulges, 0.0]
        if self.arms > 2:
            # The corner that it shares with the next arm.
            arm, bulges = [*arm, [-self.neck, self.hub]], [*bulges, 0.0]
        corners = [
            np.array(arm) @ np.array([[along, -off], [off, along]])
            for off, along in directions(self.arms)
        ]
        return Outline(np.concatenate(corners) + middle, np.array(bulges * self.arms))

    def holds(self, points: FloatArray) -> NDArray[np.bool_]:
        """Whether points are within it, shape (n,); those are x and y [m], shape (n, 2)."""
        found = np.zeros(len(points), dtype=bool)
        for off, along in directions(self.arms):
            out, aside = np.array([[off, along], [along, -off]]) @ (points - [self.x, 0.0]).T
            found |= (out >= 0.0) & (np.abs(aside) <= self.half_width(out))
        return found

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
class Mast:
    """Square tube upright on the trunk's back, with an arm of it backwards under each plate.

    Attributes:
        side: of the tube, outside [m]. wall: of the tube [m].
        face: x of the upright's side on the trunk, in the plate's frame [m].
        below, high: how far its ends are below and above the origin, likewise [m].
        overhang: farthest that an arm is above or below the trunk's screws [m].
        spacer: thickness of the block between the upright and the trunk, around the screws [m].
    """

    side: float
    wall: float
    face: float
    below: float
    high: float
    overhang: float
    spacer: float = 0.0

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
        """Stress of the tube under two moments [N m], of von Mises [Pa].

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
        radius, half_length, neck: of its outline; see `DogBone` [m].
        thickness: [m].
        across: of the middle of each foot from its own, the first one's along y [m].
        window: radius of the hole under each foot, 0: none [m].
        feet: of the holes with threads for the feet's screws, x and y from its middle, as many for
            each plate, one plate after the other [m].
        trunk: of the holes for the trunk's screws, likewise; those of a mast, y and z [m].
        sleeves: length of the sleeve under each of those, 0: none [m].
        thread, foot_thread: of both kinds of screws.
        material: name. density: [kg/m^3].
        rows: forward coordinate of the middle of each plate from the common one [m].
        levels: height of the underside of each, likewise; empty: 0 [m].
        mast: that carries them; None: the trunk does.
        arms: of each plate, as many as feet on it.
        sleeve_wall: of its sleeves around their screws [m].
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
    levels: tuple[float, ...] = ()
    mast: Mast | None = None
    arms: int = 2
    sleeve_wall: float = SLEEVE_WALL

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
    def each(self) -> tuple["CarrierPlate", ...]:
        """Every plate on its own, with the screws that are its own."""
        x, y, z = self.position
        trunk = () if self.mast else self.trunk
        sleeves = () if self.mast else self.sleeves
        return tuple(
            replace(
                self,
                position=(x + row, y, z + level),
                feet=tuple((along - row, across) for along, across in self.own(self.feet, index)),
                trunk=tuple((along - row, across) for along, across in self.own(trunk, index)),
                sleeves=self.own(sleeves, index),
                rows=(0.0,),
                levels=(),
            )
            for index, (row, level) in enumerate(zip(self.rows, self.heights, strict=True))
        )

    @property
    def heights(self) -> tuple[float, ...]:
        """Height of the underside of each plate above the common one [m]."""
        return self.levels or (0.0,) * len(self.rows)

    @property
    def screw_places(self) -> tuple[Placement, ...]:
        """Frames of the trunk's screws in its own, z away from the trunk, above their sleeves."""
        if self.mast is None:
            return tuple(Placement(np.eye(3), np.array([x, y, 0.0])) for x, y in self.trunk)
        front = self.mast.face + self.mast.spacer
        return tuple(Placement(BACKWARDS, np.array([front, y, z])) for y, z in self.trunk)

    @property
    def clamped(self) -> float:
        """What the trunk's screws go through behind their sleeves [m]."""
        return self.thickness if self.mast is None else self.mast.side + self.mast.spacer

    @property
    def block(self) -> tuple[float, float]:
        """Lower and upper end of a mast's block around its screws, in its own frame [m]."""
        edge = EDGE * self.screw.clearance_hole
        return min(z for _, z in self.trunk) - edge, max(z for _, z in self.trunk) + edge

    def own(self, holes: tuple[Hole, ...], index: int) -> tuple[Hole, ...]:
        """What of the holes of all plates is of one."""
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
            self.screw.length_through(self.clamped + each, self.thread_depth)
            for each in self.sleeves
        )

    @property
    def thread_depth(self) -> float:
        """Depth of the trunk's threads over their diameter, at least."""
        return POST_DEPTH if self.sleeve_wall > SLEEVE_WALL else 1.0

    @property
    def fastenings(self) -> tuple[Fastening, ...]:
        """The trunk's screws, those of one length together; each through its longest sleeve."""
        longest = dict(sorted(zip(self.screw_lengths, self.sleeves, strict=True)))
        return tuple(
            Fastening(
                self.screw,
                self.screw_lengths.count(length),
                self.clamped + sleeve,
                f"{'plate' if self.mast is None else 'mast'} on trunk"
                f"{f', {1e3 * length:.0f} mm long' if len(longest) > 1 else ''}; "
                "longer if its thread begins deeper",
                self.thread_depth,
            )
            for length, sleeve in longest.items()
        )

    def net_width(self, across: FloatArray) -> FloatArray:
        """Width of one plate's sections at some y less screw holes and its windows [m]."""
        whole = 2.0 * self.shape.half_width(across)
        for middle in (self.across, -self.across):
            whole -= 2.0 * _chord(self.window, across - middle)
        for _, y in () if self.mast else self.trunk:
            whole -= 2.0 * _chord(self.screw.clearance_hole / 2.0, across - y)
        return np.asarray(whole)

    @property
    def support(self) -> float:
        """How far from the middle it is held last along y [m]: by screws, or by its arm."""
        return self.mast.side / 2.0 if self.mast else max(y for _, y in self.trunk)

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
        return float(self.stresses(np.array([self.thickness]), mass, height)[0])

    def stresses(self, thicknesses: FloatArray, mass: float, height: float) -> FloatArray:
        """Largest stress of plates of this outline of some thicknesses [Pa]; see `stress`.

        Args:
            thicknesses: [m], shape (n,). mass, height: see `stress`.
        """
        if len(self.rows) > 1:
            # On a mast they are alike.
            distinct = self.each[:1] if self.mast else self.each
            each = [plate.stresses(thicknesses, mass, height) for plate in distinct]
            return np.asarray(np.max(each, axis=0))
        across = np.linspace(self.support, self.across, _SECTIONS)
        widths, arms = self.net_width(across), self.across - across
        down = bending_stress(mass, arms[:, None], widths[:, None], thicknesses).max(axis=0)
        narrow = float(widths[arms >= self.window].min(initial=widths[0]))
        sideways = bending_stress(mass, height, narrow, thicknesses)
        forward = twisting_stress(mass, height, narrow, thicknesses)
        return np.maximum(np.maximum(down, sideways), sqrt(3.0) * forward)

    def arm_stress(self, mass: float, height: float) -> float:
        """Largest stress of a mast by its arms, wherever its screws are, under `SHOCK` [Pa].

        A pair bends its arm, and twists it where it is pushed sideways; all arms bend or twist the
        upright.

        Args:
            mass, height: see `stress`.
        """
        mast = self.mast
        if mast is None:
            return 0.0
        force, up = 2.0 * mass * SHOCK, height + self.thickness + mast.side / 2.0
        turned = force * len(self.rows) * (mast.back + mast.side / 2.0)
        return max(
            mast.stress(force * max(mast.back, up), 0.0),
            mast.stress(force * mast.back, force * up),
            mast.stress(turned, 0.0),
        )

    def mast_stress(self, mass: float, height: float) -> float:
        """Largest stress of the mast under `SHOCK` along any one axis [Pa].

        Besides `arm_stress`, what is above or below the screws bends the upright, forward alone or
        sideways while the arms twist it.

        Args:
            mass, height: see `stress`.
        """
        mast = self.mast
        if mast is None:
            return 0.0
        wheels = [level + self.thickness + height for level in self.heights]
        top, bottom = max(z for _, z in self.trunk), min(z for _, z in self.trunk)
        force = 2.0 * mass * SHOCK
        beyond = force * sum(max(z - top, bottom - z, 0.0) for z in wheels)
        turned = force * len(wheels) * (mast.back + mast.side / 2.0)
        return max(self.arm_stress(mass, height), mast.stress(beyond, turned))

    def screws_use(self, mass: float, height: float) -> float:
        """Largest share of strength that `SHOCK` along any one axis takes of a mast's screws.

        See `pattern_use`; a push sideways bends sleeves between trunk and block by half of their
        length as well.

        Args:
            mass, height: see `stress`.
        """
        if self.mast is None:
            return 0.0
        force = 2.0 * mass * SHOCK * len(self.rows)
        y, z = np.array(self.trunk).T
        p, q = np.ptp(z) / 2.0, np.ptp(y) / 2.0
        up = abs(float(np.mean(self.heights)) + self.thickness + height - float(z.mean()))
        gap, (_, section, _) = max(self.sleeves), self.sleeve_section
        off = self.mast.face + self.mast.spacer + gap
        bent = force / 4.0 * (1.0 + up / hypot(p, q)) * gap / 2.0 / section
        used = float(pattern_use(self.screw, force, (off, np.asarray(up)), (p, q)))
        return max(used, bent / (YIELD_STRENGTH / SAFETY))

    def posts_use(self, mass: float, height: float) -> float:
        """Largest share of strength that `SHOCK` along any one axis takes of a pair's long sleeves.

        The ends of four posts under a plate cannot turn: a push F sideways bends each by F / 4
        times half its length. Its moment about the middle of their length pulls at two and presses
        on two; see `pattern_use` for their screws. No joint opens: pull and bending are less than
        what the screw's preload presses.

        Args:
            mass, height: see `stress`.
        """
        if len(self.rows) > 1:
            return max(plate.posts_use(mass, height) for plate in self.each)
        force, gap, (p, q) = 2.0 * mass * SHOCK, max(self.sleeves), self._half_pattern
        arm, (area, section, _) = gap / 2.0 + self.thickness + height, self.sleeve_section
        arms, half = (arm, np.asarray(0.0)), (np.asarray(p), np.asarray(q))
        stress = force / 4.0 * (arm / min(p, q) / area + gap / 2.0 / section)
        pressed = self.screw.preload / area
        return max(
            float(pattern_use(self.screw, force, arms, half)),
            stress / min(pressed, YIELD_STRENGTH / SAFETY),
            (stress + pressed) / YIELD_STRENGTH,
        )

    def sway(self, mass: float, height: float) -> float:
        """First mode of a pair sideways on its sleeves, whose ends cannot turn [Hz].

        Four of length l bend, by l^3 / (48 E I), and turn the plate about the middle of their
        length, as those of one side become longer and those of the other shorter: by the arm to
        there squared times l / (4 E (I + p^2 A)). The pair is a point.

        Args:
            mass, height: see `stress`.
        """
        if len(self.rows) > 1:
            return min(plate.sway(mass, height) for plate in self.each)
        gap, (area, _, second) = max(self.sleeves), self.sleeve_section
        arm, near = gap / 2.0 + self.thickness + height, min(self._half_pattern)
        turns = arm**2 * gap / (4.0 * (second + near**2 * area))
        compliance = (gap**3 / (48.0 * second) + turns) / MODULUS
        return float(1.0 / np.sqrt(2.0 * mass * compliance) / (2.0 * pi)) if gap else inf

    @property
    def _half_pattern(self) -> tuple[float, float]:
        """Half the distances of four screws, forward and sideways [m]."""
        along, across = np.ptp(np.array(self.trunk), axis=0) / 2.0
        return float(along), float(across)

    def frequency(self, mass: float) -> float:
        """First mode of a module up and down on its plate, the trunk's screws held [Hz].

        Mohr's integral of the cantilever from the outermost screws to the middle of the foot, whose
        sections are those of `net_width`; the module is a point, the plate weighs nothing.

        Args:
            mass: of a module [kg].
        """
        if len(self.rows) > 1:
            return min(plate.frequency(mass) for plate in self.each)
        start = self.support
        across = np.linspace(start, self.across, _SECTIONS)
        second = self.net_width(across) * self.thickness**3 / 12.0
        arms = self.across - across
        compliance = float(np.trapezoid(arms**2 / (MODULUS * second), across))
        if self.mast is not None:
            # The arm carries both: it bends, and turns the upright above or below its screws.
            arm, above = self.mast.back, self.mast.overhang
            bends = arm**3 / 3.0 + (arm + self.mast.side / 2.0) ** 2 * above
            compliance += 2.0 * bends / (MODULUS * self.mast.second_moment)
        return float(1.0 / np.sqrt(compliance * mass) / (2.0 * pi))

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
        return combine(self._bodies())

    def _bodies(self) -> Iterator[MassProperties]:
        """Mass properties of everything in the plate's own frame, screws as points."""
        for part, place in plate_bodies(self):
            yield part.mass_properties().moved(place.rotation, place.position)
        for place, length in zip(self.screw_places, self.screw_lengths, strict=True):
            up = np.array([0.0, 0.0, self.clamped - self.screw.centre(length)])
            at = place.rotation @ up + place.position
            yield MassProperties(self.screw.mass(length), at, np.zeros((3, 3)))


def _chord(radius: float, off: FloatArray) -> FloatArray:
    """Half the chord of a circle so far off its middle [m]."""
    return np.asarray(np.sqrt(np.maximum(0.0, radius**2 - off**2)))


def plate_bodies(plate: CarrierPlate) -> Iterator[tuple[Part[float], Placement]]:
    """Plates, mast and sleeves, each with its place in the plate's own frame."""
    here = Placement.identity()
    yield plate_part(plate), here
    if plate.mast is not None:
        yield mast_part(plate, plate.mast), here
    for place, length in zip(plate.screw_places, plate.sleeves, strict=True):
        if length > 0.0:
            yield sleeve_part(plate, length), place
        if plate.mast is not None:
            far = plate.clamped - plate.mast.wall
            inside = place @ Placement(np.eye(3), np.array([0.0, 0.0, far]))
            yield sleeve_part(plate, plate.mast.bore), inside


def plate_part(plate: CarrierPlate) -> Part[float]:
    """The plate, or all plates in their places, with its holes, in its own frame."""
    kinds = (
        (plate.feet, screw(plate.foot_thread).tapping_drill),
        (() if plate.mast else plate.trunk, plate.screw.clearance_hole),
    )
    solids, holes = [], []
    for index, (shape, low) in enumerate(zip(plate.shapes, plate.heights, strict=True)):
        high = low + plate.thickness
        solids.append(Prism(shape, low, high))
        holes += [
            Prism(Disc(diameter / 2.0, place), low, high)
            for places, diameter in kinds
            for place in plate.own(places, index)
        ]
        if plate.window > 0.0:
            holes += [
                Prism(Disc(plate.window, (shape.x + float(x), float(y))), low, high)
                for x, y in plate.across * directions(plate.arms)
            ]
    return Part("plate", plate.density, tuple(solids), tuple(holes))


def mast_part(plate: CarrierPlate, mast: Mast) -> Part[float]:
    """The mast's tubes, welded, with the holes for its screws, in the plate's frame."""
    half, bore = mast.side / 2.0, mast.side / 2.0 - mast.wall
    tube, inside = (Rectangle(-each, each, -each, each) for each in (half, bore))
    upright = Placement(np.eye(3), np.array([mast.face - half, 0.0, 0.0]))
    levels = [Placement(BACKWARDS, np.array([mast.back, 0.0, z - half])) for z in plate.heights]
    arm = mast.back + plate.neck
    solids = [Prism(tube, mast.low, mast.high, upright)]
    solids += [Prism(tube, 0.0, arm, level) for level in levels]
    holes = [Prism(inside, mast.low, mast.high, upright)]
    holes += [Prism(inside, 0.0, arm, level) for level in levels]
    walls = (0.0, mast.spacer + mast.wall), (plate.clamped - mast.wall, plate.clamped)
    if mast.spacer > 0.0:
        block = Rectangle(*plate.block, -half, half)
        front = Placement(BACKWARDS, np.array([mast.face + mast.spacer, 0.0, 0.0]))
        solids.append(Prism(block, 0.0, mast.spacer, front))
    drilled = Disc(plate.screw.clearance_hole / 2.0)
    holes += [
        Prism(drilled, low, high, place) for place in plate.screw_places for low, high in walls
    ]
    return Part("mast", plate.density, tuple(solids), tuple(holes))


def sleeve_part(plate: CarrierPlate, length: float) -> Part[float]:
    """A sleeve of that length, its upper end at the origin."""
    bore = plate.screw.clearance_hole / 2.0
    return Part(
        "sleeve", plate.density, (hollow_cylinder(bore, plate.sleeve_radius, -length, 0.0),)
    )
