"""A sized device, by the bound alone or selected with motors, and the figures behind it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ocs_design.actuation.wheel_load import gauge
from ocs_design.common.arrays import FloatArray
from ocs_design.common.records import recorded
from ocs_design.device.device import Device
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.device.records.selection import CoDesignRecord, ReserveRecord, SizingRecord
from ocs_design.parts.joints import OVERSPEED
from ocs_design.requirement.bound import AXES, SpinDemand, rate_momenta
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_sizing import DeviceSizing, design_momenta
from ocs_design.sizing.bound.rim_problem import RimProblem
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.limits import RIM_LIMITS, STRESS
from ocs_design.sizing.reserve import Reserve
from ocs_design.sizing.selection.problem import Candidate, Selection, SelectionProblem, inertia_at

METHOD = "branch and bound over the catalogue, each module in closed form"

_DIFFERENCE_STEP = 1e-5
"""Relative step of the central differences."""


@dataclass(frozen=True, eq=False)
class Sized:
    """The figures behind a design.

    Attributes:
        wheel_speed_max: highest wheel speed that the design may use [rad/s].
        incidence_by_criterion: the best one under each criterion, with the device [rad].
        incidence_by_criterion_robot: the same for the robot alone.
        demands: demand on a wheel of each part of the requirement.
        total: robot and device, braked, in B.
        optimum: how it was found.
    """

    wheel_speed_max: float
    incidence_by_criterion: Mapping[Criterion, float]
    incidence_by_criterion_robot: Mapping[Criterion, float]
    demands: tuple[SpinDemand, ...]
    total: MassProperties
    optimum: SizingRecord


def sized_by_bound(sizing: DeviceSizing, wheel_speed_max: float) -> Sized:
    """Wheels without a motor."""
    rim = sizing.rim
    return Sized(
        wheel_speed_max=wheel_speed_max,
        incidence_by_criterion=sizing.incidence_by_criterion,
        incidence_by_criterion_robot=sizing.incidence_by_criterion_robot,
        demands=sizing.demands,
        total=sizing.total,
        optimum=recorded(
            SizingRecord,
            rim,
            objective=rim.mass,
            residual=sizing.residual,
            iterations=sizing.iterations,
        ),
    )


def sized_selection(problem: SelectionProblem, chosen: Candidate, robot: MassProperties) -> Sized:
    """Figures behind the selected, or the co-designed, device.

    The problem's robot already carries the plate or the mast; `robot` is the robot alone, in B.
    """
    inertia = chosen.total.inertia
    requirement = problem.requirement

    def by_criterion(of: FloatArray) -> Mapping[Criterion, float]:
        """Best incidence of pairs; empty for other layouts."""
        pairs = problem.layout.pairs
        return incidence_by_criterion(of, design_momenta(requirement, of)) if pairs else {}

    return Sized(
        wheel_speed_max=float(chosen.line.reserved().top_speed),
        incidence_by_criterion=by_criterion(inertia),
        incidence_by_criterion_robot=by_criterion(robot.inertia),
        demands=tuple(_spin_demands(problem, chosen)),
        total=chosen.total,
        optimum=recorded(
            SizingRecord,
            chosen,
            status="optimal",
            method=METHOD,
            objective=chosen.mass,
            shadow_prices=_shadow_prices(problem, chosen),
            gap=0.0,
        ),
    )


def _spin_demands(problem: SelectionProblem, chosen: Candidate) -> Iterator[SpinDemand]:
    """Demands of each part of the requirement, given the motors' data."""
    requirement = problem.requirement
    maneuvers = {maneuver.name: maneuver for maneuver in requirement.maneuvers}
    for demand in chosen.demands:
        maneuver, incidence = maneuvers.get(demand.source), demand.incidence
        inertia = inertia_at(problem, chosen, incidence)
        if maneuver is None:
            matches = [demand.source.endswith(name) for name in AXES]
            momentum = rate_momenta(inertia, requirement.rate_change or 0.0)[matches][0]
            torque = 0.0
        else:
            axes = chosen.layout.axes(incidence)[:2]
            reached_inertia = inertia.within_reach(
                np.abs(axes).max(axis=1), maneuver.tilt_per_drift
            )
            momentum = maneuver.momentum(reached_inertia)
            torque = float(gauge(axes, maneuver.least_torque(reached_inertia)).busiest)
        yield SpinDemand.of(demand.source, incidence, momentum, demand.spin_inertia, torque)


def _shadow_prices(problem: SelectionProblem, chosen: Candidate) -> dict[str, float]:
    """Change of one module's mass per change of each active limit, at the spin inertia found.

    Central differences of the closed form; one-sided where only one side is feasible.
    """
    rim_inertia = chosen.spin_inertia - chosen.drive.rotor_inertia - chosen.hub_share
    speed = OVERSPEED * float(chosen.line.top_speed)
    rim = RimProblem(rim_inertia, problem.envelope, chosen.material, speed)
    limits = chosen.limits
    shell, prices = chosen.shell, {}
    for name in chosen.binding:
        limit = next((limit for limit in RIM_LIMITS if limit.name == name), None)
        if limit is None:
            continue
        field = "stretch_max" if limit is STRESS else limit.field
        value = float(np.asarray(getattr(limits, field)))
        steps = np.array([-_DIFFERENCE_STEP, 0.0, _DIFFERENCE_STEP]) * value
        changed = [replace(limits, **{field: value + step}) for step in steps]
        masses = np.array([float(lightest_module(rim_inertia, c, shell).mass) for c in changed])
        known = np.isfinite(masses)
        masses, steps = masses[known], steps[known]
        if steps.size < 2:  # The smallest wheel, on the edge of feasibility.
            continue
        slope = float((masses[-1] - masses[0]) / (steps[-1] - steps[0]))
        prices[name] = slope * (rim.stretch_max / rim.hoop_stress_max if limit is STRESS else 1.0)
    return prices


@dataclass(frozen=True, eq=False)
class DriveChoice:
    """Choice of motor, gear and material, with the problem that it solves.

    Attributes:
        problem: candidates and requirement. selection: its solution.
        chosen: the lightest device, or the co-design based on it.
        co_design: the co-design; None: not required.
        lacks_mount: whether nothing on the trunk can hold it; False where the trunk's shapes are
            unknown.
    """

    problem: SelectionProblem
    selection: Selection
    chosen: Candidate
    co_design: CoDesignRecord | None
    lacks_mount: bool


@dataclass(frozen=True, eq=False)
class Designed:
    """A device and the figures behind it.

    Attributes:
        device: see `Device`. sized: see `Sized`.
        criterion: criterion of the incidence.
        choice: how its parts were chosen; None without a motor.
        reserve: reserve that it keeps; None without a motor.
        account: function that computes the reserve's amounts and costs.
        requirement: requirement of the robot with this device on it; None: not determined yet.
    """

    device: Device
    sized: Sized
    criterion: str
    choice: DriveChoice | None
    reserve: Reserve | None = None
    account: Callable[[], ReserveRecord | None] = lambda: None
    requirement: Requirement | None = None

    @cached_property
    def kept(self) -> ReserveRecord | None:
        """Amounts and costs of the reserve, which take as long to compute as the device.

        None without a motor or maneuvers.
        """
        return self.account()
