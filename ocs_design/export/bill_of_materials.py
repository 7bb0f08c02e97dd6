"""What to buy and to make for one device, as a table for spreadsheets."""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ocs_design.design import Device, Flywheel, Motor, Web
from ocs_design.drive.gear import DIRECT
from ocs_design.drive.mounting import BoltCircle, Face
from ocs_design.fasteners import screw
from ocs_design.parts.foot import PLATE_THICKNESS
from ocs_design.sizing.housing import (
    CLEARANCE,
    WALL,
    housing_height,
    housing_mass,
    housing_outer_radius,
)

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
        mass: of one [kg]; None: not counted in the device's.
        source: where it is from, or what to mind.
    """

    part: str
    quantity: int
    material: str
    stock: str
    mass: float | None
    source: str


def bill_rows(device: Device) -> Sequence[BillRow]:
    """All parts that the device holds; those with a mass together weigh what it weighs."""
    wheel, motor = device.flywheel, device.motor
    rows = list(_wheel(wheel))
    if motor.mass > 0.0:
        supply = "" if motor.bus_voltage is None else f"on {motor.bus_voltage:g} V; "
        rows.append(BillRow(f"motor {motor.name}", 2, "", "", motor.mass, supply + motor.source))
    if motor.gear != DIRECT.name:
        rows.append(_gear(motor))
    standing = device.carrier.mass - motor.mass - motor.gear_mass
    if standing > _MASSLESS:
        rows.append(_housing(wheel))
    return [*rows, *_screws(device)]


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
        writer.writerow(["total", "", "", "", "", _grams(device.mass), ""])
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
        "" if row.mass is None else _grams(row.mass),
        "" if row.mass is None else _grams(row.quantity * row.mass),
        row.source,
    )


def _wheel(wheel: Flywheel) -> Iterator[BillRow]:
    """In one piece where rim and web are of one material, else a rim on its web."""
    web = wheel.web
    rim = f"turned to {_mm(2.0 * wheel.outer_radius)} x {_mm(wheel.height)}"
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


def _housing(wheel: Flywheel) -> BillRow:
    radius, height = wheel.outer_radius, wheel.height
    outside = f"{_mm(2.0 * housing_outer_radius(radius))} x {_mm(housing_height(height))}"
    made = f"3-D print, wall {_mm(WALL)}, {_mm(CLEARANCE)} clear of the rim"
    return BillRow("housing", 2, "PETG", outside, housing_mass(radius, height), made)


def _screws(device: Device) -> Iterator[BillRow]:
    """Of wheel and motor, where the catalogue has their threads."""
    mounting, web = device.motor.mounting, device.flywheel.web
    if mounting is None:
        return
    if mounting.rotor is not None and web is not None:
        yield _screw_row(mounting.rotor, web.hub.height, "wheel on rotor")
    if mounting.stator is not None and mounting.stator_face is Face.OUTPUT:
        yield _screw_row(mounting.stator, WALL + PLATE_THICKNESS, "motor on housing and foot")


def _screw_row(circle: BoltCircle, thickness: float, purpose: str) -> BillRow:
    name = screw(circle.thread).through(thickness)
    mind = "not in the mass; check the depth of the motor's thread"
    return BillRow(f"screw {name}", 2 * circle.bolts, "", "", None, f"{purpose}; {mind}")


def _grams(mass: float) -> str:
    return f"{1e3 * mass:.3f}"


def _mm(length: float) -> str:
    return f"{1e3 * length:.2f}"


def _rounded(millimetres: float) -> float:
    """To the nanometre: what is a whole number but for rounding is whole."""
    return round(millimetres, 6)
