"""What is known of a sized device, whichever way it was sized."""

from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.requirement.bound import SpinDemand
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.device_sizing import DeviceSizing
from ocs_design.sizing.incidence import Criterion


@dataclass(frozen=True, eq=False)
class Sized:
    """The figures behind a design.

    Attributes:
        wheel_speed_max: that the design may use [rad/s].
        incidence_by_criterion: the best one under each criterion, with the device [rad].
        incidence_by_criterion_robot: the same for the robot alone.
        demands: what each part of the requirement asks of a wheel.
        total: robot and device, braked, in B.
        status, method: of the optimum. objective: what was minimised [kg].
        binding: limits that hold the mass up.
        shadow_prices: change of the mass of one module per change of each binding limit [kg per SI
            unit of the limit].
        gap: relative, of the optimum.
        residual: of the fixed point, relative. iterations: to it.
    """

    wheel_speed_max: float
    incidence_by_criterion: Mapping[Criterion, float]
    incidence_by_criterion_robot: Mapping[Criterion, float]
    demands: tuple[SpinDemand, ...]
    total: MassProperties
    status: str
    method: str
    objective: float
    binding: tuple[str, ...]
    shadow_prices: Mapping[str, float]
    gap: float
    residual: float
    iterations: int


def sized_by_bound(sizing: DeviceSizing, wheel_speed_max: float) -> Sized:
    """Wheels without a motor.

    Args:
        sizing: of the wheels.
        wheel_speed_max: stated or assumed [rad/s].
    """
    rim = sizing.rim
    return Sized(
        wheel_speed_max=wheel_speed_max,
        incidence_by_criterion=sizing.incidence_by_criterion,
        incidence_by_criterion_robot=sizing.incidence_by_criterion_robot,
        demands=sizing.demands,
        total=sizing.total,
        status=rim.status,
        method=rim.method,
        objective=rim.mass,
        binding=rim.binding,
        shadow_prices=rim.shadow_prices,
        gap=rim.gap,
        residual=sizing.residual,
        iterations=sizing.iterations,
    )
