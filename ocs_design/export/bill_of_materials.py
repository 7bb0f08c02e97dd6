"""Bill of materials: parts to buy and to make for one device, as CSV for spreadsheets."""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.fasteners import STEEL
from ocs_design.actuation.motor import DIRECT
from ocs_design.device.device import Device, Flywheel, Web
from ocs_design.device.solids import motor_mount
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.device_parts import printed_foot, printed_parts
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.foot import TRUNK_SCREWS
from ocs_design.parts.housing import LID_SCREWS
from ocs_design.parts.printed import CLEARANCE, WALL

COLUMNS = ("part", "quantity", "material", "stock [mm]", "mass each [g]", "mass [g]", "source")

_ALLOWANCE = 2e-3
"""Allowance of stock on finished diameter and length, to turn clean and to part off [m]."""

_MASSLESS = 1e-9
"""Rounding of masses: what is left of a module when all its parts are taken off [kg]."""

_FORMULA_STARTS = ("=", "+", "-", "@")
"""Characters at which a spreadsheet takes a text for a formula (OWASP, "CSV Injection")."""


@dataclass(frozen=True)
class BillRow:
    """One kind of part.

    Attributes:
        part: name of the part.
        quantity: in the whole device.
        material: name.
        stock: to cut it from, with its sizes [mm].
        mass: of one [kg]; 0: not known.
        source: where it is from, or what to observe.
    """

    part: str
    quantity: int
    material: str
    stock: str
    mass: float
    source: str


def write(subject: Subject, folder: Path) -> Notes:
    """Write `bill_of_materials.csv`."""
    export_bill_of_materials(subject.device, folder / "bill_of_materials.csv")
    return ()


def bill_rows(device: Device) -> Sequence[BillRow]:
    """All parts that the device holds; together they weigh what it weighs."""
    motor, count = device.motor, len(device.modules)
    rows = list(_wheel(device.flywheel, count))
    if motor.mass > 0.0:
        supply = () if motor.bus_voltage is None else (f"on {motor.bus_voltage:g} V",)
        source = "; ".join([*supply, motor.source, *drive_notes(device)])
        rows.append(BillRow(f"motor {motor.name}", count, "", "", motor.mass, source))
    if motor.gear != DIRECT.name:
        source = f"ratio {motor.gear_ratio:g}; see `ocs-design catalogue gears -v`"
        rows.append(BillRow(f"gear {motor.gear}", count, "", "", motor.gear_mass, source))
    rating = controller_rating(motor)
    if rating:
        # Not chosen, so its mass is not known.
        source = f"for {rating}, of your choice; the device's mass does not include it"
        rows.append(BillRow("motor controller", count, "", "", 0.0, source))
    printed = device.carrier.mass - motor.mass - motor.gear_mass
    if printed > _MASSLESS:
        foot, mount = printed_foot(device), motor_mount(device)
        drum, lid, base, *caged = (part.mass_properties().mass for part in printed_parts(device))
        size = f"{_mm(2.0 * foot.housing.radius)} x {_mm(2.0 * foot.housing.half_height)}"
        made = f"3-D print, wall {_mm(WALL)}, {_mm(CLEARANCE)} clear of the rim"
        rows.append(BillRow("housing", count, "PETG", size, drum + lid, made))
        size = f"{_mm(2.0 * foot.base_radius)} x {_mm(foot.wheel_height)} to the axis"
        made = "3-D print, turned to the incidence by hand"
        rows.append(BillRow("foot", count, "PETG", size, base, made))
        if mount.cage is not None:
            size = f"{_mm(2.0 * mount.cage.reach)} x {_mm(mount.cage.length)}"
            made = "3-D print, holds the motor by its back"
            rows.append(BillRow("cage", count, "PETG", size, caged[0], made))
        # The screws of wheel and motor only where the catalogue has their threads.
        screwed = (each.fastening for each in mount.screwed)
        counted = f"mass: steel of {STEEL:g} kg/m^3 of its ISO 4762 dimensions"
        rows += [
            BillRow(
                part=f"screw {each.screw.designation(each.length)}",
                quantity=count * each.count,
                material="steel",
                stock="",
                mass=each.screw.mass(each.length),
                source=f"{each.purpose}; {counted}",
            )
            for each in (*screwed, LID_SCREWS, TRUNK_SCREWS)
        ]
    return rows


def export_bill_of_materials(device: Device, path: Path) -> Path:
    """Write the rows and their sum as CSV, UTF-8, masses to the milligram."""
    rows = bill_rows(device)
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            masses = [_grams(row.mass), _grams(row.quantity * row.mass)] if row.mass else ["", ""]
            cells = [row.part, str(row.quantity), row.material, row.stock, *masses, row.source]
            writer.writerow([plain(cell) for cell in cells])
        total = sum(row.quantity * row.mass for row in rows)
        # Designs of versions before 0.2 count no screws, and not all that holds the motor.
        remark = "as designed"
        if abs(total - device.mass) > _MASSLESS:
            remark = f"the design counts {_grams(device.mass)} g: size it again"
        writer.writerow(["total", "", "", "", "", _grams(total), remark])
    return path


def plain(text: str) -> str:
    """Text on one line that no spreadsheet takes for a formula."""
    line = " ".join(text.split())
    return f"'{line}" if line.startswith(_FORMULA_STARTS) else line


def _wheel(wheel: Flywheel, count: int) -> Iterator[BillRow]:
    """Wheel in one piece where rim and web are of one material, else a rim on its web."""
    web, cuts = wheel.web, wheel.cuts
    rim = f"turned to {_mm(2.0 * wheel.outer_radius)} x {_mm(wheel.height)}"
    if cuts.chamfer:
        rim += f", edges {_mm(cuts.chamfer)} x 45 deg"
    if cuts.holes:
        hole = f"{_mm(2.0 * cuts.hole_radius)} x {_mm(cuts.hole_depth)}"
        rim += f", {cuts.holes} balancing holes {hole} in each face"
    bore = f", bore {_mm(2.0 * wheel.inner_radius)}" if wheel.inner_radius > 0.0 else ""
    if web is None:
        stock = _stock(wheel.outer_radius, wheel.inner_radius, wheel.height)
        yield BillRow("flywheel rim", count, wheel.material, stock, wheel.mass, rim + bore)
    elif web.material == wheel.material:
        stock = _stock(wheel.outer_radius, 0.0, max(wheel.height, web.hub.height))
        made = f"{rim}, {_web(web)}"
        yield BillRow("flywheel, one piece", count, wheel.material, stock, wheel.mass, made)
    else:
        stock = _stock(wheel.outer_radius, wheel.inner_radius, wheel.height)
        seat = f"{rim}{bore}, seated on the web"
        yield BillRow("flywheel rim", count, wheel.material, stock, wheel.rim_mass, seat)
        stock = _stock(wheel.inner_radius, 0.0, max(web.thickness, web.hub.height))
        yield BillRow("flywheel web and hub", count, web.material, stock, web.mass, _web(web))


def _web(web: Web) -> str:
    hub = web.hub
    bolts = (
        f"{hub.bolts} holes {_mm(2.0 * hub.bolt_hole_radius)} "
        f"on a circle of {_mm(2.0 * hub.bolt_circle_radius)}"
        if hub.bolts
        else "bolt circle not in the catalogue: drill to the motor"
    )
    return f"web {_mm(web.thickness)}, hub bore {_mm(2.0 * hub.bore_radius)}, {bolts}"


def _stock(outer_radius: float, inner_radius: float, length: float) -> str:
    """Tube for a bore of more than half the diameter, else a bar; whole millimetres."""
    outside = math.ceil(_rounded(1e3 * (2.0 * outer_radius + _ALLOWANCE)))
    cut = math.ceil(_rounded(1e3 * (length + _ALLOWANCE)))
    if inner_radius <= 0.5 * outer_radius:
        return f"round bar {outside} x {cut}"
    inside = math.floor(_rounded(1e3 * (2.0 * inner_radius - _ALLOWANCE)))
    return f"tube {outside} x {inside} inside x {cut}"


def controller_rating(motor: Drive) -> str:
    """Current and voltage of a motor's controller; empty where its data do not tell them."""
    limit, k_t, supply = motor.torque_limit, motor.torque_constant, motor.bus_voltage
    if limit is None or k_t is None or supply is None:
        return ""
    current = limit / (motor.gear_ratio * motor.gear_efficiency * k_t)
    saturates = motor.saturation_torque is not None and limit > motor.saturation_torque
    return f"{'more than ' if saturates else ''}{math.ceil(_rounded(current))} A at {supply:g} V"


def _grams(mass: float) -> str:
    return f"{1e3 * mass:.3f}"


def _mm(length: float) -> str:
    return f"{1e3 * length:.2f}"


def _rounded(figure: float) -> float:
    """Figure to six decimals: what is a whole number but for rounding is whole."""
    return round(figure, 6)
