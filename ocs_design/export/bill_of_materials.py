"""Bill of materials: parts to buy and to make for one device, as CSV for spreadsheets."""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path

from ocs_design.actuation.fasteners import STEEL, Fastening
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.materials import recorded_material
from ocs_design.device.device import Device
from ocs_design.device.joints import (
    bonded_on_shaft,
    counted_foot_screws,
    foot_screws,
    slipping,
    unheld_moment,
)
from ocs_design.device.records.flights import Margin
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.device_parts import BLOCK, pedestal_kinds, printed_parts, ring_fixture
from ocs_design.export.electrics import battery, controllers, wiring_parts
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.carrier_plate import SHIM, block_part, mast_part, plate_part, sleeve_part
from ocs_design.parts.guard import OUTSIDE_UNDER, RING_STEEL
from ocs_design.parts.housing import LID_SCREWS, guard_ring
from ocs_design.parts.joints import BOND_STRENGTH, EPOXY
from ocs_design.parts.printed import (
    CLEARANCE,
    PANEL,
    TRUNK_SCREW,
    TRUNK_SCREW_COUNT,
    WALL,
    WASHER,
    WASHER_MASS,
)
from ocs_design.parts.rim import HoleRing
from ocs_design.parts.wheel import Flywheel, Web

COLUMNS = (
    *("part", "quantity", "material", "stock [mm]", "mass each [g]", "mass [g]"),
    *("remark", "source"),
)

_ALLOWANCE = 2e-3
"""Allowance of stock on finished diameter and length, to turn clean and to part off [m]."""

LARGEST_BAR = 250
"""Largest diameter of a round bar [mm]: EN 10083 and EN 10088-3 guarantee no strength above it."""

_MASSLESS = 1e-9
"""Rounding error of masses: remainder of a module's mass after subtracting all parts [kg]."""

_FORMULA_STARTS = ("=", "+", "-", "@")
"""Leading characters that make a spreadsheet read text as a formula (OWASP, "CSV Injection")."""


@dataclass(frozen=True)
class BillRow:
    """One kind of part.

    Attributes:
        quantity: number in the whole device.
        stock: stock to cut it from, with its sizes [mm].
        mass: mass of one [kg]; 0: not known.
        remark: how it is made, its purpose, and cautions.
        source: source of its figures; empty: they are computed here.
        piece: key of the metal piece in the booklet's pictures (`Piece`); empty for others.
    """

    part: str
    quantity: int
    material: str
    stock: str
    mass: float
    remark: str
    source: str = ""
    piece: str = ""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `bill_of_materials.csv`."""
    content = bill_csv(subject.device, subject.margins, subject.refused).encode()
    (folder / "bill_of_materials.csv").write_bytes(content)
    return ()


def bill_rows(device: Device, margins: Sequence[Margin] = ()) -> Sequence[BillRow]:
    """All parts of the device; their masses add up to its mass.

    Controllers, battery and consumables are listed without a mass: they are not chosen. Margins of
    the flights, if there are any, give the loads on the battery.
    """
    motor, count = device.motor, len(device.modules)
    rows = list(_wheel_rows(device.flywheel, count))
    if motor.mass > 0.0:
        supply = [] if motor.bus_voltage is None else [f"run at {motor.bus_voltage:g} V"]
        if motor.bus_voltage and motor.rated_voltage and motor.bus_voltage > motor.rated_voltage:
            supply.append(f"rated for {motor.rated_voltage:g} V: ask its maker before you buy")
        remark, name = "; ".join([*supply, *drive_notes(device)]), f"motor {motor.full_name}"
        rows.append(BillRow(name, count, "", "", motor.mass, remark, motor.source))
    if motor.gear != DIRECT.name:
        remark, source = f"ratio {motor.gear_ratio:g}", "`ocs-design catalogue gears -v`"
        rows.append(BillRow(f"gear {motor.gear}", count, "", "", motor.gear_mass, remark, source))
    printed = device.carrier.mass - motor.mass - motor.gear_mass - motor.controller_mass
    if printed > _MASSLESS:
        foot, housing, mount = device.foot, device.foot.housing, device.mount
        drum, lid, base, *caged = (part.mass_properties().mass for part in printed_parts(device))
        size = f"{_mm(2.0 * housing.radius)} x {_mm(2.0 * housing.half_height)}"
        made = f"3-D print, wall {_mm(WALL)}, floor and lid {_mm(PANEL)}, "
        made += f"{_mm(CLEARANCE)} clear of the rim"
        rows.append(BillRow("housing", count, "PETG", size, drum + lid, made))
        size = f"{_mm(2.0 * foot.base_radius)} x {_mm(foot.wheel_height)} to the axis"
        made = "3-D print, turned to the incidence by hand"
        rows.append(BillRow("foot", count, "PETG", size, base, made))
        if mount.cage is not None:
            size = f"{_mm(2.0 * mount.cage.reach)} x {_mm(mount.cage.length)}"
            made = "3-D print, holds the motor by its back"
            rows.append(BillRow("cage", count, "PETG", size, caged[0], made))
        if device.guard_wall:
            mass, wall = guard_ring(housing).mass(), device.guard_wall
            inside, tall = housing.guard_radius, housing.guard_height
            size = f"ring {_mm(2.0 * inside)} inside x {_mm(wall)} wall x {_mm(tall)}"
            made = (
                "to guard_ring.pdf: turned from tube, or bent and welded, no wall thinner; outside "
                f"{_mm(2.0 * (inside + wall))} (0/-{1e3 * OUTSIDE_UNDER:g}), with epoxy in a drum "
                f"of {_mm(2.0 * housing.inner_radius)}; holds a burst rim"
            )
            rows.append(BillRow("guard ring", count, RING_STEEL, size, mass, made, piece="guard"))
        # Screws of wheel and motor only if the catalogue has their threads.
        screwed = (ring.fastening for ring in mount.screwed)
        rows += [_screw_row(fastening, count) for fastening in (*screwed, LID_SCREWS)]
        feet = [(foot_screws(device, at), counted_foot_screws(device, at)) for at in device.modules]
        for fastening, counted in dict.fromkeys(feet):
            row, length = _screw_row(fastening, feet.count((fastening, counted))), counted.length
            if fastening.length != length:
                remark = f"{row.remark}; weighed as {fastening.screw.designation(length)}"
                row = replace(row, mass=fastening.screw.mass(length), remark=remark)
            rows.append(row)
    return [*rows, *_support_rows(device), *_unweighed_rows(device, margins)]


def _support_rows(device: Device) -> Iterator[BillRow]:
    """Supports of the feet: plate, mast and sleeves, or pedestals, each with its screws."""
    plate = device.plate
    if plate is not None:
        length, width, thickness = plate.sizes
        material = plate.material
        size = f"plate {_mm(thickness)}, at least {_least(length)} x {_least(width)}"
        sheets = ", a sheet for each kind" if len(plate.kinds) > 1 else ""
        count, mass = len(plate.rows), plate_part(plate.single_plates[0]).mass()
        remark = (
            f"milled or cut by water jet to plate.pdf{sheets} (outline: `export --formats dxf`), "
            f"neck {_mm(2.0 * plate.neck)}; "
            f"{len(plate.feet) // count} threads {plate.foot_thread} for the feet"
        )
        what = "plate under the feet"
        yield BillRow(what, count, material, size, mass, remark, piece="plate")
        mast, support = plate.mast, "plate"
        across, wall = _mm(2.0 * plate.sleeve_radius), _mm(plate.sleeve_wall)
        tube = f"tube {across} x {wall} wall, or turned from bar"
        if mast is not None:
            stock, support = f"square tube {_mm(mast.side)} x {_mm(mast.wall)}", "mast"
            flat = mast.spacer > 0.0 and not mast.formed
            spacer = f", a block of {_mm(mast.spacer)} before it" if flat else ""
            count = len(plate.rows)
            arms, per_arm = ("one arm", "it") if count == 1 else (f"{count} arms", "each")
            remark = (
                f"upright of {_mm(mast.high - mast.low)}{spacer}, {arms} of "
                f"{_mm(mast.back + plate.neck)}, welded, and a plate on {per_arm}"
            )
            mass = mast_part(plate, mast).mass()
            yield BillRow("mast", 1, material, stock, mass, remark, piece="mast")
            if plate.relief is not None:
                low, high = plate.block
                size = " x ".join(map(_mm, (mast.side, high - low, mast.off)))
                remark = (
                    "milled to block.stl or block.step, its front shaped to the trunk; welded "
                    "before the upright and drilled with it"
                )
                mass = block_part(plate, plate.relief).mass()
                yield BillRow("block of the mast", 1, material, size, mass, remark, piece=BLOCK)
            remark = f"cut to {_mm(mast.bore)}, in the upright around each screw"
            mass, what = sleeve_part(plate, mast.bore).mass(), "sleeve in the mast"
            sleeves = len(plate.trunk)
            yield BillRow(what, sleeves, material, tube, mass, remark, piece="sleeves")
        for length in sorted({length for length in plate.sleeves if length > 0.0}):
            shims = ", or shim washers" if length < SHIM else ""
            remark = f"cut to {_mm(length)}{shims}, between {support} and trunk"
            count, mass = plate.sleeves.count(length), sleeve_part(plate, length).mass()
            what = f"sleeve under the {support}"
            yield BillRow(what, count, material, tube, mass, remark, piece="sleeves")
        for fastening in plate.fastenings:
            yield _screw_row(fastening, 1)
    for kind in pedestal_kinds(device):
        one, count = kind.alike[0], len(kind.alike)
        remark = (
            f"3-D print, lying on its side, {kind.name}.stl; seat and brace {_mm(one.thickness)}, "
            f"base {_mm(one.base)}; tap its 2 holes {TRUNK_SCREW.name} for the foot's screws"
        )
        size = " x ".join(map(_mm, one.sizes))
        modules = " and ".join(pedestal.module for pedestal in kind.alike)
        yield BillRow(f"pedestal of {modules}", count, "PETG", size, kind.part.mass(), remark)
        yield _screw_row(kind.screws, count)


def _screw_row(fastening: Fastening, modules: int) -> BillRow:
    """Row of equal screws of that many modules."""
    name, count = f"screw {fastening.designation}", modules * fastening.count
    source = f"mass from its dimensions in ISO 4762, steel of {STEEL:g} kg/m^3"
    remark, kind = fastening.purpose, fastening.screw
    if fastening.length > kind.usual_length + 1e-9:
        usual = f"{1e3 * kind.usual_length:.0f} mm, ISO 4762"
        remark += f"; longer than {kind.name} is usually sold ({usual}): may be a special order"
    # The capacity of a joint depends on the class: stainless A2-70 yields at 450 MPa, 8.8 at 640.
    steel = f"steel, class {fastening.strength}"
    return BillRow(name, count, steel, "", kind.mass(fastening.length), remark, source)


def _unweighed_rows(device: Device, margins: Sequence[Margin]) -> Iterator[BillRow]:
    """Rows without mass: controllers and battery, which are not chosen, and consumables."""
    controller, left_out = controllers(device.motor), "of your choice; not in the device's mass"
    if controller:
        mass = device.motor.controller_mass
        counted = "of your choice; mass by a rule over its current" if mass else left_out
        remark = f"{controller}; {counted}"
        yield BillRow("motor controller", len(device.modules), "", "", mass, remark)
    if gives := battery(device.motor, margins):
        yield BillRow("battery", 1, "", "", 0.0, f"{gives}; {left_out}")
        braking = "switches on above the full battery, below the controllers' limit"
        yield BillRow("brake resistor with switch", 1, "", "", 0.0, f"{braking}; {left_out}")
    for part, count, remark in wiring_parts(device, margins):
        yield BillRow(part, count, "", "", 0.0, f"{remark}; {left_out}")
    # Wheels alone are not assembled.
    if device.wheels_alone:
        return
    fixture = ring_fixture(device)
    bonds = ["ring on bell"] if fixture is not None else []
    bonds += ["guard ring in drum"] if device.guard_wall else []
    bonds += ["around the screws of motor and cage"] if slipping(device) else []
    if bonds:
        bonded = " and ".join(bonds)
        where = f"{bonded}, or an epoxy that is as strong at 80 deg C; follow its maker's sheet"
        yield BillRow(f"epoxy {EPOXY}", 1, "", "", 0.0, where)
    if fixture is not None:
        where = "3-D print ring_fixture.stl, one per ring: glue spoils it; not in the device"
        yield BillRow("fixture for ring and bell", len(device.modules), "PETG", "", 0.0, where)
    elif bonded_on_shaft(device):
        where = (
            f"wheel on shaft; at least {BOND_STRENGTH / 1e6:g} MPa in shear on steel (ISO 10123); "
            "follow its maker's sheet"
        )
        yield BillRow("retaining compound", 1, "", "", 0.0, where)
    if device.foot_hold.washers:
        count = len(device.modules) * TRUNK_SCREW_COUNT
        longer = (
            foot_screws(device, at).mass - counted_foot_screws(device, at).mass
            for at in device.modules
        )
        mass = count * WASHER_MASS + sum(longer)
        where = (
            f"under heads of the feet's screws; not in the mass: {1e3 * mass:.1f} g in all, "
            f"{mass / device.mass:.2%} of the device, the screws' length for them included"
        )
        yield BillRow(f"washer {WASHER}", count, "steel", "", 0.0, where)
    if unheld_moment(device, margins):
        where = "through a foot's base into what it stands on; not in the mass"
        yield BillRow("pin of 3 mm", len(device.modules), "steel", "", 0.0, where)
    screwed = (ring.fastening for ring in device.mount.screwed)
    if any(not fastening.joint.in_print for fastening in screwed):
        where = "medium strength, removable; screws in metal only: it attacks prints"
        yield BillRow("threadlocker", 1, "", "", 0.0, where)


def bill_csv(device: Device, margins: Sequence[Margin] = (), refused: str = "") -> str:
    """The rows and their sum as CSV, masses to the milligram; see `bill_rows`.

    If the device cannot be built, the reason is the first row.
    """
    rows, text = bill_rows(device, margins), StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    if refused:
        head, _, why = refused.partition(". ")
        writer.writerow(
            [head, *[""] * 5, plain(f"{why} Buy and make nothing before that is settled."), ""]
        )
    for row in rows:
        masses = [_grams(row.mass), _grams(row.quantity * row.mass)] if row.mass else ["", ""]
        cells = [row.part, str(row.quantity), _ordered(row.material), row.stock, *masses]
        cells += [row.remark, row.source]
        writer.writerow([plain(cell) for cell in cells])
    total = sum(row.quantity * row.mass for row in rows)
    # Designs of versions before 0.2 lack the mass of screws and of some of the motor's supports.
    remark = "as designed"
    if abs(total - device.mass) > _MASSLESS:
        remark = f"design.json states {_grams(device.mass)} g: size it again"
    writer.writerow(["total", "", "", "", "", _grams(total), remark, ""])
    return text.getvalue()


def plain(text: str) -> str:
    """Text on one line that no spreadsheet reads as a formula."""
    line = " ".join(text.split())
    return f"'{line}" if line.startswith(_FORMULA_STARTS) else line


def _wheel_rows(wheel: Flywheel, count: int) -> Iterator[BillRow]:
    """Rows of the wheel: one piece if rim and web are of one material, else a rim on its web."""
    web, cuts, material = wheel.web, wheel.cuts, wheel.material
    rim = f"turned to {_mm(2.0 * wheel.outer_radius)} x {_mm(wheel.height)}"
    if cuts.chamfer:
        rim += f", edges {_mm(cuts.chamfer)} x 45 deg"
    if cuts.holes:
        hole = f"{_mm(2.0 * cuts.hole_radius)} x {_mm(cuts.hole_depth)}"
        rim += f", {cuts.holes} balancing holes {hole} in each face"
    bore = f", bore {_mm(2.0 * wheel.inner_radius)}" if wheel.inner_radius > 0.0 else ""
    name, mass, remark, piece = "flywheel rim", wheel.mass, rim + bore, "flywheel"
    stock = _stock(wheel.outer_radius, wheel.inner_radius, wheel.height)
    if web is not None and web.material == wheel.material:
        name, remark = "flywheel, one piece", f"{rim}, {_web_text(web)}"
        stock = _stock(wheel.outer_radius, 0.0, max(wheel.height, web.hub.height))
    elif web is not None:
        mass, remark, piece = wheel.rim_mass, f"{remark}, seated on the web", "rim"
    yield BillRow(name, count, material, stock, mass, remark, piece=piece)
    if web is not None and web.material != wheel.material:
        name, remark = "flywheel web and hub", _web_text(web)
        stock = _stock(wheel.inner_radius, 0.0, max(web.thickness, web.hub.height))
        yield BillRow(name, count, web.material, stock, web.mass, remark, piece="hub")


def _web_text(web: Web) -> str:
    def on_circle(ring: HoleRing, kind: str = "") -> str:
        """Holes of one ring."""
        size, place = _mm(2.0 * ring.hole_radius), _mm(2.0 * ring.circle_radius)
        return f"{ring.count} {kind}holes {size} on a circle of {place}"

    bolt_ring, holes = web.hub.bolt_ring, web.holes
    bolts = "no bolt circle" if bolt_ring is None else on_circle(bolt_ring)
    lightened = "" if holes is None else f" with {on_circle(holes, 'lightening ')}"
    return (
        f"web {_mm(web.thickness)}{lightened}, hub bore {_mm(2.0 * web.hub.bore_radius)}, {bolts}"
    )


def _ordered(name: str) -> str:
    """A material with the designation that it is ordered by, if it is in the catalogue."""
    known = recorded_material(name)
    return f"{name}: {known.order}" if known is not None and known.order else name


def _stock(outer_radius: float, inner_radius: float, length: float) -> str:
    """Ring for a bore of more than half the diameter, else a bar or disc; whole millimetres."""
    outside, cut = _least(2.0 * outer_radius), _least(length)
    if inner_radius <= 0.5 * outer_radius:
        form = "round bar" if outside <= LARGEST_BAR else "disc cut from plate"
        return f"{form}, at least {outside} x {cut}"
    inside = math.floor(round(1e3 * (2.0 * inner_radius - _ALLOWANCE), 6))
    return f"tube or plate, at least {outside} x {cut}, at most {inside} inside"


def _least(size: float) -> int:
    """Least size of stock for a finished size [m], in whole millimetres."""
    # Rounded first, so that rounding errors do not add a millimetre.
    return math.ceil(round(1e3 * (size + _ALLOWANCE), 6))


def _grams(mass: float) -> str:
    return f"{1e3 * mass:.3f}"


def _mm(length: float) -> str:
    return f"{1e3 * length:.2f}"
