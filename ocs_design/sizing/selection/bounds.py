"""Lower bounds on the mass of every candidate, and an initial guess for its incidence.

Each is proved by monotone terms (docs/theory.md, The selection): a bound on the spin inertia gives
one on the mass, that gives one on the composite inertia, and that a better one on the spin inertia.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.spin_root import smallest_root
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.actuation.wheel_load import WheelBound, spin_demand
from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import Layout
from ocs_design.parts.housing import PlainDrum
from ocs_design.parts.module import Printed
from ocs_design.parts.motor_mount import hub_of, mount_of
from ocs_design.parts.printed import half_height
from ocs_design.parts.rim import LIGHTENED
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.bound.rim_problem import (
    BORE_SHARE,
    OFF_THE_EDGE,
    RimLimits,
    limits_with_web,
    smallest_rim_inertia,
)
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.module_radii import smallest_radius
from ocs_design.sizing.selection.candidates import Candidates, Guess, known_pairs, rim_limits
from ocs_design.sizing.selection.composite_inertia import (
    LeastInertia,
    ModuleBounds,
    least_composite_inertia,
)
from ocs_design.sizing.selection.demand import column, columns, rate_change_spin_inertia
from ocs_design.sizing.selection.drives import Drives
from ocs_design.sizing.selection.problem import SelectionProblem

INTERVALS = 18
"""Number of intervals of the incidence that are bounded separately: 5 deg each."""

_RIMS = 96
_DIGITS, _SAFETY = 4, 1.0 - 1e-4
"""Digits of the lightest rims, and the factor on their mass that makes it a safe bound."""


class Interval(NamedTuple):
    """An interval of a layout's angle [rad]; a single angle if both ends are equal."""

    low: float
    high: float


def incidence_intervals(incidence: float | None, count: int = INTERVALS) -> tuple[Interval, ...]:
    """All incidences in `count` equal intervals; a specified one by itself."""
    if incidence is not None:
        return (Interval(incidence, incidence),)
    edges = np.linspace(0.0, np.pi / 2.0, count + 1)
    return tuple(Interval(float(a), float(b)) for a, b in pairwise(edges))


@dataclass(frozen=True, eq=False)
class RimFloor:
    """Least mass of a rim with housing and foot as a function of spin inertia, for every material.

    Attributes:
        spin_inertia: of the rim [kg m^2], increasing along axis 1, shape (materials, rims).
        mass: of the lightest rim with its housing and foot [kg], never decreasing, inf where there
            is none.
        web_density: of their webs and hubs [kg/m^3], shape (materials,).
        wheels: number of wheels of a device.
    """

    spin_inertia: FloatArray
    mass: FloatArray
    web_density: FloatArray
    wheels: int

    @classmethod
    def of(cls, problem: SelectionProblem) -> "RimFloor":
        """Rims that turn slowly, around the narrowest hub: no hoop stress adds to their mass."""
        materials, webs = len(problem.materials), len(problem.lightenings)
        # Every rim of every material, in every web.
        material = np.tile(np.repeat(np.arange(materials), _RIMS), webs)
        mounts = [
            mount_of(motor, None, problem.foot_plate, on_bell=problem.on_bell)
            for motor in problem.motors
        ]
        geared = any(gear.room is not None for gear in problem.gears)
        # No motor's mount has holes nearer to the axis, and no wheel has a narrower hub.
        reach = 0.0 if geared else min(mount.holes.reach for mount in mounts)
        slow_speed, mount_reach = (np.full(material.size, value) for value in (1e-3, reach))
        # No ring around a bell is lighter than a plain rim of free bore.
        limits = rim_limits(problem, material, slow_speed, mount_reach)
        if problem.web:
            mounted = zip(problem.motors, mounts, strict=True)
            narrow = min(
                *(
                    max(hub_of(motor.mounting, motor.diameter).radius, mount.head_reach)
                    for motor, mount in mounted
                ),
                *(hub_of(None, motor.diameter).radius for motor in problem.motors),
            )
            solid_shares = [LIGHTENED[count] for count in problem.lightenings]
            limits = limits_with_web(
                limits,
                narrow,
                problem.cuts,
                None if problem.web_material is None else problem.web_material.density,
                web_thickness=problem.web_thickness,
                lightened=np.repeat(solid_shares, materials * _RIMS),
            )
        room = problem.envelope
        disc = np.pi * limits.density * room.height_max * room.outer_radius_max**4 / 2.0
        steps = np.tile(np.linspace(0.0, 1.0, _RIMS), materials * webs)
        least = smallest_rim_inertia(limits).reshape(webs, -1).min(axis=0)
        least = np.maximum(np.tile(least, webs) * OFF_THE_EDGE, 1e-9 * disc)
        inertia = least * np.maximum(disc / least, 1.0) ** steps
        # Where there is no room for holes, the web is solid.
        shell = Printed(reach, foot_plate=problem.foot_plate)
        mass = lightest_module(inertia, limits, shell, _DIGITS).mass
        mass = _SAFETY * np.nan_to_num(mass, nan=np.inf)
        inertia, mass = (values.reshape(webs, materials, _RIMS) for values in (inertia, mass))
        # A small demand may still get a larger rim, since the smallest fit no hub.
        mass = np.minimum.accumulate(mass.min(axis=0)[:, ::-1], axis=1)[:, ::-1]
        return cls(inertia[0], mass, problem.web_densities, len(problem.layout))

    def at(self, spin_inertia: FloatArray) -> FloatArray:
        """Lower bound of the mass [kg] for this spin inertia [kg m^2], shape (materials, n)."""
        rows = [
            mass[np.maximum(np.searchsorted(grid, required, side="right") - 1, 0)]
            for grid, mass, required in zip(self.spin_inertia, self.mass, spin_inertia, strict=True)
        ]
        too_large = spin_inertia > self.spin_inertia[:, -1:]
        return np.where(too_large, np.inf, np.stack(rows))


@dataclass(eq=False)
class PairBounds:
    """Lower bounds for every motor with every gear, each of shape (motors, gears).

    Attributes:
        problem: the problem. floor: least masses of its rims.
        known: whether all data of the pair are known.
        least: lower bound of the mass of any device with the pair [kg]; inf: there is none.
        spin_inertia: lower bound for its wheels [kg m^2], as far as computed.
    """

    problem: SelectionProblem
    floor: RimFloor
    known: NDArray[np.bool_]
    least: FloatArray
    spin_inertia: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem) -> Self:
        """Bounds from the masses of motor, gear and the smallest wheel."""
        floor, known = RimFloor.of(problem), known_pairs(problem)
        motors = np.array([motor.mass or 0.0 for motor in problem.motors])
        # Least mass of screws and cage, less the holes.
        mounts = np.array(
            [
                mount.moments_at_floor().mass + mount.moments_at_wheel().mass
                for motor in problem.motors
                for mount in [mount_of(motor, None, problem.foot_plate, on_bell=problem.on_bell)]
            ]
        )
        gears = np.array([gear.mass for gear in problem.gears])
        direct = np.array([gear.room is None for gear in problem.gears])
        drives = motors[:, None] + np.where(direct, mounts[:, None], 0.0) + gears
        least = len(problem.layout) * (drives + floor.mass.min(initial=np.inf))
        return cls(problem, floor, known, np.where(known, least, np.inf), np.zeros(known.shape))


def least_masses(floor: RimFloor, drives: Drives, spin_inertia: FloatArray) -> FloatArray:
    """Lower bounds of the device's mass [kg], shape (materials, n); inf: no device."""
    on_webs = drives.with_web_densities(floor.web_density[:, None])
    rim = spin_inertia - on_webs.inertia_beside_rim
    lightest = np.where(np.isfinite(rim), floor.at(np.where(np.isfinite(rim), rim, 0.0)), np.inf)
    return floor.wheels * (on_webs.mass + lightest)


def least_spin_inertias(
    problem: SelectionProblem,
    drives: Drives,
    intervals: Sequence[Interval],
    below: FloatArray,
    limits: RimLimits | None = None,
) -> FloatArray:
    """Lower bounds of the spin inertia of each drive, improved per interval [kg m^2], shape (n, k).

    Args:
        below: the best lower bound known over all intervals [kg m^2], shape (n,).
        limits: of their rims; None: those of the problem as a whole.
    """
    requirement, least = problem.requirement, least_inertia(problem, drives, below, limits)
    line, armature = columns(drives.line), drives.armature[:, None]
    needed = np.broadcast_to(below[:, None], (len(drives), len(intervals)))
    for maneuver in requirement.maneuvers:
        incidence = maneuver.incidence
        maneuver_intervals = intervals if incidence is None else [Interval(incidence, incidence)]
        task = bound_task(maneuver, requirement, least, maneuver_intervals, problem.layout)
        demand = spin_demand(task, line, armature, below[:, None])
        needed = np.maximum(needed, smallest_root(demand))
    if requirement.rate_change is not None:
        uncoupled = column(TiltInertia.uncoupled(least.inertia.diagonal))
        axes = np.stack([problem.layout.hull(*interval) for interval in intervals])
        by_rate = rate_change_spin_inertia(requirement.rate_change, drives, uncoupled, axes)
        needed = np.maximum(needed, by_rate)
    specified = requirement.spin_inertia
    if specified is None:
        return needed
    return np.where(needed > specified * OFF_THE_EDGE, np.inf, specified)


def bound_task(
    maneuver: Maneuver,
    requirement: Requirement,
    least: LeastInertia,
    intervals: Sequence[Interval],
    layout: Layout,
) -> WheelBound:
    """The least that a maneuver requires of n trunks' wheels at k intervals, shape (n, k, ...)."""
    inertia, spread = maneuver.turned(column(least.inertia)), least.spread[:, None]
    slews = [
        requirement.slew(maneuver, TiltInertia(inertia.diagonal, product))
        for product in (0.0 * spread, inertia.product - spread, inertia.product + spread)
    ]
    swept = _least_magnitude(*(slew.swept for slew in slews))
    momentum = _least_magnitude(*(slew.momentum for slew in slews))
    uncoupled = slews[0]
    # Over an interval, each axis is least at one of the ends.
    ends = np.abs(layout.axes(np.array(intervals)))[..., :2, :]
    reached = (ends.max(axis=-1) > OUT_OF_REACH).all(axis=1)
    return WheelBound(
        # What coupling alone requires about an axis is not required where that axis is left free.
        swept=np.where(reached | (uncoupled.swept != 0.0), swept, 0.0),
        momentum=np.where(reached | (uncoupled.momentum != 0.0), momentum, 0.0),
        duration=uncoupled.duration,
        inertia=inertia,
        axes=np.stack([layout.hull(*interval) for interval in intervals]),
        spread=spread,
        reached=reached,
        initial_speed=uncoupled.initial_speed,
        one_way=uncoupled.one_way,
    )


def _least_magnitude(
    uncoupled: FloatArray, least_coupled: FloatArray, most_coupled: FloatArray
) -> FloatArray:
    """Least magnitude of inertia times a turn or a rate, which is linear in the coupling.

    More inertia adds to it in the direction of the turn, which is that without coupling; about an
    axis without a turn there is the coupling alone.
    """
    sense = np.where(uncoupled == 0.0, np.sign(most_coupled), np.sign(uncoupled))
    least: FloatArray = np.maximum(np.minimum(sense * least_coupled, sense * most_coupled), 0.0)
    return least


def least_inertia(
    problem: SelectionProblem,
    drives: Drives,
    spin_inertia: FloatArray,
    limits: RimLimits | None = None,
) -> LeastInertia:
    """Inertia of the robot with modules whose wheels have at least that spin inertia [kg m^2].

    Limits of their rims improve the bound, at the cost of computing the lightest rims.
    """
    room, density = problem.envelope, max(material.density for material in problem.materials)
    rim = np.maximum(
        np.where(np.isfinite(spin_inertia), spin_inertia - drives.inertia_beside_rim, 0.0), 0
    )
    zero, widest = np.zeros_like(rim), np.full_like(rim, room.outer_radius_max)
    if limits is None:
        closed = room.wall_min / (1.0 - BORE_SHARE)
        radius = zero + max(room.inner_radius_min + room.wall_min, closed)
        wheel = rim / widest**2 + PlainDrum().mass(radius, zero + room.height_min)
    else:
        rim = np.maximum(rim, smallest_rim_inertia(limits) * OFF_THE_EDGE)
        # A wheel of more spin inertia is not smaller.
        radius = np.minimum(smallest_radius(rim, limits), widest)
        wheel = _SAFETY * np.nan_to_num(lightest_module(rim, limits, PlainDrum(), _DIGITS).mass)
    seat = drives.seat
    at_floor, at_wheel = seat.at_floor, seat.at_wheel
    stands = at_floor.mass + seat.holes
    behind = stands + at_wheel.mass
    # The holes are at most this far behind the floor.
    holes = seat.holes * problem.foot_plate
    fullest = np.minimum(room.mass_max, np.pi * density * widest**2 * room.height_max)
    web = np.pi * problem.web_thickness * drives.web_density_max * widest**2
    guard, tallest = problem.guard_wall, np.maximum(room.height_max, seat.room)
    # Posts are longest behind the flattest rim.
    around = Printed(seat.reach, guard_wall=guard, foot_plate=problem.foot_plate)
    shell = around.mass(widest, tallest) + seat.posts.mass(zero)
    least = ModuleBounds(
        mass=np.maximum(wheel + drives.hub_mass - seat.holes, 0.0),
        # A body of revolution has at least half its axial inertia across its axis.
        inertia=drives.hub_inertia + rim / 2.0,
        behind=behind,
        depth=(half_height(tallest) * stands + holes - at_floor.y - at_wheel.y) / behind,
        above=(at_floor.z + at_wheel.z) / behind,
        smallest=drives.size(radius + guard, zero + room.height_min),
        largest=drives.size(widest + guard, tallest),
        heaviest=at_floor.mass + at_wheel.mass + drives.hub_mass_max + fullest + web + shell,
    )
    return least_composite_inertia(problem.robot, problem.place, least, problem.layout)


def initial_guess(candidates: Candidates, spin_inertia: FloatArray) -> Guess:
    """Bounds of candidates with their own hubs, mounts and stresses, at their best incidences.

    The bounds on masses above hold for all wheels of a problem. The lightest module of a single
    candidate takes a hundredth of the time of its fixed point. `spin_inertia` is a lower bound of
    their wheels' [kg m^2], shape (n,).
    """
    intervals = incidence_intervals(candidates.problem.incidence)
    bounds = least_spin_inertias(
        candidates.problem, candidates.drives, intervals, spin_inertia, candidates.limits
    )
    # The uncertainty extends beyond the best interval, as that of the bound need not contain the
    # best incidence.
    low, high = np.array([(interval.low, interval.high) for interval in intervals])[
        bounds.argmin(axis=1)
    ].T
    spin = bounds.min(axis=1)
    known = np.isfinite(spin)
    least = smallest_rim_inertia(candidates.limits) * OFF_THE_EDGE
    rim = np.maximum(np.where(known, spin, 0.0) - candidates.drives.inertia_beside_rim, least)
    module = lightest_module(rim, candidates.limits, candidates.shell, _DIGITS).mass
    mass = len(candidates.problem.layout) * (candidates.drives.mass + _SAFETY * module)
    mass = np.where(known & (module > 0.0), mass, np.inf)
    return Guess(spin, mass, (low + high) / 2.0, high - low)
