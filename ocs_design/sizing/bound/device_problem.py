"""The sizing problem of a device by the bound, and its fixed point with the robot that carries it.

A heavier wheel needs more momentum, and the incidence depends on the inertia of robot and wheels
together: spin inertia and incidence are the fixed point of rim -> total inertia -> incidence ->
demand. It is approached from below, starting with the robot alone. As heavier wheels need more, the
first spin inertia that no rim reaches proves that no device is feasible.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import UsageError
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
    lightest_rim,
    smallest_rim_inertia,
)
from ocs_design.sizing.limits import TOP_SPEED, Limit


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

    A maneuver with an incidence of its own turns the wheels, and with them their inertia.

    Args:
        problem: requirement and robot.
        shape: of both rims; None: robot alone. incidence: of the design [rad].
    """

    @cache
    def inertia_at(angle: float) -> FloatArray:
        """Inertia of robot and device with the wheels at this incidence [kg m^2], shape (3, 3)."""
        return braked_total(problem, shape, angle).inertia

    found: list[SpinDemand] = []
    for maneuver in problem.requirement.maneuvers:
        alone = replace(problem.requirement, maneuvers=(maneuver,), rate_change=None)
        at = incidence if maneuver.incidence is None else maneuver.incidence
        found.extend(spin_demands(alone, inertia_at(at), at))
    by_rate = replace(problem.requirement, maneuvers=())
    found.extend(spin_demands(by_rate, inertia_at(incidence), incidence))
    return tuple(found)


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
    level: the cube root of a tiny figure is large.

    Args:
        requirement: maneuvers and rate change.
        inertia: of the robot with its device, wheels braked [kg m^2], shape (3, 3).
    """
    whole, height = TiltInertia.of(inertia), requirement.standing_height
    alone = TiltInertia.uncoupled(whole.diagonal)
    found = [
        maneuver.momentum(
            whole if whole.drifts_off_level(maneuver.tilt_per_drift).any() else alone, height
        )
        for maneuver in requirement.maneuvers
        if maneuver.incidence is None
    ]
    if requirement.rate_change is not None:
        found.append(whole.diagonal * requirement.rate_change)
    largest: FloatArray = np.max([np.zeros(2), *found], axis=0)
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
