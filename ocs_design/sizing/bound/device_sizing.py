"""Two wheels on the robot that carries them, by the bound: incidence, spin inertia and rim at once.

A heavier wheel needs more momentum, and the incidence depends on the inertia of robot and wheels
together: spin inertia and incidence are the fixed point of rim -> total inertia -> incidence ->
demand. It is approached from below, starting with the robot alone. As heavier wheels need more, the
first spin inertia that no rim reaches proves that no device is feasible. The error then says why,
and which single changes would help.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import degrees, isfinite, isinf

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import Constraint, Infeasible, UsageError
from ocs_design.common.units import round_outwards
from ocs_design.common.wording import listed
from ocs_design.device.device import braked
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia
from ocs_design.parts.solids import Carrier
from ocs_design.requirement.bound import SpinDemand, spin_demands
from ocs_design.requirement.device_sections import Envelope
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.rim_problem import (
    OFF_THE_EDGE,
    RimProblem,
    RimShape,
    check_limits,
    lightest_rim,
    smallest_rim_inertia,
)
from ocs_design.sizing.bound.rim_program import RimSolution, solve_rim
from ocs_design.sizing.limits import (
    LARGEST_CHANGE,
    RIM_LIMITS,
    STRESS,
    TOP_SPEED,
    Limit,
    advice,
    narrowed,
    smallest_changes,
)


@dataclass(frozen=True, eq=False)
class DeviceProblem:
    """Find the lightest pair of wheels that meets the requirement on the robot that carries it.

    Attributes:
        robot: without the wheels, in B.
        requirement: what the wheels must do.
        envelope: room for one rim. material: of the rim.
        place: centres of the left and the right wheel in B [m], shape (2, 3), for an outer radius
            and a height [m].
        incidence: of the wheel axes [rad]; None: by `criterion`.
        criterion: for the incidence.
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    material: Material
    place: Callable[[float, float], FloatArray]
    incidence: float | None
    criterion: Criterion

    def value_of(self, limit: Limit) -> float:
        """Present value of one of its limits [SI]."""
        return limit.value(self.requirement if limit is TOP_SPEED else self.envelope)

    def with_limit(self, limit: Limit, value: float) -> "DeviceProblem":
        """The problem with one of its limits changed [SI]."""
        if limit is TOP_SPEED:
            return replace(self, requirement=limit.replaced(self.requirement, value))
        return replace(self, envelope=limit.replaced(self.envelope, value))

    def rim_problem(self, spin_inertia: float) -> RimProblem:
        """Rim problem of one wheel with this spin inertia [kg m^2]."""
        speed = self.requirement.wheel_speed_max
        return RimProblem(spin_inertia, self.envelope, self.material, speed)


def braked_total(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> MassProperties:
    """Robot and both wheels as one rigid body in B; the robot alone if there is no rim yet."""
    if shape is None:
        return problem.robot
    inner, outer, height, mass = (float(value) for value in shape)
    cylinder = inner, outer, height, problem.material.density
    wheel = Carrier(mass, cylinder_spin_inertia(*cylinder), cylinder_transverse_inertia(*cylinder))
    return braked(problem.robot, (wheel,), problem.place(outer, height), incidence)


def device_demands(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> tuple[SpinDemand, ...]:
    """Demand on a wheel of each part of the requirement, with the inertia at its own incidence.

    A maneuver with an incidence of its own turns the wheels, and with them their inertia. Without a
    shape of the rims, it is that of the robot alone.
    """

    @cache
    def inertia_at(angle: float) -> FloatArray:
        """Inertia of robot and device with the wheels at this incidence [kg m^2], shape (3, 3)."""
        return braked_total(problem, shape, angle).inertia

    return spin_demands(problem.requirement, inertia_at, incidence)


def best_incidences(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> Mapping[Criterion, float]:
    """The best incidence under each criterion [rad], with the wheels at `incidence`."""
    inertia = braked_total(problem, shape, incidence).inertia
    return incidence_by_criterion(inertia, design_momenta(problem.requirement, inertia))


def design_momenta(requirement: Requirement, inertia: FloatArray) -> FloatArray:
    """Largest roll and largest pitch momentum [N m s], shape (2,).

    Maneuvers for which the device is turned by hand do not affect the design's incidence. Demand
    about an axis that is due to coupling alone counts only where the turn would otherwise end off
    level: the cube root of a tiny figure is large. `inertia`: of the robot with its device, wheels
    braked [kg m^2], shape (3, 3).
    """
    whole = TiltInertia.of(inertia)
    alone = TiltInertia.uncoupled(whole.diagonal)
    momenta = [
        maneuver.momentum(whole if whole.drifts_off_level(maneuver.tilt_per_drift).any() else alone)
        for maneuver in requirement.maneuvers
        if maneuver.incidence is None
    ]
    if requirement.rate_change is not None:
        momenta.append(whole.diagonal * requirement.rate_change)
    largest: FloatArray = np.max([np.zeros(2), *momenta], axis=0)
    return largest


_CONVERGED = 1e-12
_ITERATIONS_MAX = 1000


@dataclass(frozen=True, eq=False)
class DeviceFixedPoint:
    """Fixed point of the demand of robot and device together, and a rim that meets it.

    Attributes:
        spin_inertia: of each wheel [kg m^2]; inf if an axis is out of reach.
        incidence: [rad].
        demands: on the wheels.
        shape: of their rims; None: no rim reaches the spin inertia, so no device is feasible.
        residual: relative change of the spin inertia or change of the incidence [rad] in one more
            iteration, whichever is larger.
        iterations: number of iterations.
    """

    spin_inertia: float
    incidence: float
    demands: tuple[SpinDemand, ...]
    shape: RimShape | None = None
    residual: float = 0.0
    iterations: int = 0


def find_fixed_point(problem: DeviceProblem) -> DeviceFixedPoint:
    """Iterate from the robot alone to convergence.

    Raises:
        UsageError: the requirement is empty.
    """
    guess = _follow(problem, None, incidence_by_criterion(problem.robot.inertia)[problem.criterion])
    for iterations in range(1, _ITERATIONS_MAX + 1):
        shape = lightest_rim(guess.spin_inertia, problem.rim_problem(guess.spin_inertia).limits)
        if not shape.mass > 0.0:
            break
        following = _follow(problem, shape, guess.incidence)
        change = abs(following.spin_inertia / guess.spin_inertia - 1.0)
        residual = max(change, abs(following.incidence - guess.incidence))
        if residual < _CONVERGED:
            demands = following.demands
            return replace(
                guess, demands=demands, shape=shape, residual=residual, iterations=iterations
            )
        guess = following
    return guess


def _follow(problem: DeviceProblem, shape: RimShape | None, incidence: float) -> DeviceFixedPoint:
    """The incidence, the demands and the spin inertia that a rim at an incidence entails."""
    if problem.incidence is not None:
        incidence = problem.incidence
    else:
        incidence = best_incidences(problem, shape, incidence)[problem.criterion]
    demands = device_demands(problem, shape, incidence)
    if problem.requirement.spin_inertia is not None:
        return DeviceFixedPoint(problem.requirement.spin_inertia, incidence, demands)
    largest = max((demand.spin_inertia for demand in demands), default=0.0)
    if largest == 0.0:
        raise UsageError(
            "nothing is required of the wheels",
            hint="Specify a rate change, a maneuver, or a spin inertia.",
        )
    smallest = smallest_rim_inertia(problem.rim_problem(largest).limits)
    return DeviceFixedPoint(max(largest, float(smallest) * OFF_THE_EDGE), incidence, demands)


@dataclass(frozen=True, eq=False, kw_only=True)
class DeviceSizing(DeviceFixedPoint):
    """Two sized wheels on their robot, at the converged fixed point.

    Attributes:
        total: robot and wheels, braked, in B.
        incidence_by_criterion: the best one under each criterion, with the device [rad].
        incidence_by_criterion_robot: the same for the robot alone.
        rim: of each wheel.
        centers: of the left and the right wheel in B [m], shape (2, 3).
    """

    total: MassProperties
    incidence_by_criterion: Mapping[Criterion, float]
    incidence_by_criterion_robot: Mapping[Criterion, float]
    rim: RimSolution
    centers: FloatArray


def size_device(problem: DeviceProblem) -> DeviceSizing:
    """The lightest wheels that meet the requirement on their robot.

    The fixed point is in closed form; the convex program proves its rim.

    Raises:
        Infeasible: no rim within the envelope will do, or an axis is out of the wheels' reach.
        UsageError: the requirement is empty, or a limit is not a positive number.
    """
    check_limits(problem.envelope, problem.material, problem.requirement.wheel_speed_max)
    fixed_point = find_fixed_point(problem)
    if fixed_point.shape is None:
        raise _infeasible(problem, fixed_point)
    rim = solve_rim(problem.rim_problem(fixed_point.spin_inertia))
    return DeviceSizing(
        **vars(fixed_point),
        total=braked_total(problem, fixed_point.shape, fixed_point.incidence),
        incidence_by_criterion=best_incidences(problem, fixed_point.shape, fixed_point.incidence),
        incidence_by_criterion_robot=best_incidences(problem, None, fixed_point.incidence),
        rim=rim,
        centers=problem.place(rim.outer_radius, rim.height),
    )


PRECISION = 1e-6
"""Relative precision of the changes."""


def _infeasible(problem: DeviceProblem, dead_end: DeviceFixedPoint) -> Infeasible:
    """The error for an infeasible device, whose iteration ended there.

    It names single changes of limits that help, each verified by sizing with it.
    """
    demands = dead_end.demands
    if isinf(dead_end.spin_inertia):
        blind = next(demand for demand in demands if isinf(demand.spin_inertia))
        axes = " and ".join(blind.unreachable_axes)
        # The largest of the others: JSON has no infinity.
        finite = filter(isfinite, (demand.spin_inertia for demand in demands))
        return Infeasible(
            f"{_capitalised(blind.source)} requires {axes} momentum, which wheels at an incidence "
            f"of {degrees(blind.incidence):.4g} deg cannot provide.",
            binding=[Constraint.INCIDENCE],
            required_spin_inertia=max(finite, default=0.0),
            largest_spin_inertia=largest_spin_inertia(problem.rim_problem(1.0)),
            hint="Choose an incidence between 0 and 90 deg, another criterion, "
            "or drop the requirement about that axis.",
        )
    rim = problem.rim_problem(dead_end.spin_inertia)
    largest = largest_spin_inertia(rim)
    limits, asked_by = limits_set(rim), ""
    if problem.requirement.spin_inertia is None:
        # The wheel speed is a limit only where it affects the spin inertia.
        limits = (*limits, TOP_SPEED)
        if largest > 0.0:
            most = max(demands, key=lambda demand: demand.spin_inertia)
            asked_by = f"{most.source} requires too much: "
    changes = smallest_changes(
        {limit: problem.value_of(limit) for limit in limits},
        lambda limit, value: find_fixed_point(problem.with_limit(limit, value)).shape is not None,
        precision=PRECISION / 3.0,
    )
    texts, relaxations = [], {}
    for limit, edge in changes.items():
        # A little looser, as no solver can verify a value at the edge.
        value = limit.loosened(edge, 1.0 + PRECISION / 3.0)
        size_device(problem.with_limit(limit, value))
        text, relaxations[limit.name] = limit.loose_text(value), value
        if limit is STRESS:
            safety = rim.envelope.stress_safety
            # The stress to allow is reported [Pa].
            relaxations[limit.name] = rim.hoop_stress_max * safety / value
            needed = round_outwards(relaxations[limit.name] * safety / 1e6, upwards=True)
            stronger = f"a material that yields at {needed:g} MPa"
            text = stronger if value < 1.0 else f"{text} or {stronger}"
        texts.append(text)
    # All limits where the conflict is below numerical resolution.
    binding = conflicting_limits(rim) or limits_set(rim)
    return Infeasible(
        f"{_capitalised(asked_by + _shortfall(rim, binding, largest))}.",
        binding=[limit.name for limit in binding],
        required_spin_inertia=rim.spin_inertia,
        largest_spin_inertia=largest,
        relaxations=relaxations,
        hint=advice(texts, "loosen several, or require less."),
    )


def is_feasible(problem: RimProblem) -> bool:
    """Whether any rim meets the limits."""
    return bool(lightest_rim(problem.spin_inertia, problem.limits).mass > 0.0)


def limits_set(problem: RimProblem) -> tuple[Limit, ...]:
    """Limits of a rim that have an effect."""
    limited = np.isfinite(problem.hoop_stress_max)
    return tuple(
        limit
        for limit in RIM_LIMITS
        if 0.0 < limit.value(problem.envelope) < np.inf and (limit is not STRESS or limited)
    )


def conflicting_limits(problem: RimProblem) -> tuple[Limit, ...]:
    """An irreducible set of limits that makes the rim infeasible.

    The deletion filter: loosen one after the other and leave it loose if still no rim fits
    (Chinneck, Feasibility and Infeasibility in Optimization, 2008, section 6.1).
    """
    needed = []
    for limit in reversed(limits_set(problem)):
        loosest = limit.loosened(limit.value(problem.envelope), LARGEST_CHANGE)
        without = problem.with_limit(limit, loosest)
        if is_feasible(without):
            needed.append(limit)
        else:
            problem = without
    return tuple(reversed(needed))


def largest_spin_inertia(problem: RimProblem) -> float:
    """Largest spin inertia that the limits allow [kg m^2]; 0 if they allow no rim at all.

    The spin inertias that the limits allow form an interval: from any rim, a lower height and
    then a thinner wall and a smaller bore lead to the smallest one without leaving the limits.
    """
    limits = problem.limits
    ceiling = float(np.pi * limits.density * limits.height_max * limits.outer_radius_max**4 / 2.0)
    reached = max(float(smallest_rim_inertia(limits)) * (1.0 + 1e-9), ceiling * 1e-9)

    def fails(inertia: float) -> bool:
        return not is_feasible(replace(problem, spin_inertia=inertia))

    return 0.0 if fails(reached) else narrowed(fails, reached, ceiling * (1.0 + 1e-9), 1e-12)[0]


def _shortfall(problem: RimProblem, binding: Sequence[Limit], largest: float) -> str:
    """Clause on what is required, which limits conflict with it and how much is possible."""
    asked = f"{problem.spin_inertia:.5g} kg m^2"
    room = listed([limit.text(limit.value(problem.envelope)) for limit in binding])
    if largest == 0.0:
        return f"no rim at all fits within {room}, whatever its spin inertia"
    if largest > problem.spin_inertia:
        least = float(smallest_rim_inertia(problem.limits))
        return f"every rim within {room} has more spin inertia than {asked}: at least {least:.5g}"
    return (
        f"no rim of {problem.material.name} within {room} has the spin inertia of {asked}; "
        f"the limits allow {largest:.5g} kg m^2 at most"
    )


def _capitalised(text: str) -> str:
    """Text with a capital first letter and the rest as it is."""
    return text[:1].upper() + text[1:]
