"""Formulas for the joints of a wheel: shrink fits, screws, shafts, bonds, balance."""

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
"""Speed at which a wheel must hold, over the highest that it can reach."""

SERVICE = 1.5
"""Torque that a joint must carry, over the peak torque of its drive: it starts and stops hard."""

_NO_WALL = 1e-15
"""Least difference of the squares of two radii [m^2]."""

_ROUNDED = 1e-6
"""Share of a radius that exceeds rounding."""

_HALVINGS = 40
"""Number of halvings that reduce an interval of radii to rounding."""


# --- screws -----------------------------------------------------------------------------------

PRELOAD_SHARE = 0.75
"""Preload over proof load of a joint with reused fasteners: Shigley, equation 8-31."""

TIGHTENING_FACTOR = 1.6
"""Largest preload over the smallest, tightened with a torque wrench: VDI 2230-1, table A8."""

FRICTION = 0.1
"""Least friction coefficient between dry, clean steel and aluminium: VDI 2230-1, table A6."""

SHEAR_SHARE = 0.577
"""Shear strength over yield strength by distortion energy: Shigley, equation 5-21."""


def joint_preload(screw: Screw, strength: str = USUAL_CLASS) -> float:
    """Preload of a screw of a property class, 0.75 of its proof load [N]."""
    return PRELOAD_SHARE * CLASSES[strength].proof * screw.stress_area


def tightening_torque(screw: Screw, strength: str = USUAL_CLASS) -> float:
    """Tightening torque for `joint_preload` [N m]; see `Screw.torque`."""
    return screw.torque(joint_preload(screw, strength))


def friction_torque(screw: Screw, count: int, radius: float, strength: str = USUAL_CLASS) -> float:
    """Torque that screws on a circle carry by friction under their least preload [N m].

    Args:
        screw: the screw. count: of screws. radius: of their circle [m].
        strength: their property class.
    """
    return FRICTION * count * joint_preload(screw, strength) / TIGHTENING_FACTOR * radius


def shear_torque(screw: Screw, count: int, radius: float, strength: str = USUAL_CLASS) -> float:
    """Torque at which screws on a circle yield in shear, if the faces slip [N m]."""
    return SHEAR_SHARE * CLASSES[strength].yields * screw.stress_area * count * radius


SCREW_TENSION, SCREW_SHEAR = 0.9 * 800e6 / 1.25, 0.6 * 800e6 / 1.25
"""Strength of class 8.8 screws over their stress area [Pa]: EN 1993-1-8, table 3.4."""


def screw_use(screw: Screw, tension: FloatArray, shear: FloatArray) -> FloatArray:
    """Share of a screw's strength used by tension and shear [N]: EN 1993-1-8, table 3.4.

    F_v / F_v,Rd + F_t / (1.4 F_t,Rd), but at least F_t / F_t,Rd.
    """
    area = screw.stress_area
    pulled, sheared = tension / (SCREW_TENSION * area), shear / (SCREW_SHEAR * area)
    return np.maximum(pulled, sheared + pulled / 1.4)


def pattern_use(
    held: Screw,
    force: float,
    arms: tuple[float, FloatArray],
    half: tuple[FloatArray, FloatArray],
    sheared: float | FloatArray = 0.0,
) -> FloatArray:
    """Largest share of strength used in four screws by a force along any one axis.

    They are at +-p above and +-q beside their middle: a moment pulls at two of them, and a push
    sideways shears them by itself and by its moment over 4 sqrt(p^2 + q^2).

    Args:
        held: the screws. force: on everything that they hold [N].
        arms: of the force, from the face that they are in and above their middle [m].
        half: p and q [m].
        sheared: additional shear force on each, whatever the force [N].
    """
    (off, up), (p, q), share = arms, half, force / 4.0
    down = screw_use(held, share * off / p, np.asarray(share + sheared))
    forward = screw_use(held, share * (1.0 + up / p), np.asarray(sheared))
    sideways = screw_use(held, share * off / q, share * (1.0 + up / np.hypot(p, q)) + sheared)
    return np.maximum(np.maximum(down, forward), sideways)


# --- shafts -----------------------------------------------------------------------------------

BOND_STRENGTH = 25e6
"""Shear strength of a retaining compound on steel [Pa]: an assumption, the least value quoted for
Loctite 638, made for such joints, on pins and collars of ISO 10123."""

BOND_SHARE = 0.5
"""Usable share of a bond's strength: half remains at 80 deg C, on stainless steel, in wide gaps."""


def cylinder_torque(diameter: float, length: float, shear: float) -> float:
    """Torque of a shear stress on a shaft's surface, pi d L tau d / 2 [N m].

    tau is mu p in a press fit or clamp, and the strength of the compound in a bond. A sliding fit
    has neither, and carries nothing.
    """
    return pi * diameter * length * shear * diameter / 2.0


def hub_joint(mounting: Mounting, bond_length: float) -> float | None:
    """Torque that a hub's joint on its motor carries [N m]; None: no joint is known.

    Friction under the screws in the rotor's threads, allowing for their depth; otherwise a bond on
    the shaft.

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
"""Epoxy of the bond: toughened, two-part, cures at room temperature."""

EPOXY_STRENGTH = 24.1e6
"""Its overlap shear strength at 80 deg C, cured at 23 deg C for a week [Pa]: product data sheet,
3M, February 2009 (28.2 MPa at 23 deg C, 16.2 at 120; etched aluminium, 0.15 mm of glue). The sheet
has no tensile strength, which is assumed to be no higher."""

HOTTEST = 80.0
"""Temperature that a bond on a bell must hold at [deg C]; the other end is `COLDEST`."""

BELL_EXPANSION = 11.7e-6
"""Thermal expansion of a bell [1/K]: its straight part is the magnets' yoke, of low-carbon steel
(Callister, Materials Science and Engineering, steel 1020)."""


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
    """Largest tension in the bond between a bell and a spinning ring, cold or warm [Pa].

    The bell counts as rigid: its own growth and its compliance would reduce the tension. The ring's
    constants A and B follow from zero displacement at its bore and zero stress at its outer edge. A
    bore forced by a strain e adds the tension E e / ((R^2 + r^2) / (R^2 - r^2) + nu).

    Args:
        inner, outer: radii [m].
        density, elastic_modulus, poisson_ratio: of the ring; a modulus of 0 leaves temperature out.
        expansion: of the ring [1/K].
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


def bell_bond_radius(bore: FloatArray, radius_max: float, **ring: FloatArray) -> FloatArray:
    """Largest outer radius, up to `radius_max` [m], of rings whose bond holds, else the bore.

    Args:
        bore: radius [m]. radius_max: [m]. ring: see `bell_bond_tension`.
    """
    low, high = bore, np.maximum(bore, radius_max)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        holds = bell_bond_tension(bore, middle, **ring) <= BOND_SHARE * EPOXY_STRENGTH
        low, high = np.where(holds, middle, low), np.where(holds, high, middle)
    return low * (1.0 - _ROUNDED)


# --- balance ----------------------------------------------------------------------------------

GRADE = 6.3
"""Balance quality grade of flywheels [mm/s]: ISO 21940-11, table 1."""

_STEPS_MM = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000)
"""Upper limits of the ranges of nominal sizes [mm]: ISO 286-1, table 1."""


class Grade(Enum):
    """Tolerance width in each range of nominal sizes [um]: ISO 286-1, table 1."""

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
    """Largest eccentricity of an H7/h6 fit: half of its largest play [m]."""
    return (tolerance_width(diameter, Grade.IT7) + tolerance_width(diameter, Grade.IT6)) / 2.0


CORRECTION_HOLE = 0.8e-3
"""Largest radius of holes that correct an unbalance [m]."""


@dataclass(frozen=True)
class Correction:
    """Holes in a rim's faces, on its middle radius, that correct an unbalance.

    They are drilled where balancing requires them, in pairs, opposite each other in both faces.

    Attributes:
        radius: of the circle of their middles [m].
        hole_radius, depth: of each [m]; 0: there is no room for any.
        mass: removed by a pair [kg].
        apart: distance between neighbours [m].
        count: number of pairs that fit on one half of the rim.
        most: largest unbalance that these correct [kg m].
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
    """Largest correction by holes in a rim, with depths in steps of 0.1 mm.

    Args:
        inner, outer, height, density: of the rim [m], [kg/m^3].
        chamfer: of its edges [m].
        ligament: material between holes, to edges and between their bottoms [m].
    """
    middle = (inner + outer) / 2.0
    beside = (outer - inner) / 2.0 - chamfer - ligament
    # Narrower holes if the wall requires it.
    hole = _whole_steps(max(min(CORRECTION_HOLE, beside), 0.0), 0.05e-3)
    depth = _whole_steps(max((height - ligament) / 2.0, 0.0), 0.1e-3)
    if hole == 0.0 or depth == 0.0:
        return Correction(middle, 0.0, 0.0, 0.0, 0.0, 0, 0.0)
    mass = 2.0 * pi * hole**2 * depth * density
    apart = 2.0 * hole + ligament
    step = apart / middle
    count = max(floor(pi / step), 1)
    angles = step * (np.arange(count) - (count - 1) / 2.0)
    most = float(mass * middle * np.cos(angles).sum())
    return Correction(middle, hole, depth, mass, apart, count, most)


def _whole_steps(length: float, step: float) -> float:
    """A length rounded down to whole steps [m]."""
    return step * floor(length / step + 1e-6)


# --- shrink fits ------------------------------------------------------------------------------

COLDEST, MADE, WARMEST = -10.0, 20.0, 50.0
"""Extreme temperatures at which a shrink fit must hold, and that at which it is made [deg C]."""


SEAT_ROUGHNESS = 1.6e-6
"""Arithmetic mean roughness Ra of both seats of a shrink fit, as on the drawing [m]."""

_TURNING_FACTOR = 4.0
"""Rz over Ra of a triangular profile, as left by turning."""

SMOOTHING = 0.8 * 2.0 * _TURNING_FACTOR * SEAT_ROUGHNESS
"""Interference on the diameter lost to smoothing of both seats, 0.8 (Rz_i + Rz_a) [m]:
DIN 7190-1:2017."""


@dataclass(frozen=True)
class ShrinkFit:
    """A rim on a web of another material.

    Attributes:
        least, most: radial interference at `MADE`, before smoothing [m].
        torque: carried by friction at the least pressure: at the least interference minus
            `SMOOTHING`, spinning or not, cold or warm [N m].
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
"""Buckling coefficient of a full plate with a clamped edge, N = 14.68 D / a^2: Timoshenko and Gere,
Theory of Elastic Stability, 2nd ed., section 9.1. The rim clamps the web's edge, and the hub
stiffens its middle."""


def shrink_fit(
    rings: Sequence[Ring],
    expansions: tuple[float, float],
    speed: float,
    torque: float,
    *,
    holes: float | None = None,
) -> ShrinkFit:
    """The loosest shrink fit that holds at a given speed and at rest, cold and warm.

    Web and rim expand differently; bore and web are each made to IT6. Interferences on the diameter
    are whole micrometres, as on the drawing. Smoothing is subtracted where the fit must hold, but
    not where it must not yield or buckle.

    Args:
        rings: hub, web and rim, or web and rim.
        expansions: thermal expansion of web and rim [1/K].
        speed: at which it must hold [rad/s].
        torque: that it must carry [N m].
        holes: radius of the circle of the hub's screws [m]; None: it has none.
    """
    web = rings[-2]
    radius, joint = web.outer, len(rings) - 2
    per_pressure = cylinder_torque(2.0 * radius, web.thickness, FRICTION)
    grown = [(expansions[0] - expansions[1]) * (at - MADE) * radius for at in (COLDEST, WARMEST)]

    def turning(interference: float, at: float) -> TurningRings:
        """Rings with an interference at the joint [m], at a speed [rad/s]."""
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
    buckling = _BUCKLING * stiffness / (radius**2 * web.thickness) if radius > 0.0 else inf
    carried = per_pressure * (loosest + per_interference * (least - SMOOTHING / 2.0))
    in_rim = max(state.peak(joint + 1) for state in states)
    squeezed = max(state.pressure(joint) for state in states)
    return ShrinkFit(least, most, carried, max(inside), in_rim, squeezed, buckling)
