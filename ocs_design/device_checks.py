"""Whether the device in a `design.json` can be one: people and programs edit such files.

Files are made from it without a second look, so what is no length, mass or direction ends here.
"""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from math import isfinite

import numpy as np

from ocs_design.design import Device, Module
from ocs_design.exceptions import OcsError

LARGEST = 1e12
"""Of any figure of a device, SI: stresses reach 1e9."""

LARGEST_LENGTH, SMALLEST_LENGTH = 100.0, 1e-7
"""Of a wheel's dimensions [m]."""

MOST_BOLTS = 100
"""And holes of any other ring."""

_OR_NONE = (
    *("inner_radius", "bore_radius", "bolt_circle_radius", "bolt_hole_radius", "length"),
    *("chamfer", "hole_radius", "hole_depth"),
)
_OF_GEARS = ("gear_room.depth", "offset", "wheel_radius", "motor_radius", "center")
"""Lengths [m] that are zero where there is no such thing."""

_LENGTHS = {"outer_radius", "height", "thickness", "radius", "diameter"}
_POSITIVE = {"density", "mass", "spin_inertia", "gear_efficiency", "no_load_speed", "speed_max"}
_POSITIVE |= {
    "stall_torque",
    "torque_limit",
    "saturation_torque",
    "torque_constant",
    "resistance",
    "bus_voltage",
}
_POSITIVE |= {"rated_voltage"}
_ANY_SIGN = {"rotor_inertia", "gear_ratio", "stress_margin", "armature"}
_ANY_SIGN |= {"along", "up", "product_of_inertia"}
_MAY_BE_ZERO = {"motor.mass", "carrier.mass"}

_UNIT_TOLERANCE = 1e-6


def check_device(device: Device) -> None:
    """Refuse a device that cannot be made.

    Raises:
        OcsError: with every fault.
    """
    faults = list(_faults(device))
    if faults:
        raise OcsError(
            f"the design's device cannot be: {'; '.join(faults)}",
            hint="run `ocs-design size` again to write the design anew",
        )


def _faults(device: Device) -> Iterator[str]:
    for part in ("flywheel", "motor", "carrier"):
        yield from _figures(getattr(device, part), part)
    if not isfinite(device.incidence):
        yield f"ocs.incidence is {device.incidence}"
    for module in device.modules:
        yield from _module_faults(module)
    wheel = device.flywheel
    if wheel.inner_radius >= wheel.outer_radius:
        yield "flywheel.inner_radius is not below outer_radius"
    if wheel.web is not None and wheel.web.mass >= wheel.mass:
        yield "flywheel.web.mass is not below the wheel's mass"


def _figures(value: object, path: str) -> Iterator[str]:
    """Faults of every number at or below a value."""
    if is_dataclass(value):
        for each in fields(value):
            yield from _figures(getattr(value, each.name), f"{path}.{each.name}")
    elif path.endswith((".bolts", ".holes")) and not 0 <= _number(value) <= MOST_BOLTS:
        yield f"{path} is {value}"
    elif isinstance(value, float):
        low, high = _range(path)
        absent = value == 0.0 and path.endswith(_OR_NONE + _OF_GEARS)
        if not absent and not low <= value <= high:
            yield f"{path} is {value:g}, not between {low:g} and {high:g}"


def _range(path: str) -> tuple[float, float]:
    """Smallest and largest value of a figure."""
    name = path.rpartition(".")[2]
    if name in _LENGTHS or path.endswith(_OR_NONE + _OF_GEARS):
        return SMALLEST_LENGTH, LARGEST_LENGTH
    if name in _ANY_SIGN:
        return -LARGEST, LARGEST
    return (1e-15 if name in _POSITIVE and path not in _MAY_BE_ZERO else 0.0), LARGEST


def _number(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0


def _module_faults(module: Module) -> Iterator[str]:
    axis = module.axis
    if np.abs(axis).max() > 2.0 or abs(float(axis @ axis) - 1.0) > _UNIT_TOLERANCE:
        yield f"the axis of module {module.name} is no unit vector"
    if not (np.abs(module.position) <= LARGEST_LENGTH).all():
        yield f"the position of module {module.name} is beyond all measure"
