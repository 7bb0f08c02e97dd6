"""What the validation tracks: each turn as optimal control plans it for the device at hand."""

from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from ocs_design.design import Device
from ocs_design.drive.line import DriveLine
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.optimal_control.reference import Reference, reference
from ocs_design.sizing.selection.candidate import braked


def plan(
    robot: MassProperties, device: Device, maneuvers: Sequence[Maneuver], standing_height: float
) -> Mapping[str, Reference]:
    """The turn of least effort for each maneuver by its name; none is planned for a push.

    Args:
        robot: without the device, in B.
        device: with a real motor.
        maneuvers: each at its own incidence, if it has one.
        standing_height: of the trunk over the ground [m].
    """
    line = drive_line_of(device)
    return {
        maneuver.name: reference(
            gyrostat_of(robot, device.as_flown(maneuver)), line, maneuver, standing_height
        )
        for maneuver in maneuvers
    }


def gyrostat_of(robot: MassProperties, device: Device) -> Gyrostat:
    """Robot and device as a rigid trunk with two wheels."""
    wheel = device.flywheel
    rim = Carrier(
        wheel.mass,
        wheel.spin_inertia - device.motor.rotor_inertia,
        wheel.transverse_inertia,
    )
    centers = np.stack([module.position for module in device.modules])
    whole = braked(robot, (rim, device.carrier), centers, device.incidence)
    return Gyrostat(whole.inertia, device.axes, wheel.spin_inertia, device.motor.armature)


def drive_line_of(device: Device) -> DriveLine:
    """What each drive does at its wheel, nothing held back."""
    motor = device.motor
    return DriveLine(
        stall_torque=inf if motor.stall_torque is None else motor.stall_torque,
        no_load_speed=motor.no_load_speed,
        torque_limit=inf if motor.torque_limit is None else motor.torque_limit,
        speed_max=inf if motor.speed_max is None else motor.speed_max,
    )
