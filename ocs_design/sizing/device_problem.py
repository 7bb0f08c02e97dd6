"""What is to be sized, and what a given rim on it is up to."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.catalogue.materials import Material
from ocs_design.requirement.bound import SpinDemand, spin_demands
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.requirement import Requirement
from ocs_design.robot.mass_properties import MassProperties, combine
from ocs_design.sizing.cylinder import cylinder_spin_inertia, cylinder_transverse_inertia
from ocs_design.sizing.incidence import Criterion, incidence_by_criterion, module_axes
from ocs_design.sizing.momenta import design_momenta
from ocs_design.sizing.rim_closed_form import RimShape
from ocs_design.sizing.rim_problem import RimProblem


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

    def rim_problem(self, spin_inertia: float) -> RimProblem:
        """Of one wheel with this spin inertia [kg m^2]."""
        speed = self.requirement.wheel_speed_max
        return RimProblem(spin_inertia, self.envelope, self.material, speed)


def both_wheels(
    shape: RimShape, density: float, centers: FloatArray, incidence: float
) -> MassProperties:
    """Of both rims in B, braked.

    Args:
        shape: of one rim.
        density: [kg/m^3].
        centers: of the left and the right one in B [m], shape (2, 3).
        incidence: of their axes [rad].
    """
    inner, outer, height, mass = (float(value) for value in shape)
    spin = cylinder_spin_inertia(inner, outer, height, density)
    transverse = cylinder_transverse_inertia(inner, outer, height, density)
    axes = module_axes(incidence)
    com = (centers[0] + centers[1]) / 2.0
    apart = centers[0] - com
    own = 2.0 * transverse * np.eye(3) + (spin - transverse) * axes @ axes.T
    moved = 2.0 * mass * (apart @ apart * np.eye(3) - np.outer(apart, apart))
    return MassProperties(2.0 * mass, com, own + moved)


def braked_total(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> MassProperties:
    """Robot and both wheels as one rigid body in B; the robot alone if there is no rim yet."""
    if shape is None:
        return problem.robot
    centers = problem.place(float(shape.outer_radius), float(shape.height))
    return combine(
        [problem.robot, both_wheels(shape, problem.material.density, centers, incidence)]
    )


def device_demands(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> tuple[SpinDemand, ...]:
    """What each part of the requirement asks of a wheel, with the inertia at its own incidence.

    A maneuver with an incidence of its own turns the wheels, and with them their inertia.

    Args:
        problem: requirement and robot.
        shape: of both rims; None: of the robot alone.
        incidence: of the design [rad].
    """

    @cache
    def inertia_at(angle: float) -> FloatArray:
        """Of the whole with its wheels at this incidence [kg m^2], shape (3, 3)."""
        return braked_total(problem, shape, angle).inertia

    found: list[SpinDemand] = []
    for part in _parts(problem.requirement):
        own = part.maneuvers[0].incidence if part.maneuvers else None
        at = incidence if own is None else own
        found.extend(spin_demands(part, inertia_at(at), at))
    return tuple(found)


def chosen_incidence(problem: DeviceProblem, shape: RimShape | None, incidence: float) -> float:
    """The incidence of the design [rad], with the wheels standing at `incidence` so far."""
    if problem.incidence is not None:
        return problem.incidence
    if problem.criterion in {Criterion.WEIGHTED, Criterion.SIMULTANEOUS}:
        return best_incidences(problem, shape, incidence)[problem.criterion]
    # The others look at no momenta.
    return incidence_by_criterion(braked_total(problem, shape, incidence).inertia)[
        problem.criterion
    ]


def best_incidences(
    problem: DeviceProblem, shape: RimShape | None, incidence: float
) -> Mapping[Criterion, float]:
    """The best incidence under each criterion [rad], with the wheels standing at `incidence`."""
    inertia = braked_total(problem, shape, incidence).inertia
    return incidence_by_criterion(inertia, design_momenta(problem.requirement, inertia))


def _parts(requirement: Requirement) -> Iterator[Requirement]:
    """Each maneuver and the rate change by itself."""
    for maneuver in requirement.maneuvers:
        yield replace(requirement, maneuvers=(maneuver,), rate_change=None)
    yield replace(requirement, maneuvers=())
