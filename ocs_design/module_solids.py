"""What a module fills, as cylinders in B: for what it is near, and what could hit it."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Device, Module
from ocs_design.drive.gear import DIRECT
from ocs_design.robot.obstacles.probes import Drum
from ocs_design.sizing.foot import (
    BASE_THICKNESS,
    base_radius,
    plate_back,
    wheel_height,
)
from ocs_design.sizing.housing import half_height, housing_height, housing_outer_radius
from ocs_design.sizing.mount import mount_holes
from ocs_design.sizing.placement import Size, module_size, wheel_size

_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ModuleSolids:
    """Of one module.

    Attributes:
        body: its housing, or its bare wheel where it has none, and its motor where that is known.
        foot: the foot's base, which stands on the trunk.
    """

    body: tuple[Drum, ...]
    foot: tuple[Drum, ...] = ()

    @property
    def all(self) -> tuple[Drum, ...]:
        """Both."""
        return self.body + self.foot


def module_solids(device: Device, module: Module) -> ModuleSolids:
    """At the device's incidence."""
    radius, height = device.flywheel.outer_radius, device.flywheel.height
    if device.carrier.mass == 0.0:
        return ModuleSolids((Drum(module.position, module.axis, radius, height),))
    outside = housing_outer_radius(radius), housing_height(height)
    housing = Drum(module.position, module.axis, *outside)
    return ModuleSolids((housing, *_motor(device, module)), (_base(device, module),))


def device_size(device: Device) -> Size[float]:
    """The room that each module takes."""
    wheel, motor = device.flywheel, device.motor
    if device.carrier.mass == 0.0:
        return wheel_size(wheel.outer_radius, wheel.height)
    length, radius = motor.length or 0.0, (motor.diameter or 0.0) / 2.0
    reach = mount_holes(motor.mounting).reach
    return module_size(wheel.outer_radius, wheel.height, length, radius, reach)


def _motor(device: Device, module: Module) -> tuple[Drum, ...]:
    """On the back of the foot's plate; behind a gear its place is not known."""
    motor = device.motor
    if motor.gear != DIRECT.name or motor.diameter is None or motor.length is None:
        return ()
    behind = plate_back(half_height(device.flywheel.height)) + motor.length / 2.0
    center = module.position - behind * _outward(module)
    return (Drum(center, module.axis, motor.diameter / 2.0, motor.length),)


def _base(device: Device, module: Module) -> Drum:
    wheel = device.flywheel
    reach = mount_holes(device.motor.mounting).reach
    radius = base_radius(wheel.outer_radius, wheel.height, reach)
    down = wheel_height(wheel.outer_radius) - BASE_THICKNESS / 2.0
    return Drum(module.position - down * _UP, _UP, radius, BASE_THICKNESS)


def _outward(module: Module) -> FloatArray:
    """Along the wheel's axis, away from the other module."""
    return module.axis if module.name == "left" else -module.axis
