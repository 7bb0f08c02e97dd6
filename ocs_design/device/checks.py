"""Faults of a device in a `design.json`, and warnings about implausible ones.

Files are made from it without further checks, so invalid lengths, masses and directions are refused
here.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import fields, is_dataclass
from math import hypot, inf, isfinite, pi

import numpy as np

from ocs_design.actuation.fasteners import CLASSES, SCREW_NAMES
from ocs_design.common.errors import OcsError, SpecificationError
from ocs_design.device.device import Device, Flywheel
from ocs_design.parts.carrier_plate import CarrierPlate, Mast
from ocs_design.parts.rim import LIGHTENED
from ocs_design.robot.mass import MassProperties

LARGEST = 1e12
"""Largest figure of a device, SI: stresses reach 1e9."""

LARGEST_LENGTH, SMALLEST_LENGTH = 100.0, 1e-7
"""Limits of a wheel's dimensions [m]."""

MOST_BOLTS = 100
"""Largest number of bolts or holes in a ring."""

_OR_NONE = (
    *("inner_radius", "bore_radius", "bolt_circle_radius", "bolt_hole_radius", "length"),
    *("chamfer", "hole_radius", "hole_depth"),
)
_OF_GEARS = ("gear_room.depth", "offset", "wheel_radius", "motor_radius", "center")
"""Lengths [m] that are zero where the feature is absent."""

_LENGTHS = {
    "outer_radius",
    "height",
    "thickness",
    "radius",
    "diameter",
    "half_length",
    "sleeve_wall",
}
_POSITIVE = {
    *("density", "mass", "spin_inertia", "gear_efficiency", "no_load_speed", "speed_max"),
    *("stall_torque", "torque_limit", "saturation_torque", "torque_constant", "resistance"),
    *("bus_voltage", "rated_voltage", "gear_ratio"),
}
_ANY_SIGN = {
    *("rotor_inertia", "stress_margin", "armature"),
    *("along", "up", "product_of_inertia"),
}
_MAY_BE_ZERO = {"motor.mass", "carrier.mass"}

_CHOICES: Mapping[str, Collection[str | int]] = {
    "thread": SCREW_NAMES,
    "foot_thread": SCREW_NAMES,
    "screws": CLASSES,
    "lightening": LIGHTENED,
}
"""Allowed words and numbers, by the name of the figure."""

_UNIT_TOLERANCE = 1e-6

_ROUNDED = 1e-4
"""Difference of two thicknesses that count as equal [m]: they are milled to a tenth of a
millimetre."""


def check_device(device: Device) -> None:
    """Refuse a device that cannot be made.

    Raises:
        OcsError: lists every fault.
    """
    faults = [
        fault
        for part in ("flywheel", "motor", "carrier", "plate")
        for fault in _figures(getattr(device, part), part)
    ]
    faults += _pedestal_faults(device)
    if device.plate is not None:
        faults += _plate_faults(device.plate)
    if not 0.0 <= device.guard_wall <= LARGEST_LENGTH:
        faults.append(_outside("ocs.guard_wall", device.guard_wall, 0.0, LARGEST_LENGTH))
    if not SMALLEST_LENGTH <= device.foot_plate <= LARGEST_LENGTH:
        faults.append(
            _outside("ocs.foot_plate", device.foot_plate, SMALLEST_LENGTH, LARGEST_LENGTH)
        )
    if device.supply is not None:
        # An absent limit is infinite.
        for name, highest in (("voltage", LARGEST), ("current_max", inf), ("power_max", inf)):
            value = getattr(device.supply, name)
            if not 0.0 < value <= highest:
                faults.append(f"supply.{name} is {value:g}, not positive")
    if not isfinite(device.incidence):
        faults.append(f"ocs.incidence is {device.incidence}, not finite")
    if tuple(module.name for module in device.modules) != device.layout.names:
        faults.append(f"ocs.modules are not those of {device.layout.text}")
    for module in device.modules:
        axis = module.axis
        if np.abs(axis).max() > 2.0 or abs(float(axis @ axis) - 1.0) > _UNIT_TOLERANCE:
            faults.append(f"the axis of module {module.name} is not a unit vector")
        if not (np.abs(module.position) <= LARGEST_LENGTH).all():
            faults.append(f"the position of module {module.name} is out of range")
    faults += _wheel_faults(device.flywheel)
    if faults:
        raise OcsError(
            f"the design describes a device that cannot exist: {'; '.join(faults)}",
            hint="run `ocs-design size` again to write a new design",
        )


def _wheel_faults(wheel: Flywheel) -> Iterator[str]:
    """Faults of a wheel beyond single figures: parts that do not fit within each other."""
    if wheel.inner_radius >= wheel.outer_radius:
        yield "flywheel.inner_radius is not below outer_radius"
    if wheel.web is not None and wheel.web.hub.radius >= wheel.inner_radius:
        yield "flywheel.web.hub.radius is not below inner_radius"
    if wheel.web is not None and wheel.web.mass >= wheel.mass:
        yield "flywheel.web.mass is not below the wheel's mass"


def _plate_faults(plate: CarrierPlate) -> Iterator[str]:
    """Faults of a plate beyond single figures: numbers and positions of holes."""
    if len(plate.trunk) != len(plate.sleeves):
        yield "plate.trunk and plate.sleeves must have the same length"
    if plate.arms < 2 or not plate.shape.fits:
        yield "plate.half_length leaves no room between its ends"
    if plate.levels and len(plate.levels) != len(plate.rows):
        yield "plate.rows and plate.levels must have the same length"
    mast = plate.mast
    if mast is not None and not (plate.trunk and 0.0 < 2.0 * mast.wall < mast.side):
        yield "plate.mast has no bore or no screws"
    if mast is not None and not (mast.low < mast.high and mast.back > 0.0 <= mast.spacer):
        yield "plate.mast has an end or an arm of zero length"
    yield from () if mast is None or not mast.formed else _form_faults(mast)
    if not 0.0 < plate.neck <= plate.radius:
        yield "plate.neck is not between 0 and plate.radius"
    for name in ("feet",) if mast is not None else ("feet", "trunk"):
        for x, y in getattr(plate, name):
            if min(hypot(x - row, y) for row in plate.rows) > plate.half_length:
                yield f"plate.{name} has a hole at ({x:g}, {y:g}), beyond plate.half_length"
    lengths = np.array([*plate.position, *plate.sleeves, *np.ravel([*plate.trunk, *plate.feet])])
    if not (np.abs(lengths) <= LARGEST_LENGTH).all() or min(plate.sleeves, default=0.0) < 0.0:
        yield "a position on the plate is out of range"


def _form_faults(mast: Mast) -> Iterator[str]:
    """Faults of a block shaped to the trunk."""
    columns = {len(row) for row in mast.formed}
    if len(mast.formed) < 2 or len(columns) > 1 or min(columns) < 2:
        yield "plate.mast.formed is not a grid"
        return
    thin, thick = min(map(min, mast.formed)), max(map(max, mast.formed))
    if not SMALLEST_LENGTH <= thin <= thick <= LARGEST_LENGTH:
        yield "plate.mast.formed has a thickness out of range"
    elif abs(thin - mast.spacer) > _ROUNDED:
        yield "plate.mast.spacer is not the least of plate.mast.formed"


def _pedestal_faults(device: Device) -> Iterator[str]:
    """Faults of pedestals: sizes or positions out of range, nonexistent modules."""
    if device.plate is not None and device.pedestals:
        yield "it has both a plate and pedestals"
    for pedestal in device.pedestals:
        for name in _PEDESTAL_LENGTHS:
            size = getattr(pedestal, name)
            if not SMALLEST_LENGTH <= size <= LARGEST_LENGTH:
                yield _outside(f"pedestals.{name}", size, SMALLEST_LENGTH, LARGEST_LENGTH)
        if not _UNIT_TOLERANCE < pedestal.lean <= pi / 2.0 + _UNIT_TOLERANCE:
            yield _outside("pedestals.lean", pedestal.lean, _UNIT_TOLERANCE, pi / 2.0)
        places = np.array([*pedestal.position, pedestal.heading])
        if not (np.abs(places) <= LARGEST_LENGTH).all():
            yield "the position of a pedestal is out of range"
        if pedestal.module not in {module.name for module in device.modules}:
            yield f"a pedestal belongs to a module that does not exist: {pedestal.module}"


_PEDESTAL_LENGTHS = "base_radius", "slot_radius", "wheel_height", "middle", "thickness", "base"


def _figures(value: object, path: str) -> Iterator[str]:
    """Faults of every number in a value, recursively."""
    if is_dataclass(value):
        for each in fields(value):
            yield from _figures(getattr(value, each.name), f"{path}.{each.name}")
    elif path.rpartition(".")[2] in _CHOICES:
        known = _CHOICES[path.rpartition(".")[2]]
        if value not in known:
            yield f"{path} is {value!r}, which is not one of {', '.join(map(str, known))}"
    elif path.endswith((".bolts", ".holes")) and isinstance(value, int | float):
        if not 0 <= value <= MOST_BOLTS:
            yield _outside(path, value, 0, MOST_BOLTS)
    elif isinstance(value, float):
        name = path.rpartition(".")[2]
        if name in _LENGTHS or path.endswith(_OR_NONE + _OF_GEARS):
            low, high = SMALLEST_LENGTH, LARGEST_LENGTH
        elif name in _ANY_SIGN:
            low, high = -LARGEST, LARGEST
        else:
            low, high = (1e-15 if name in _POSITIVE and path not in _MAY_BE_ZERO else 0.0), LARGEST
        absent = value == 0.0 and path.endswith(_OR_NONE + _OF_GEARS)
        if not absent and not low <= value <= high:
            yield _outside(path, value, low, high)


def _outside(path: str, value: float, low: float, high: float) -> str:
    """Fault of a figure that is out of its range."""
    return f"{path} is {value:g}, not between {low:g} and {high:g}"


HEAVY = 0.3
"""Fraction of the robot's mass above which a device is unusual; Solo12's lightest device has 0.07,
the paper's wheels 0.08."""


def device_warnings(
    device: Device, robot: MassProperties, *, strict: bool = False
) -> tuple[str, ...]:
    """Warnings about a device, one sentence each.

    Args:
        device: as designed.
        robot: without it, in B.
        strict: whether warnings are errors.

    Raises:
        SpecificationError: `strict`, and there is a warning.
    """
    share = device.mass / robot.mass
    if share <= HEAVY:
        return ()
    heavy = (
        f"the device weighs {device.mass:.3g} kg, {share:.0%} of the robot: more than {HEAVY:.0%} "
        "is unusual; whether the robot can carry it is not checked"
    )
    if strict:
        raise SpecificationError(f"--strict: {heavy}", hint="Require less, or allow larger wheels.")
    return (heavy,)
