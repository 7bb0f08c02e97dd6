"""The wheel law that flights are flown with, stated and recorded, and what they track."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ocs_design.design import Device
from ocs_design.design_file import ControlRecord
from ocs_design.exceptions import SpecificationError
from ocs_design.jumping.jump import JumpPlans
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.specification import CONTROL_PERIOD, ValidationSection
from ocs_design.robot.robot import Robot
from ocs_design.simulation.controller import Allocation, Gains
from ocs_design.simulation.scenario import Options
from ocs_design.simulation.scene import STEP
from ocs_design.simulation.world import wheel_gains
from ocs_design.sizing.trajectory import Trajectory

if TYPE_CHECKING:
    from ocs_design.sizing.optimal_control.reference import Reference


def control_of(stated: ValidationSection, robot: Robot) -> ControlRecord:
    """What is stated, and the defaults that hold in place of the rest."""
    default = wheel_gains(robot)
    return ControlRecord(
        projection=stated.projection or Allocation.PSEUDO_INVERSE,
        kp=stated.kp or default.stiffness,
        kd=stated.kd or default.damping,
        period=_period(stated),
        desaturate=bool(stated.desaturate),
        ballistic=bool(stated.ballistic),
    )


def flight_options(control: ControlRecord) -> Options:
    """Flights under this law."""
    return Options(
        allocation=Allocation(control.projection),
        gains=Gains(control.kp, control.kd),
        hold=round(control.period / STEP),
        desaturate=control.desaturate,
    )


def overridden(control: ControlRecord, stated: ValidationSection) -> ControlRecord:
    """What was recorded, with everything that is stated in its place."""
    return ControlRecord(
        projection=stated.projection or control.projection,
        kp=stated.kp or control.kp,
        kd=stated.kd or control.kd,
        period=control.period if stated.control_period is None else _period(stated),
        desaturate=control.desaturate if stated.desaturate is None else stated.desaturate,
        ballistic=control.ballistic if stated.ballistic is None else stated.ballistic,
    )


def _period(stated: ValidationSection) -> float:
    """The control period [s].

    Raises:
        SpecificationError: it is no whole number of the physics' steps.
    """
    steps = (stated.control_period or CONTROL_PERIOD) / STEP
    if steps < 0.5 or abs(steps - round(steps)) > 1e-6:
        raise SpecificationError(
            f"validation.control_period: {steps * STEP:.4g} s is no whole number of milliseconds"
        )
    return round(steps) * STEP


def trajectories(plans: Mapping[str, "Reference"]) -> Mapping[str, Trajectory]:
    """What flights track; a maneuver without any is met by feedback or by a smooth turn."""
    return {
        name: planned.trajectory
        for name, planned in plans.items()
        if planned.trajectory is not None
    }


def jump_plans(
    control: ControlRecord, robot: Robot, device: Device, maneuvers: Sequence[Maneuver]
) -> Mapping[str, JumpPlans]:
    """How the legs make the maneuvers from the ground; none where flights start at lift-off."""
    if control.ballistic:
        return {}
    # CasADi takes a third of a second to import, and what starts at lift-off does without.
    from ocs_design.jumping.planning import plan_jumps  # noqa: PLC0415

    return plan_jumps(robot, device, maneuvers)
