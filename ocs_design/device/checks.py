"""Faults of a device in a `design.json`, and warnings about implausible ones.

Files are made from it without further checks, so invalid lengths, masses and directions are refused
here.
"""

from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass, replace
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.errors import OcsError, SpecificationError
from ocs_design.common.ranges import LARGEST_LENGTH, SMALLEST_LENGTH, ranges_of
from ocs_design.common.units import format_quantity
from ocs_design.device.device import Device
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import ControlRecord
from ocs_design.parts.carrier_plate import CarrierPlate, Mast
from ocs_design.parts.wheel import Flywheel
from ocs_design.requirement.vocabulary import is_whole_steps
from ocs_design.robot.mass import MassProperties

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_UNIT_TOLERANCE = 1e-6

_THICKNESS_TOLERANCE = 1e-4
"""Difference of two thicknesses that count as equal [m]: they are milled to a tenth of a
millimetre."""


def check_device(device: Device) -> None:
    """Refuse a device that cannot be made.

    Raises:
        OcsError: lists every fault.
    """
    faults = [*_figures(device), *_pedestal_faults(device)]
    if device.plate is not None:
        faults += _plate_faults(device.plate)
    if tuple(module.name for module in device.modules) != device.layout.names:
        faults.append(f"ocs.modules are not those of {device.layout.text}")
    for module in device.modules:
        axis = module.axis
        if np.abs(axis).max() > 2.0 or abs(float(axis @ axis) - 1.0) > _UNIT_TOLERANCE:
            faults.append(f"the axis of module {module.name} is not a unit vector")
        if not (np.abs(module.position) <= LARGEST_LENGTH).all():
            faults.append(f"the position of module {module.name} is out of range")
    _refuse("a device that cannot exist", [*faults, *_wheel_faults(device.flywheel)])


def check_control(control: ControlRecord) -> None:
    """Refuse a wheel law that cannot be flown.

    Raises:
        OcsError: lists every fault.
    """
    faults = [*_figures(control, "control")]
    if not is_whole_steps(control.period):
        given = format_quantity(control.period, "ms", 12)
        faults.append(f"control.period is {given}, not a whole number of milliseconds")
    _refuse("a wheel law that cannot be flown", faults)


def check_requirement(design: OcsDesign) -> None:
    """Refuse figures of robot, requirement and reserve that no flight can have.

    Raises:
        OcsError: lists every fault.
    """
    kept = None if design.selection is None else design.selection.kept
    # What a kind of maneuver may have is checked as it is restored; demands are not flown.
    faults = [
        *_figures(replace(design.requirement, maneuvers=(), demands=()), "requirement"),
        *_figures(design.robot, "robot"),
        *(() if kept is None else _figures(kept, "selection.kept")),
    ]
    if fault := ranges_of(OcsDesign)["seed"].fault(design.seed):
        faults.append(f"seed {fault}")
    _refuse("flights that cannot be", faults)


def _refuse(subject: str, faults: Sequence[str]) -> None:
    """Raise an error that lists the faults of a subject; nothing if there are none."""
    if faults:
        raise OcsError(
            f"the design describes {subject}: {'; '.join(faults)}",
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
    elif abs(thin - mast.spacer) > _THICKNESS_TOLERANCE:
        yield "plate.mast.spacer is not the least of plate.mast.formed"


def _pedestal_faults(device: Device) -> Iterator[str]:
    """Faults of pedestals: sizes or positions out of range, nonexistent modules."""
    if device.plate is not None and device.pedestals:
        yield "it has both a plate and pedestals"
    for pedestal in device.pedestals:
        places = np.array([*pedestal.position, pedestal.heading])
        if not (np.abs(places) <= LARGEST_LENGTH).all():
            yield "the position of a pedestal is out of range"
        if pedestal.module not in {module.name for module in device.modules}:
            yield f"a pedestal belongs to a module that does not exist: {pedestal.module}"


def _figures(record: "DataclassInstance", path: str = "") -> Iterator[str]:
    """Faults of every number of a record and of its parts, each by the range of its field."""
    ranges = ranges_of(type(record))
    for name, value in ((field.name, getattr(record, field.name)) for field in fields(record)):
        if name in ranges and value is not None and (fault := ranges[name].fault(value)):
            yield f"{path or 'ocs'}.{name} {fault}"
        for part in value if isinstance(value, tuple) else (value,):
            if is_dataclass(part) and not isinstance(part, type):
                yield from _figures(part, f"{path}.{name}".lstrip("."))


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
    warning = (
        f"the device weighs {device.mass:.3g} kg, {share:.0%} of the robot: more than {HEAVY:.0%} "
        "is unusual; whether the robot can carry it is not checked"
    )
    if strict:
        raise SpecificationError(
            f"--strict: {warning}", hint="Require less, or allow larger wheels."
        )
    return (warning,)
