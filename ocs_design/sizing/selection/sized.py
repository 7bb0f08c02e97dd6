"""A selected device as a sized one, with what its limits cost."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.requirement.bound import AXES, SpinDemand, authority, per_wheel, rate_momenta
from ocs_design.sizing.incidence import incidence_by_criterion
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.momenta import design_momenta
from ocs_design.sizing.motor_mount import mount_of
from ocs_design.sizing.rim_problem import RimLimits, RimProblem
from ocs_design.sizing.selection.candidate import braked
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.shell import Printed
from ocs_design.sizing.sized import Sized

METHOD = "branch and bound over the catalogue, each module in closed form"

_LIMIT_OF_NAME: Mapping[str, str] = {
    "r_max": "outer_radius_max",
    "r_min": "inner_radius_min",
    "h_max": "height_max",
    "h_min": "height_min",
    "wall_min": "wall_min",
    "wheel_mass_max": "mass_max",
    "hoop_stress": "stretch_max",
}
"""Field of `RimLimits` behind each name of a limit that can bind."""

_STEP = 1e-5


def sized_selection(problem: SelectionProblem, chosen: Candidate) -> Sized:
    """The figures behind the selected, or the co-designed, device."""
    inertia, robot = chosen.total.inertia, problem.robot.inertia
    requirement, line = problem.requirement, chosen.line.reserved()
    return Sized(
        wheel_speed_max=min(float(line.no_load_speed), float(line.speed_max)),
        incidence_by_criterion=incidence_by_criterion(
            inertia, design_momenta(requirement, inertia)
        ),
        incidence_by_criterion_robot=incidence_by_criterion(
            robot, design_momenta(requirement, robot)
        ),
        demands=_demands(problem, chosen),
        total=chosen.total,
        status="optimal",
        method=METHOD,
        objective=chosen.mass,
        binding=chosen.binding,
        shadow_prices=_shadow_prices(problem, chosen),
        gap=0.0,
        residual=chosen.residual,
        iterations=chosen.iterations,
    )


def _demands(problem: SelectionProblem, chosen: Candidate) -> tuple[SpinDemand, ...]:
    """What the motors' figures make of each part of the requirement, at its own incidence."""
    requirement = problem.requirement
    maneuvers = {maneuver.name: maneuver for maneuver in requirement.maneuvers}
    height = requirement.standing_height
    found = []
    for demand in chosen.demands:
        maneuver = maneuvers.get(demand.source)
        inertia = TiltInertia.of(_inertia(problem, chosen, demand.incidence))
        if maneuver is None:
            about = [demand.source.endswith(name) for name in AXES]
            momentum = rate_momenta(inertia, requirement.rate_change or 0.0)[about][0]
            torque = 0.0
        else:
            turned = inertia.within_reach(authority(demand.incidence), maneuver.stray)
            momentum = maneuver.momentum(turned, height)
            torque = per_wheel(maneuver.least_torque(turned, height), demand.incidence)
        found.append(
            SpinDemand(demand.source, demand.incidence, momentum, demand.spin_inertia, torque)
        )
    return tuple(found)


def _inertia(problem: SelectionProblem, chosen: Candidate, incidence: float) -> FloatArray:
    """Of robot and device, braked, with the modules turned to this incidence [kg m^2]."""
    modules = (chosen.wheel, chosen.carrier)
    return braked(problem.robot, modules, chosen.centers, incidence).inertia


def _shadow_prices(problem: SelectionProblem, chosen: Candidate) -> dict[str, float]:
    """By central differences of the closed form, at the spin inertia that was found."""
    hub_share = 0.0 if chosen.hub is None else chosen.hub.axial_inertia
    rim_inertia = chosen.spin_inertia - chosen.rotor_share - hub_share
    rim = RimProblem(rim_inertia, problem.envelope, chosen.material, chosen.overspeed)
    limits = chosen.limits(problem.envelope)
    shell = Printed(mount_of(chosen.motor, chosen.gear.room).holes.reach)
    prices = {}
    for name in chosen.binding:
        field = _LIMIT_OF_NAME.get(name)
        if field is not None:
            per_unit = 1.0
            if name == "hoop_stress":
                per_unit = rim.stretch_max / rim.hoop_stress_max
            prices[name] = _slope(rim_inertia, limits, shell, field) * per_unit
    return prices


def _slope(rim_inertia: float, limits: RimLimits, shell: Printed, field: str) -> float:
    """dm of one module per dlimit; one-sided where only one side has a module."""
    value = float(np.asarray(getattr(limits, field)))
    steps = np.array([-_STEP, 0.0, _STEP]) * value
    masses = np.array(
        [
            float(lightest_module(rim_inertia, changed, shell).mass)
            for changed in (replace(limits, **{field: value + step}) for step in steps)
        ]
    )
    known = np.isfinite(masses)
    masses, steps = masses[known], steps[known]
    return float((masses[-1] - masses[0]) / (steps[-1] - steps[0]))
