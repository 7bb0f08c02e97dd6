"""Technical drawing of a design's wheel, as SVG and PDF; the files of all drawings."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.catalogue.materials import recorded_material
from ocs_design.common.units import significant
from ocs_design.device import joints
from ocs_design.device.device import Device
from ocs_design.device.joints import rim_fit
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.guard_sheet import guard_sheet
from ocs_design.export.drawing.plate_sheet import plate_sheets
from ocs_design.export.drawing.sheet import Item, Lettering
from ocs_design.export.drawing.title_block import (
    BLOCK_LEFT,
    BLOCK_TOP,
    BLOCK_WIDTH,
    Entries,
    complete_sheet,
    device_hash,
    title_of,
)
from ocs_design.export.drawing.views import front_view, lay_out, section_view
from ocs_design.export.drawing.wheel import (
    BROKEN_EDGE,
    WheelDrawing,
    broken_edge_losses,
    in_mm,
    inertia_error,
    inside_corners,
    seat_limits,
    workshop_holes,
)
from ocs_design.export.drawing.writers import both_formats, pdf_of_pages
from ocs_design.export.drilling import drilling_of, pages
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.joints import GRADE, SEAT_ROUGHNESS

if TYPE_CHECKING:
    from ocs_design.export.formats import Notes, Subject

PARTS_ROW = 5.5
"""Height of a row of the list of parts, which grows upwards from the title block [mm]."""

_PARTS_COLUMNS = (0.0, 12.0, 76.0, 150.0, BLOCK_WIDTH)
"""Edges of the columns item, name, material and mass [mm]."""

RUN_OUT = 1e3 * joints.RUN_OUT
"""Permissible run-out of the rim to the bore [mm]."""


_LEAST_SHARE = 1e-5
"""Share of the inertia that inside corners must add to be noted."""

_SMALL_SHARE = 1e-3
"""Share of the inertia by which lightening holes of a workshop's size may change it."""


def write(subject: "Subject", folder: Path) -> "Notes":
    """Write `wheel.svg`, the same as `wheel.pdf`, and the sheets of other parts.

    These are, if the device has them, `guard_ring.svg` and `.pdf`, `plate.pdf` and `drilling.pdf`.
    """
    drawing = wheel_drawing(subject.device, subject.name, subject.refused)
    drawn = {"wheel": draw_wheel(drawing)}
    if ring := guard_sheet(subject.device, subject.name, subject.refused):
        drawn["guard_ring"] = both_formats(ring, f"Guard ring of {subject.name}")
    for name, files in drawn.items():
        for suffix, content in files.items():
            (folder / f"{name}.{suffix}").write_bytes(content)
    if sheets := plate_sheets(subject.device, subject.name, subject.refused):
        title = f"Plate under the feet of {subject.name}"
        (folder / "plate.pdf").write_bytes(pdf_of_pages(sheets, title))
    if drilling := drilling_of(subject):
        title = f"Drilling template of {subject.name}"
        (folder / "drilling.pdf").write_bytes(pdf_of_pages(pages(drilling), title))
    return ()


def wheel_drawing(device: Device, robot: str, refused: str = "") -> WheelDrawing:
    """Content of the sheet of a device's wheel for the robot `robot`; all wheels are equal.

    `refused` says that the device cannot be built, and why.
    """
    material = recorded_material(device.flywheel.material)
    speed, fit, mounting = device.motor.top_speed, rim_fit(device), device.motor.mounting
    return WheelDrawing(
        wheel=device.flywheel.shape,
        robot=robot,
        identity=device_hash(device),
        speed=speed if math.isfinite(speed) else None,
        interference=None if fit is None else (2.0 * fit.least, 2.0 * fit.most),
        bonded=device.on_bell,
        on_shaft=mounting is not None and mounting.shaft_diameter is not None,
        yield_strength=None if material is None else material.yield_strength,
        order="" if material is None else material.order,
        refused=refused,
        count=len(device.modules),
    )


def wheel_sheet(drawing: WheelDrawing) -> list[Item]:
    """Section and front view in first-angle projection, notes, list of parts and title block."""
    layout, wheel = lay_out(drawing.wheel), drawing.wheel
    fine, material = "bore", wheel.rim.material
    if wheel.shrunk_on:
        fine, material = "all fits", "see list of parts"
    inertia = f"{significant(1e6 * drawing.mass_properties.inertia[2, 2], 4)} kg mm²"
    entries = Entries(
        title=title_of("OCS flywheel", drawing.count),
        robot=drawing.robot,
        scale=layout.scale,
        material=material,
        mass=sum(drawing.masses),
        figure=("Spin inertia about the axis", inertia),
        texture=f"Ra 3.2, {fine} Ra {1e6 * SEAT_ROUGHNESS:g} (ISO 21920)",
        identity=drawing.identity,
    )
    views = [*section_view(wheel, layout), *front_view(wheel, layout)]
    parts = parts_list(drawing)
    return complete_sheet(views, notes(drawing), entries, drawing.refused, parts=parts)


def parts_list(drawing: WheelDrawing) -> list[Item]:
    """Parts list of rim and web if they are two parts; otherwise empty."""
    wheel = drawing.wheel
    if wheel.web is None or not wheel.shrunk_on:
        return []
    rim_mass, hub_mass = drawing.masses
    bore, seat = seat_limits(drawing)
    rows = (
        ("2", f"Web with hub{seat}", wheel.web.material, f"{significant(1e3 * hub_mass, 4)} g"),
        ("1", f"Rim{bore}", wheel.rim.material, f"{significant(1e3 * rim_mass, 4)} g"),
        ("Item", "Name", "Material", "Mass"),
    )
    items: list[Item] = []
    for row, values in enumerate(rows, start=1):
        top = BLOCK_TOP - row * PARTS_ROW
        for value, start, end in zip(values, _PARTS_COLUMNS, _PARTS_COLUMNS[1:], strict=False):
            left, right = BLOCK_LEFT + start, BLOCK_LEFT + end
            items += sheet.outline(sheet.rectangle(left, top, right, top + PARTS_ROW), sheet.THIN)
            shown = sheet.truncated(value, right - left - 3.0, 2.5)
            items.append(Lettering((left + 1.5, top + 4.0), shown))
    return items


def notes(drawing: WheelDrawing) -> Iterator[str]:
    """Sentences below the views; no line ends at a tilde."""
    wheel = drawing.wheel
    balance = f"Balance grade G~{GRADE:g} (ISO~21940-11)"
    if drawing.speed is None:
        yield f"{balance} at the highest speed in service."
    else:
        mass, rpm = sum(drawing.masses), drawing.speed * 30.0 / math.pi
        eccentricity = 1e6 * joints.permissible_eccentricity(drawing.speed)
        unbalance, offset = (significant(value, 3) for value in (mass * eccentricity, eccentricity))
        yield (
            f"{balance} at {rpm:,.0f}~rpm: residual unbalance at most {unbalance}~g~mm "
            f"(e~=~{offset}~µm), in one plane. Done on the motor: cad/assembly.pdf."
        )
    yield (
        f"Spin inertia within ±{_percent(inertia_error(wheel))} over all tolerances together; the "
        "motor's rotor not included."
    )
    chamfer, web = wheel.rim.chamfer, wheel.web
    broken_edges = f"edges without indication broken {1e3 * BROKEN_EDGE:g}"
    if chamfer > 0.0 and web is not None and web.hub.chamfer > 0.0:
        yield (
            f"Edges of rim, hub and bore {in_mm(chamfer)}~×~45°, counted in mass and inertia; all "
            "others deburred."
        )
    elif chamfer > 0.0:
        yield f"Edges of the rim {in_mm(chamfer)}~×~45°; {broken_edges}."
    else:
        mass, share = broken_edge_losses(wheel)
        losses = f"{1e3 * mass:.2g}~g and {_percent(share)} of the inertia"
        yield f"{broken_edges.capitalize()}: those of the rim are {losses}, not taken off here."
    if drawing.yield_strength is not None:
        least = f"yield strength of at least {drawing.yield_strength / 1e6:.0f}~MPa"
        ordered = f"{drawing.order}, or one with a " if drawing.order else "one with a "
        of = "Rim's material" if wheel.shrunk_on else "Material"
        yield f"{of}: {ordered}{least}, as assumed in sizing; certificate~3.1 (EN~10204)."
    # Screws clamp a hub by its faces, and a short bore alone does not say where the axis points.
    datum = "the bore" if web is None or web.hub.bolts == 0 else "bore and hub faces"
    run_out = f"Run-out of the rim, around and on its faces, to {datum} at most {RUN_OUT:g}."
    if drawing.bonded:
        gap = in_mm(2.0 * GLUE_GAP)
        size = in_mm(2.0 * (wheel.rim.inner_radius - GLUE_GAP))
        yield (
            f"Bonded around the motor's bell: bore it {gap} wider than the bell, which is measured "
            f"first; the bore drawn is that for Ø{size}."
        )
        yield run_out
        return
    yield _rim_note(drawing)
    if web is not None:
        radius, share = inside_corners(wheel)
        if radius > 0.0:
            added = f" (+{_percent(share)} of inertia)" if share > _LEAST_SHARE else ""
            yield f"Inside corners at most R~{in_mm(radius)}{added}."
        diameter, share = workshop_holes(wheel)
        if diameter > 0.0 and abs(share) < _SMALL_SHARE:
            yield (
                f"Lightening holes may be Ø{1e3 * diameter:g}, all alike "
                f"({100.0 * share:+.2f}~% of inertia)."
            )
        yield run_out
        if web.hub.bolts == 0 and drawing.on_shaft:
            yield "No bolt circle: bonded on the motor's shaft."
        elif not drawing.on_shaft:
            yield "Bore: a pilot hole and the datum; open it to a boss of the rotor, H7."


def _rim_note(drawing: WheelDrawing) -> str:
    """How the rim is carried."""
    if drawing.wheel.web is None:
        return "Rim only: mass and inertia without the spokes and hub that it needs."
    if not drawing.wheel.shrunk_on:
        return (
            "Rim, web and hub turned from one piece, web and hub in the rim's middle; the web "
            "last, from both sides in turn, with a plug behind it."
        )
    if drawing.interference is None:
        return "Rim shrunk on the web; the fit is not computed."
    least, most = (f"{1e3 * value:.3f}" for value in drawing.interference)
    return (
        f"Rim shrunk on the web, its bore {least} to {most} narrower: the list of parts has both "
        "sizes."
    )


def _percent(fraction: float) -> str:
    return f"{100.0 * fraction:.2g}~%"


def draw_wheel(drawing: WheelDrawing) -> dict[str, bytes]:
    """Files of the drawing by their suffixes `svg` and `pdf`, reproducible byte for byte."""
    return both_formats(wheel_sheet(drawing), f"Flywheel of {drawing.robot}")
