"""The device that the co-design leaves to be built, as a candidate like those of the selection."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.requirement.bound import AXES
from ocs_design.sizing.co_design.device import (
    braked_total,
    carrier_of,
    centers_of,
    spin_inertia,
    wheel_of,
)
from ocs_design.sizing.co_design.problem import CoDesign, CoDesignProblem, DeviceShape
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.selection.binding import binding_limits
from ocs_design.sizing.selection.demand import held_by_rate, shares_of
from ocs_design.sizing.selection.result import Candidate, TaskDemand
from ocs_design.sizing.web import wheel_body


def adopted(problem: CoDesignProblem, found: CoDesign) -> Candidate:
    """The selected device with the figures of the co-design; as it was if those are not adopted.

    What the maneuvers ask for is what they take in 3-D. Their smallest spin inertia is the closed
    form's, or the device's own where it does with less.
    """
    if not found.adopted:
        return problem.selected
    shape, wheel = found.shape, wheel_of(problem, found.shape)
    rim_mass = _rim_mass(problem, shape)
    return replace(
        problem.selected,
        incidence=shape.incidence,
        spin_inertia=spin_inertia(problem, shape),
        inner_radius=shape.inner_radius,
        outer_radius=shape.outer_radius,
        height=shape.height,
        rim_mass=rim_mass,
        web_mass=wheel.mass - rim_mass,
        carrier=carrier_of(problem, shape),
        total=braked_total(problem, shape),
        centers=centers_of(problem, shape),
        demands=(*_of_maneuvers(problem, found), *_of_rate_change(problem, shape)),
        binding=_binding(problem, shape),
        residual=found.violation,
        iterations=found.iterations,
    )


def _of_maneuvers(problem: CoDesignProblem, found: CoDesign) -> Iterator[TaskDemand]:
    """Every maneuver uses all the time that it has."""
    own = spin_inertia(problem, found.shape)
    for maneuver, demand, check in zip(
        problem.selection.requirement.maneuvers,
        problem.selected.demands,
        found.checks,
        # The demands of a change of rate come after those of the maneuvers.
        strict=False,
    ):
        turned = maneuver.incidence is not None
        yield replace(
            demand,
            incidence=demand.incidence if turned else found.shape.incidence,
            spin_inertia=min(demand.spin_inertia, own),
            time_needed=demand.time_given,
            peak_speed=check.peak_speed,
            peak_torque=check.peak_torque,
        )


def _of_rate_change(problem: CoDesignProblem, shape: DeviceShape) -> Iterator[TaskDemand]:
    """About roll and pitch, see `selection.demand`."""
    change, line = problem.selection.requirement.rate_change, problem.line
    if change is None:
        return
    inertia = TiltInertia.of(braked_total(problem, shape).inertia)
    momenta = held_by_rate(change, inertia, shares_of(np.asarray(shape.incidence)))
    top = min(float(line.no_load_speed), float(line.speed_max))
    for axis, held in zip(AXES, momenta.tolist(), strict=True):
        yield TaskDemand(
            source=f"rate change, {axis}",
            incidence=shape.incidence,
            spin_inertia=held / top,
            time_needed=None,
            time_given=None,
            peak_speed=held / spin_inertia(problem, shape),
            peak_torque=None,
        )


def _binding(problem: CoDesignProblem, shape: DeviceShape) -> tuple[str, ...]:
    """Names of the limits that the rim touches."""
    sizes = (shape.inner_radius, shape.outer_radius, shape.height)
    masses = (_rim_mass(problem, shape), 0.0, 0.0)
    module = ModuleShape(*(np.array([value]) for value in (*sizes, *masses)))
    return binding_limits(module, problem.limits, problem.selection.envelope, 0)


def _rim_mass(problem: CoDesignProblem, shape: DeviceShape) -> float:
    chosen, sizes = problem.selected, (shape.inner_radius, shape.outer_radius, shape.height)
    return wheel_body(*sizes, chosen.material.density, None, cuts=chosen.cuts).mass
