"""A sized device and the figures behind it, of wheels by the bound alone or of a selected one."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ocs_design.actuation.wheel_load import held
from ocs_design.common.arrays import FloatArray
from ocs_design.common.records import recorded
from ocs_design.device.device import Device
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.device.records.selection import CoDesignRecord, ReserveRecord, SizingRecord
from ocs_design.requirement.bound import AXES, SpinDemand, rate_momenta
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_problem import design_momenta
from ocs_design.sizing.bound.device_sizing import DeviceSizing
from ocs_design.sizing.bound.rim_problem import RimProblem
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.limits import RIM_LIMITS, STRESS
from ocs_design.sizing.reserve import Reserve
from ocs_design.sizing.selection.problem import Candidate, Selection, SelectionProblem, inertia_at

METHOD = "branch and bound over the catalogue, each module in closed form"

_STEP = 1e-5
"""Half the distance of the two points of a difference, relative."""


@dataclass(frozen=True, eq=False)
class Sized:
    """The figures behind a design.

    Attributes:
        wheel_speed_max: that the design may use [rad/s].
        incidence_by_criterion: the best one under each criterion, with the device [rad].
        incidence_by_criterion_robot: the same for the robot alone.
        demands: what each part of the requirement asks of a wheel.
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

    Args:
        problem: that was solved; its robot carries the plate or the mast already.
        chosen: the device. robot: the robot alone, in B.
    """
    inertia = chosen.total.inertia
    requirement = problem.requirement

    def by_criterion(of: FloatArray) -> Mapping[Criterion, float]:
        """Best incidence of pairs; nothing of other layouts."""
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
    """Demands that the motors' figures make of each part of the requirement."""
    requirement = problem.requirement
    maneuvers = {maneuver.name: maneuver for maneuver in requirement.maneuvers}
    height = requirement.standing_height
    for demand in chosen.demands:
        maneuver, at = maneuvers.get(demand.source), demand.incidence
        inertia = inertia_at(problem, chosen, at)
        if maneuver is None:
            about = [demand.source.endswith(name) for name in AXES]
            momentum = rate_momenta(inertia, requirement.rate_change or 0.0)[about][0]
            torque = 0.0
        else:
            axes = chosen.layout.axes(at)[:2]
            turned = inertia.within_reach(np.abs(axes).max(axis=1), maneuver.stray)
            momentum = maneuver.momentum(turned, height)
            torque = float(held(axes, maneuver.least_torque(turned, height)).most)
        yield SpinDemand(demand.source, at, momentum, demand.spin_inertia, torque)


def _shadow_prices(problem: SelectionProblem, chosen: Candidate) -> dict[str, float]:
    """Change of one module's mass per limit that holds it, at the spin inertia that was found.

    Central differences of the closed form; one-sided where only one side has a module.
    """
    rim_inertia = chosen.spin_inertia - chosen.drive.rotor_inertia - chosen.hub_share
    rim = RimProblem(rim_inertia, problem.envelope, chosen.material, chosen.overspeed)
    limits = chosen.limits
    shell, prices = chosen.shell, {}
    for name in chosen.binding:
        limit = next((each for each in RIM_LIMITS if each.name == name), None)
        if limit is None:
            continue
        field = "stretch_max" if limit is STRESS else limit.field
        value = float(np.asarray(getattr(limits, field)))
        steps = np.array([-_STEP, 0.0, _STEP]) * value
        changed = [replace(limits, **{field: value + step}) for step in steps]
        masses = np.array([float(lightest_module(rim_inertia, c, shell).mass) for c in changed])
        known = np.isfinite(masses)
        masses, steps = masses[known], steps[known]
        if steps.size < 2:  # The smallest wheel there is, on the edge of what closes.
            continue
        slope = float((masses[-1] - masses[0]) / (steps[-1] - steps[0]))
        prices[name] = slope * (rim.stretch_max / rim.hoop_stress_max if limit is STRESS else 1.0)
    return prices


@dataclass(frozen=True, eq=False)
class Choice:
    """How motor, gear and material were chosen.

    Attributes:
        problem: what there was to choose from. selection: what came of it.
        chosen: the lightest one, or what the co-design made of it.
        co_design: None: not asked for.
        hangs: whether nothing of the trunk's shapes holds it; False where they are not known.
    """

    problem: SelectionProblem
    selection: Selection
    chosen: Candidate
    co_design: CoDesignRecord | None
    hangs: bool


@dataclass(frozen=True, eq=False)
class Designed:
    """A device and the figures behind it.

    Attributes:
        device: see `Device`. sized: see `Sized`.
        criterion: that the incidence goes by.
        choice: None where no motor was wanted.
        reserve: that it keeps; None likewise. account: of what that comes to, and costs.
        requirement: what the robot is asked for with this device on it; None: not settled yet.
    """

    device: Device
    sized: Sized
    criterion: str
    choice: Choice | None
    reserve: Reserve | None = None
    account: Callable[[], ReserveRecord | None] = lambda: None
    requirement: Requirement | None = None

    @cached_property
    def kept(self) -> ReserveRecord | None:
        """What the reserve comes to, and costs: as long to find as the device.

        None without a motor or maneuvers.
        """
        return self.account()
