"""The technical drawing of a design's wheel."""

import hashlib
import math
from pathlib import Path

import msgspec

from ocs_design import __version__
from ocs_design.design import Device
from ocs_design.drawing.wheel import WheelDrawing
from ocs_design.drawing.wheel_sheet import draw_wheel
from ocs_design.export.motor import highest_speed
from ocs_design.parts.wheel import Wheel

DIGITS = 12
"""Of the hash that says which design a sheet belongs to."""


def export_wheel_drawing(drawing: WheelDrawing, folder: Path) -> tuple[Path, ...]:
    """Write `wheel.svg` and `wheel.pdf`, which show the same."""
    written = []
    for suffix, content in draw_wheel(drawing).items():
        path = folder / f"wheel.{suffix}"
        path.write_bytes(content)
        written.append(path)
    return tuple(written)


def wheel_drawing(device: Device, wheel: Wheel, robot: str) -> WheelDrawing:
    """What the sheet says of a device's wheel.

    Args:
        device: both of its wheels are equal.
        wheel: as it is made.
        robot: its name.
    """
    speed = highest_speed(device.motor)
    return WheelDrawing(
        wheel=wheel,
        robot=robot,
        identity=device_hash(device),
        tool=f"ocs-design {__version__}",
        speed=speed if math.isfinite(speed) else None,
    )


def device_hash(device: Device) -> str:
    """Of wheel, motor and carrier as `design.json` has them: the same parts, the same digits."""
    parts = msgspec.json.encode((device.flywheel, device.motor, device.carrier))
    return hashlib.sha256(parts).hexdigest()[:DIGITS]
