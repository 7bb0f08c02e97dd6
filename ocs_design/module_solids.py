"""What a module fills, as cylinders in B: for what it is near, and what could hit it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Device, Module
from ocs_design.drive_solids import drive_solids, motor_mount
from ocs_design.robot.obstacles.probes import Drum
from ocs_design.sizing.foot import (
    BASE_THICKNESS,
    base_radius,
    wheel_height,
)
from ocs_design.sizing.housing import housing_height, housing_outer_radius
from ocs_design.sizing.placement import Size, module_size, wheel_size

_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ModuleSolids:
    """Of one module.

    Attributes:
        body: its housing, or its bare wheel where it has none, and what drives it as far as known.
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
    return ModuleSolids((housing, *_drive(device, module)), (_base(device, module),))


def device_size(device: Device) -> Size[float]:
    """The room that each module takes."""
    wheel, mount = device.flywheel, motor_mount(device)
    if device.carrier.mass == 0.0:
        return wheel_size(wheel.outer_radius, wheel.height)
    behind = mount.behind(device.motor)
    return module_size(wheel.outer_radius, wheel.height, *behind, mount.holes.reach)


def _drive(device: Device, module: Module) -> Iterator[Drum]:
    """What stands behind the foot's plate."""
    for solid in drive_solids(device):
        along = (solid.low + solid.high) / 2.0
        center = module.position + along * _outward(module) + solid.up * _UP
        yield Drum(center, module.axis, solid.radius, solid.high - solid.low)


def _base(device: Device, module: Module) -> Drum:
    wheel = device.flywheel
    reach = motor_mount(device).holes.reach
    radius = base_radius(wheel.outer_radius, wheel.height, reach)
    down = wheel_height(wheel.outer_radius) - BASE_THICKNESS / 2.0
    return Drum(module.position - down * _UP, _UP, radius, BASE_THICKNESS)


def _outward(module: Module) -> FloatArray:
    """Along the wheel's axis, away from the other module."""
    return module.axis if module.name == "left" else -module.axis
