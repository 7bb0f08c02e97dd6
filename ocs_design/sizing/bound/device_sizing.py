"""Size both wheels on the robot that carries them: incidence, spin inertia and rim at once."""

from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import Criterion
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_problem import (
    DeviceFixedPoint,
    DeviceProblem,
    best_incidences,
    braked_total,
    find_fixed_point,
)
from ocs_design.sizing.bound.infeasible import infeasible_device
from ocs_design.sizing.bound.rim_problem import check_limits
from ocs_design.sizing.bound.rim_program import RimSolution, solve_rim


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
    found = find_fixed_point(problem)
    if found.shape is None:
        raise infeasible_device(problem, found, size_device)
    rim = solve_rim(problem.rim_problem(found.spin_inertia))
    return DeviceSizing(
        **vars(found),
        total=braked_total(problem, found.shape, found.incidence),
        incidence_by_criterion=best_incidences(problem, found.shape, found.incidence),
        incidence_by_criterion_robot=best_incidences(problem, None, found.incidence),
        rim=rim,
        centers=problem.place(rim.outer_radius, rim.height),
    )
