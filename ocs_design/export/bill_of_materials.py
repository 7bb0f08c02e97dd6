"""What to buy and to make for one device, as a table for spreadsheets."""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ocs_design.design import Device, Flywheel, Motor, Web
from ocs_design.drive.gear import DIRECT
from ocs_design.drive_solids import motor_mount
from ocs_design.export.fastenings import fastenings
from ocs_design.export.fitting import standing_remarks
from ocs_design.export.workshop import printed_foot, printed_parts
from ocs_design.fasteners import STEEL
from ocs_design.sizing.housing import CLEARANCE, WALL

COLUMNS = ("part", "quantity", "material", "stock [mm]", "mass each [g]", "mass [g]", "source")

_ALLOWANCE = 2e-3
"""Of stock over the finished diameter and length, to turn clean and to part off [m]."""

_MASSLESS = 1e-9
"""Of what is left of a module's mass when all its parts are taken off: rounding [kg]."""

_FORMULA_STARTS = ("=", "+", "-", "@")
"""With these a spreadsheet takes a text for a formula (OWASP, "CSV Injection")."""


@dataclass(frozen=True)
class BillRow:
    """One kind of part.

    Attributes:
        part: what it is. material: of what. stock: what to cut it from, mm.
        quantity: in the whole device.
        mass: of one [kg]; 0: not known.
        source: where it is from, or what to mind.
    """

    part: str
    quantity: int
    material: str
    stock: str
    mass: float
    source: str


def bill_rows(device: Device) -> Sequence[BillRow]:
    """All parts that the device holds; together they weigh what it weighs."""
    wheel, motor = device.flywheel, device.motor
    rows = list(_wheel(wheel))
    if motor.mass > 0.0:
        rows.append(_motor(device))
    if motor.gear != DIRECT.name:
        rows.append(_gear(motor))
    rows += _controllers(motor)
    standing = device.carrier.mass - motor.mass - motor.gear_mass
    if standing > _MASSLESS:
        rows += [*_printed(device), *_screws(device)]
    return rows


def export_bill_of_materials(device: Device, path: Path) -> Path:
    """Write the rows and their sum as CSV, UTF-8, masses to the milligram.

    Args:
        device: to list.
        path: of the CSV.
    """
    rows = bill_rows(device)
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            writer.writerow([plain(cell) for cell in _cells(row)])
        total = sum(row.quantity * row.mass for row in rows)
        writer.writerow(["total", "", "", "", "", _grams(total), _as_designed(device, total)])
    return path


def plain(text: str) -> str:
    """Text on one line that no spreadsheet takes for a formula."""
    line = " ".join(text.split())
    return f"'{line}" if line.startswith(_FORMULA_STARTS) else line


def _cells(row: BillRow) -> tuple[str, ...]:
    return (
        row.part,
        str(row.quantity),
        row.material,
        row.stock,
        _grams(row.mass) if row.mass else "",
        _grams(row.quantity * row.mass) if row.mass else "",
        row.source,
    )


def _as_designed(device: Device, total: float) -> str:
    """Designs of versions before 0.2 count no screws, and not all that holds the motor."""
    if abs(total - device.mass) <= _MASSLESS:
        return "as designed"
    return f"the design counts {_grams(device.mass)} g: size it again"


def _motor(device: Device) -> BillRow:
    motor = device.motor
    supply = () if motor.bus_voltage is None else (f"on {motor.bus_voltage:g} V",)
    told = "; ".join([*supply, motor.source, *standing_remarks(device)])
    return BillRow(f"motor {motor.name}", 2, "", "", motor.mass, told)


def _wheel(wheel: Flywheel) -> Iterator[BillRow]:
    """In one piece where rim and web are of one material, else a rim on its web."""
    web = wheel.web
    rim = f"turned to {_mm(2.0 * wheel.outer_radius)} x {_mm(wheel.height)}{_cuts(wheel)}"
    bore = f", bore {_mm(2.0 * wheel.inner_radius)}" if wheel.inner_radius > 0.0 else ""
    if web is None:
        stock = _stock(wheel.outer_radius, wheel.inner_radius, wheel.height)
        yield BillRow("flywheel rim", 2, wheel.material, stock, wheel.mass, rim + bore)
    elif web.material == wheel.material:
        stock = _stock(wheel.outer_radius, 0.0, max(wheel.height, web.hub.height))
        made = f"{rim}, {_web(web)}"
        yield BillRow("flywheel, one piece", 2, wheel.material, stock, wheel.mass, made)
    else:
        stock = _stock(wheel.outer_radius, wheel.inner_radius, wheel.height)
        seat = f"{rim}{bore}, seated on the web"
        yield BillRow("flywheel rim", 2, wheel.material, stock, wheel.rim_mass, seat)
        stock = _stock(wheel.inner_radius, 0.0, max(web.thickness, web.hub.height))
        yield BillRow("flywheel web and hub", 2, web.material, stock, web.mass, _web(web))


def _cuts(wheel: Flywheel) -> str:
    """Chamfers and balancing holes, before a comma; empty without any."""
    cuts = wheel.cuts
    edges = f", edges {_mm(cuts.chamfer)} x 45 deg" if cuts.chamfer else ""
    if cuts.holes == 0:
        return edges
    holes = f"{cuts.holes} balancing holes {_mm(2.0 * cuts.hole_radius)} x {_mm(cuts.hole_depth)}"
    return f"{edges}, {holes} in each face"


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
    """A tube for a bore of more than half the diameter, else a bar; whole millimetres."""
    outside = math.ceil(_rounded(1e3 * (2.0 * outer_radius + _ALLOWANCE)))
    cut = math.ceil(_rounded(1e3 * (length + _ALLOWANCE)))
    if inner_radius <= 0.5 * outer_radius:
        return f"round bar {outside} x {cut}"
    inside = math.floor(_rounded(1e3 * (2.0 * inner_radius - _ALLOWANCE)))
    return f"tube {outside} x {inside} inside x {cut}"


def _gear(motor: Motor) -> BillRow:
    source = f"ratio {motor.gear_ratio:g}; see `ocs-design catalogue gears -v`"
    return BillRow(f"gear {motor.gear}", 2, "", "", motor.gear_mass, source)


def controller_rating(motor: Motor) -> str:
    """What a motor's controller must give; empty without a limit, k_t or supply to tell it from."""
    limit, k_t, supply = motor.torque_limit, motor.torque_constant, motor.bus_voltage
    if limit is None or k_t is None or supply is None:
        return ""
    current = limit / (motor.gear_ratio * motor.gear_efficiency * k_t)
    saturates = motor.saturation_torque is not None and limit > motor.saturation_torque
    return f"{'more than ' if saturates else ''}{math.ceil(_rounded(current))} A at {supply:g} V"


def _controllers(motor: Motor) -> Iterator[BillRow]:
    """Not chosen: what they weigh is not known."""
    rating = controller_rating(motor)
    if rating:
        told = f"for {rating}, of your choice; not weighed, not in the device's mass"
        yield BillRow("motor controller", 2, "", "", 0.0, told)


def _printed(device: Device) -> Iterator[BillRow]:
    foot = printed_foot(device)
    drum, lid, base, *caged = (part.mass_properties().mass for part in printed_parts(device))
    across, tall = 2.0 * foot.housing.radius, 2.0 * foot.housing.half_height
    made = f"3-D print, wall {_mm(WALL)}, {_mm(CLEARANCE)} clear of the rim"
    yield BillRow("housing", 2, "PETG", f"{_mm(across)} x {_mm(tall)}", drum + lid, made)
    size = f"{_mm(2.0 * foot.base_radius)} x {_mm(foot.wheel_height)} to the axis"
    yield BillRow("foot", 2, "PETG", size, base, "3-D print, turned to the incidence by hand")
    cage = motor_mount(device).cage
    if cage is not None:
        size = f"{_mm(2.0 * cage.reach)} x {_mm(cage.length)}"
        yield BillRow("cage", 2, "PETG", size, caged[0], "3-D print, holds the motor by its back")


def _screws(device: Device) -> Iterator[BillRow]:
    for each in fastenings(device):
        yield BillRow(
            part=f"screw {each.screw.designation(each.length)}",
            quantity=2 * each.count,
            material="steel",
            stock="",
            mass=each.screw.mass(each.length),
            source=f"{each.purpose}; mass: steel of {STEEL:g} kg/m^3 of its ISO 4762 dimensions",
        )


def _grams(mass: float) -> str:
    return f"{1e3 * mass:.3f}"


def _mm(length: float) -> str:
    return f"{1e3 * length:.2f}"


def _rounded(figure: float) -> float:
    """To six places: what is a whole number but for rounding is whole."""
    return round(figure, 6)
