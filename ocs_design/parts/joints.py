"""Joints of a wheel, as formulas: shrink fits, screws, shafts, bonds, balance."""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import ceil, floor, inf, pi

import numpy as np

from ocs_design.actuation.fasteners import CLASSES, USUAL_CLASS, Screw, screw
from ocs_design.actuation.motor import Mounting
from ocs_design.common.arrays import FloatArray
from ocs_design.parts.turning_rings import Ring, TurningRings

OVERSPEED = 1.2
"""Speed at which a wheel must hold, over the highest that it can get to."""

SERVICE = 1.5
"""Torque that a joint must carry, over the peak torque of its drive: it starts and stops hard."""

_NO_WALL = 1e-15
"""Least difference of the squares of two radii [m^2]."""

_ROUNDED = 1e-6
"""Share of a radius that rounding takes no more of."""

_HALVINGS = 40
"""Of an interval of radii, to rounding."""


# --- screws -----------------------------------------------------------------------------------

PRELOAD_SHARE = 0.75
"""Preload over proof load of a joint that is taken apart again: Shigley, equation 8-31."""

TIGHTENING_FACTOR = 1.6
"""Largest preload over the least that a torque wrench leaves: VDI 2230-1, table A8."""

FRICTION = 0.1
"""Least coefficient between dry, clean faces of steel and aluminium: VDI 2230-1, table A6."""

SHEAR_SHARE = 0.577
"""Shear strength over yield strength by distortion energy: Shigley, equation 5-21."""


def joint_preload(held: Screw, strength: str = USUAL_CLASS) -> float:
    """Force that a screw of a property class is tightened to, 0.75 of its proof load [N]."""
    return PRELOAD_SHARE * CLASSES[strength].proof * held.stress_area


def tightening_torque(held: Screw, strength: str = USUAL_CLASS) -> float:
    """Torque for that preload [N m]; see `Screw.torque`."""
    return held.torque(joint_preload(held, strength))


def friction_torque(held: Screw, count: int, radius: float, strength: str = USUAL_CLASS) -> float:
    """Torque that screws on a circle carry by friction under their least preload [N m].

    Args:
        held: each of them. count: of them. radius: of their circle [m].
        strength: their property class.
    """
    return FRICTION * count * joint_preload(held, strength) / TIGHTENING_FACTOR * radius


def shear_torque(held: Screw, count: int, radius: float, strength: str = USUAL_CLASS) -> float:
    """Torque at which their threads yield in shear, should the faces slip [N m]."""
    return SHEAR_SHARE * CLASSES[strength].yields * held.stress_area * count * radius


SCREW_TENSION, SCREW_SHEAR = 0.9 * 800e6 / 1.25, 0.6 * 800e6 / 1.25
"""Of screws of class 8.8 over their stress area [Pa]: EN 1993-1-8, table 3.4."""


def screw_use(held: Screw, tension: FloatArray, shear: FloatArray) -> FloatArray:
    """Share of a screw's strength that tension and shear take [N]: EN 1993-1-8, table 3.4.

    F_v / F_v,Rd + F_t / (1.4 F_t,Rd), and F_t / F_t,Rd at the least.
    """
    area = held.stress_area
    pulled, sheared = tension / (SCREW_TENSION * area), shear / (SCREW_SHEAR * area)
    return np.maximum(pulled, sheared + pulled / 1.4)


def pattern_use(
    held: Screw,
    force: float,
    arms: tuple[float, FloatArray],
    half: tuple[FloatArray, FloatArray],
    sheared: float | FloatArray = 0.0,
) -> FloatArray:
    """Largest share of strength that a force along any one axis takes of four screws.

    They stand at +-p above and +-q beside their middle: a moment pulls at two of them, and a push
    sideways shears them by itself and by its moment over 4 sqrt(p^2 + q^2).

    Args:
        held: the screws. force: on all that they hold [N].
        arms: of the force, off what they are in and above their middle [m]. half: p and q [m].
        sheared: what shears each besides, whatever the force [N].
    """
    (off, up), (p, q), share = arms, half, force / 4.0
    down = screw_use(held, share * off / p, np.asarray(share + sheared))
    forward = screw_use(held, share * (1.0 + up / p), np.asarray(sheared))
    sideways = screw_use(held, share * off / q, share * (1.0 + up / np.hypot(p, q)) + sheared)
    return np.maximum(np.maximum(down, forward), sideways)


# --- shafts -----------------------------------------------------------------------------------

BOND_STRENGTH = 25e6
"""Shear strength of a retaining compound on steel [Pa]: an assumption; what Loctite 638, which is
made for such joints, is sold with for pins and collars of ISO 10123, at least."""

BOND_SHARE = 0.5
"""Share of that: half is left at 80 deg C, on stainless steel and in wide gaps."""


def cylinder_torque(diameter: float, length: float, shear: float) -> float:
    """Torque of a shear stress on a shaft's surface, pi d L tau d / 2 [N m].

    tau is mu p in a press fit or clamp, and the strength of the compound in a bond. A bore that
    slides on has neither, and carries nothing.
    """
    return pi * diameter * length * shear * diameter / 2.0


def hub_joint(mounting: Mounting, bond_length: float) -> float | None:
    """Torque that a hub's joint on its motor carries [N m]; None: nothing that is known carries.

    Friction under the screws in the rotor's threads, as deep as they are, else a bond on the shaft.

    Args:
        mounting: of the motor.
        bond_length: of the hub's bore between its chamfers [m].
    """
    circle, shaft = mounting.rotor, mounting.shaft_diameter
    if circle is not None:
        whole = friction_torque(screw(circle.thread), circle.bolts, circle.radius, circle.screws)
        return circle.preload_share * whole
    return (
        None if shaft is None else cylinder_torque(shaft, bond_length, BOND_SHARE * BOND_STRENGTH)
    )


# --- bonds around bells -----------------------------------------------------------------------

EPOXY = "3M Scotch-Weld DP760"
"""A toughened two-part epoxy that cures at room temperature."""

EPOXY_STRENGTH = 24.1e6
"""Its overlap shear strength at 80 deg C, cured at 23 deg C for a week [Pa]: product data sheet,
3M, February 2009 (28.2 MPa at 23 deg C, 16.2 at 120; aluminium, etched, 0.15 mm of glue). Its
strength in tension, which the sheet does not have, is taken for no more."""

HOTTEST = 80.0
"""Temperature that a bond on a bell must hold at [deg C]; the other end is `COLDEST`."""

BELL_EXPANSION = 11.7e-6
"""Thermal expansion of a bell [1/K]: its straight part is the magnets' yoke, of low-carbon steel
(Callister, Materials Science and Engineering, 1020)."""


def bell_bond_tension(
    inner: float | FloatArray,
    outer: float | FloatArray,
    *,
    density: float | FloatArray,
    elastic_modulus: float | FloatArray,
    poisson_ratio: float | FloatArray,
    expansion: float | FloatArray,
    speed: float | FloatArray,
) -> FloatArray:
    """Most that a bond around a bell is pulled by a ring that turns, cold or warm [Pa].

    The bell counts as rigid: whatever it grows by itself, and gives way, takes from the pull. The
    ring's constants A and B follow from no displacement at its bore and no stress at its edge, and
    a ring whose bore has to give way by a strain e is pulled with
    E e / ((R^2 + r^2) / (R^2 - r^2) + nu).

    Args:
        inner, outer: radii [m].
        density, elastic_modulus, poisson_ratio: of the ring; a modulus of 0 leaves temperature out.
        expansion: of it [1/K].
        speed: [rad/s].
    """
    inner, outer = np.asarray(inner), np.asarray(outer)
    nu, load = poisson_ratio, density * speed**2 / 8.0
    stiff = 1.0 / ((1.0 - nu) * inner**2) + 1.0 / ((1.0 + nu) * outer**2)
    of_b = load * ((1.0 + nu) * inner**2 - (3.0 + nu) * outer**2) / stiff
    of_a = (1.0 - nu**2) * load * inner**2 - of_b / inner**2
    spun = of_a / (1.0 - nu) - of_b / ((1.0 + nu) * inner**2) - (3.0 + nu) * load * inner**2
    apart = expansion - BELL_EXPANSION
    strain = np.maximum(apart * (HOTTEST - MADE), apart * (COLDEST - MADE))
    give = (outer**2 + inner**2) / np.maximum(outer**2 - inner**2, _NO_WALL) + nu
    return np.asarray(spun + elastic_modulus * strain / give)


def bell_bond_radius(bore: FloatArray, most: float, **ring: FloatArray) -> FloatArray:
    """Largest outer radius, up to `most` [m], of rings whose bond holds; the bore where none does.

    Args:
        bore: radius [m]. most: [m]. ring: see `bell_bond_tension`.
    """
    low, high = bore, np.maximum(bore, most)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        holds = bell_bond_tension(bore, middle, **ring) <= BOND_SHARE * EPOXY_STRENGTH
        low, high = np.where(holds, middle, low), np.where(holds, high, middle)
    return low * (1.0 - _ROUNDED)


# --- balance ----------------------------------------------------------------------------------

GRADE = 6.3
"""Balance quality grade of flywheels [mm/s]: ISO 21940-11, table 1."""

_STEPS_MM = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000)
"""Upper ends of the steps of nominal sizes [mm]: ISO 286-1, table 1."""


class Grade(Enum):
    """Widths of the tolerance interval over the steps of nominal sizes [um]: ISO 286-1, table 1."""

    IT6 = (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40, 44, 50, 56)
    IT7 = (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63, 70, 80, 90)
    IT9 = (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155, 175, 200, 230)
    IT11 = (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400, 440, 500, 560)
    IT12 = (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630, 700, 800, 900)
    IT15 = (
        *(400, 480, 580, 700, 840, 1000, 1200, 1400, 1600),
        *(1850, 2100, 2300, 2500, 2800, 3200, 3600),
    )


def tolerance_width(size: float, grade: Grade) -> float:
    """Width of the tolerance interval of a nominal size [m]; sizes above 1 m as 1 m."""
    step = bisect_left(_STEPS_MM, round(1e3 * size, 9))
    return 1e-6 * grade.value[min(step, len(_STEPS_MM) - 1)]


def slip_fit_eccentricity(diameter: float) -> float:
    """Distance that an H7/h6 fit may be off centre: half of its largest play [m]."""
    return (tolerance_width(diameter, Grade.IT7) + tolerance_width(diameter, Grade.IT6)) / 2.0


CORRECTION_HOLE = 0.8e-3
"""Radius of holes that take an unbalance away, at most [m]."""


@dataclass(frozen=True)
class Correction:
    """Holes in a rim's faces, on its middle radius, that take an unbalance away.

    They are drilled where balancing asks for them, one opposite the other in both faces.

    Attributes:
        radius: that they are on [m].
        hole_radius, depth: of each [m]; 0: there is no room for any.
        mass: that a pair of them takes [kg].
        apart: distance of neighbours [m].
        count: pairs that have room on one half of the rim.
        most: largest unbalance that these take [kg m].
    """

    radius: float
    hole_radius: float
    depth: float
    mass: float
    apart: float
    count: int
    most: float


def correction(
    inner: float, outer: float, height: float, density: float, *, chamfer: float, ligament: float
) -> Correction:
    """Largest correction that holes in a rim can make, drilled to tenths of a millimetre.

    Args:
        inner, outer, height, density: of the rim [m], [kg/m^3].
        chamfer: of its edges [m].
        ligament: material between holes, to edges and between their bottoms [m].
    """
    middle = (inner + outer) / 2.0
    beside = (outer - inner) / 2.0 - chamfer - ligament
    # Narrower ones where the wall asks for them.
    hole = _whole(max(min(CORRECTION_HOLE, beside), 0.0), 0.05e-3)
    depth = _whole(max((height - ligament) / 2.0, 0.0), 0.1e-3)
    if hole == 0.0 or depth == 0.0:
        return Correction(middle, 0.0, 0.0, 0.0, 0.0, 0, 0.0)
    mass = 2.0 * pi * hole**2 * depth * density
    apart = 2.0 * hole + ligament
    step = apart / middle
    count = max(floor(pi / step), 1)
    angles = step * (np.arange(count) - (count - 1) / 2.0)
    most = float(mass * middle * np.cos(angles).sum())
    return Correction(middle, hole, depth, mass, apart, count, most)


def _whole(length: float, step: float) -> float:
    """A length cut to whole steps [m]."""
    return step * floor(length / step + 1e-6)


# --- shrink fits ------------------------------------------------------------------------------

COLDEST, MADE, WARMEST = -10.0, 20.0, 50.0
"""Temperatures that a shrink fit must hold at, and the one that it is made at [deg C]."""


SEAT_ROUGHNESS = 1.6e-6
"""Arithmetic mean height Ra of both seats of a shrink fit, as they are drawn [m]."""

_TURNED = 4.0
"""Greatest height Rz over Ra of a triangular profile, as turning leaves."""

SMOOTHING = 0.8 * 2.0 * _TURNED * SEAT_ROUGHNESS
"""Interference on the diameter that is lost as the peaks of both seats are smoothed,
0.8 (Rz_i + Rz_a) [m]: DIN 7190-1:2017."""


@dataclass(frozen=True)
class ShrinkFit:
    """A rim on a web of another material.

    Attributes:
        least, most: radial interference at `MADE`, before smoothing [m].
        torque: that friction carries at the least pressure: at the least interference less
            `SMOOTHING`, turning or not, cold or warm [N m].
        stress_web, stress_rim: largest, at the largest interference [Pa].
        squeezed: largest pressure on the web [Pa].
        buckling: pressure at which the web buckles [Pa].
    """

    least: float
    most: float
    torque: float
    stress_web: float
    stress_rim: float
    squeezed: float
    buckling: float


_BUCKLING = 14.68
"""Of a full plate with a clamped edge, N = 14.68 D / a^2: Timoshenko and Gere, Theory of Elastic
Stability, 2nd ed., section 9.1. The rim holds the web's edge, its hub stiffens the middle."""


def shrink_fit(
    rings: Sequence[Ring],
    expansions: tuple[float, float],
    speed: float,
    torque: float,
    *,
    holes: float | None = None,
) -> ShrinkFit:
    """The loosest shrink fit that holds at that speed and at rest, cold and warm.

    Web and rim grow by their expansions; bore and web are made to grade 6 each. Interferences are
    whole micrometres across, as they are drawn. Smoothing counts where the fit must hold, and not
    where it must not yield or buckle.

    Args:
        rings: hub, web and rim, or web and rim.
        expansions: of web and rim [1/K].
        speed: that it holds at [rad/s].
        torque: that it carries at least [N m].
        holes: radius of the circle of the hub's screws [m]; None: it has none.
    """
    web = rings[-2]
    radius, joint = web.outer, len(rings) - 2
    per_pressure = cylinder_torque(2.0 * radius, web.thickness, FRICTION)
    grown = [(expansions[0] - expansions[1]) * (at - MADE) * radius for at in (COLDEST, WARMEST)]

    def turning(interference: float, at: float) -> TurningRings:
        """Rings with this interference at the joint [m], at this speed [rad/s]."""
        return TurningRings.of(rings, at, [0.0] * joint + [interference])

    # Pressure is linear in the interference.
    per_interference = turning(1e-6, 0.0).pressure(joint) / 1e-6
    loosest = min(turning(shift, at).pressure(joint) for shift in grown for at in (0.0, speed))
    effective = (torque / per_pressure - loosest) / per_interference
    least = ceil(1e6 * (2.0 * effective + SMOOTHING) - 1e-6) / 2e6
    most = least + tolerance_width(2.0 * radius, Grade.IT6)
    states = [turning(most + shift, at) for shift in grown for at in (0.0, speed)]
    inside = [state.peak(ring) for state in states for ring in range(joint + 1)]
    if holes is not None:
        inside += [state.peak_at_hole(0, holes) for state in states]
    stiffness = web.elastic_modulus * web.thickness**3 / (12.0 * (1.0 - web.poisson_ratio**2))
    return ShrinkFit(
        least=least,
        most=most,
        torque=per_pressure * (loosest + per_interference * (least - SMOOTHING / 2.0)),
        stress_web=max(inside),
        stress_rim=max(state.peak(joint + 1) for state in states),
        squeezed=max(state.pressure(joint) for state in states),
        buckling=_BUCKLING * stiffness / (radius**2 * web.thickness) if radius > 0.0 else inf,
    )
