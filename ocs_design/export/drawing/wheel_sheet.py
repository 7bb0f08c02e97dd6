"""Technical drawing of a design's wheel, as SVG and PDF."""

import hashlib
import math
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from ocs_design import __version__
from ocs_design.catalogue.materials import materials
from ocs_design.device.device import Device
from ocs_design.device.joints import rim_fit
from ocs_design.export.device_parts import wheel_geometry
from ocs_design.export.drawing.plate_sheet import plate_sheets
from ocs_design.export.drawing.sheet import HEIGHT, WIDTH, Item
from ocs_design.export.drawing.title_block import (
    frame,
    notes,
    parts_list,
    title_block,
    wheel_entries,
)
from ocs_design.export.drawing.views import front_view, lay_out, section_view
from ocs_design.export.drawing.wheel import WheelDrawing
from ocs_design.export.drawing.writers import pdf_of_pages, svg_text
from ocs_design.export.drilling import drilling_of, drilling_pdf

if TYPE_CHECKING:
    from ocs_design.export.formats import Notes, Subject

DIGITS = 12
"""Length of the hash that says which design a sheet belongs to."""


def write(subject: "Subject", folder: Path) -> "Notes":
    """Write `wheel.svg` and `wheel.pdf`, which show the same, `plate.pdf` and `drilling.pdf`."""
    for suffix, content in draw_wheel(wheel_drawing(subject.device, subject.name)).items():
        (folder / f"wheel.{suffix}").write_bytes(content)
    identity = device_hash(subject.device), f"ocs-design {__version__}"
    if sheets := plate_sheets(subject.device, subject.name, *identity):
        title = f"Plate under the feet of {subject.name}"
        (folder / "plate.pdf").write_bytes(pdf_of_pages(sheets, title))
    if drilling := drilling_of(subject):
        (folder / "drilling.pdf").write_bytes(drilling_pdf(drilling))
    return ()


def wheel_drawing(device: Device, robot: str) -> WheelDrawing:
    """Content of the sheet of a device's wheel; all its wheels are equal.

    Args:
        device: that the wheel belongs to.
        robot: its name.
    """
    material = materials().get(device.flywheel.material)
    speed, fit, mounting = device.motor.top_speed, rim_fit(device), device.motor.mounting
    return WheelDrawing(
        wheel=wheel_geometry(device.flywheel),
        robot=robot,
        identity=device_hash(device),
        tool=f"ocs-design {__version__}",
        speed=speed if math.isfinite(speed) else None,
        interference=None if fit is None else (2.0 * fit.least, 2.0 * fit.most),
        bonded=device.on_bell,
        on_shaft=mounting is not None and mounting.shaft_diameter is not None,
        yield_strength=None if material is None else material.yield_strength,
    )


def device_hash(device: Device) -> str:
    """Hash of wheel, motor and carrier as `design.json` has them: the same for the same parts."""
    parts = msgspec.json.encode((device.flywheel, device.motor, device.carrier))
    return hashlib.sha256(parts).hexdigest()[:DIGITS]


def wheel_sheet(drawing: WheelDrawing) -> list[Item]:
    """Section and front view in first-angle projection, notes, list of parts and title block."""
    layout = lay_out(drawing.wheel)
    return [
        *frame(),
        *section_view(drawing.wheel, layout),
        *front_view(drawing.wheel, layout),
        *notes(drawing),
        *parts_list(drawing),
        *title_block(wheel_entries(drawing, layout.scale)),
    ]


def draw_wheel(drawing: WheelDrawing) -> dict[str, bytes]:
    """Files of the drawing by the suffixes `svg` and `pdf`; the same bytes every time."""
    items, title = wheel_sheet(drawing), f"Flywheel of {drawing.robot}"
    picture = svg_text(items, title, (0.0, 0.0, WIDTH, HEIGHT)) + "\n"
    return {"svg": picture.encode(), "pdf": pdf_of_pages([items], title)}
