"""The bill of materials: parts to buy and to make."""

import csv
from dataclasses import replace

import pytest
from built_devices import DEVICES
from wheels import EC45, EC45_BODY, PAPER_WHEEL, driven_device, geared, paper_device

from ocs_design.actuation.motor import GearRoom
from ocs_design.device.records.flights import Margin
from ocs_design.export.bill_of_materials import COLUMNS, bill_csv, bill_rows, plain
from ocs_design.parts.module import Printed
from ocs_design.parts.rim import HoleRing, Hub
from ocs_design.parts.solids import Carrier
from ocs_design.parts.wheel import Web

GEAR_MASS = 0.02


def full_device():
    """A device with rim, motor, gear, housing and foot."""
    drive = replace(geared(4.0), gear_mass=GEAR_MASS, gear_room=GearRoom(0.01, 0.03, 0.01, 0.01))
    shell = float(Printed(0.0).mass(PAPER_WHEEL.outer_radius, PAPER_WHEEL.height))
    carrier = Carrier(EC45.mass + GEAR_MASS + shell, 1e-4, 1e-4)
    return driven_device(drive=drive, carrier=carrier)


def rows_of(text):
    return list(csv.DictReader(text.splitlines()))


def test_all_parts_together_weigh_what_the_device_weighs():
    device = full_device()
    kinds = " ".join(row.part.split()[0] for row in bill_rows(device) if row.mass)
    assert kinds == "flywheel motor gear housing foot screw screw"
    masses = [row.quantity * row.mass for row in bill_rows(device)]
    assert sum(masses) == pytest.approx(device.mass, rel=1e-12)
    *parts, total = rows_of(bill_csv(device))
    assert float(total["mass [g]"]) == pytest.approx(1e3 * device.mass, abs=1e-3)
    assert total["remark"] == "as designed"
    assert sum(float(part["mass [g]"] or 0.0) for part in parts) == pytest.approx(
        float(total["mass [g]"]), abs=3e-3
    )


HUB = Hub(radius=0.01, height=0.005, bore_radius=0.0015)
WEB = Web(material="aluminium-6061-t6", density=2710.0, thickness=0.0015, mass=0.01, hub=HUB)


def test_a_rim_on_its_web_is_two_parts_that_weigh_the_wheel():
    wheel = replace(PAPER_WHEEL, mass=PAPER_WHEEL.mass + WEB.mass, web=WEB)
    rim, web = bill_rows(replace(paper_device(), flywheel=wheel))
    assert rim.mass == pytest.approx(PAPER_WHEEL.mass, rel=1e-12)
    assert (web.mass, web.material, web.stock) == (
        WEB.mass,
        WEB.material,
        "round bar, at least 46 x 7",
    )
    assert "no bolt circle" in web.remark


def test_a_wheel_of_one_material_is_one_part_with_all_its_holes():
    hub = replace(HUB, bolts=4, bolt_circle_radius=0.008, bolt_hole_radius=0.0016)
    wheel = replace(PAPER_WHEEL, material=WEB.material, web=replace(WEB, hub=hub))
    (row,) = bill_rows(replace(paper_device(), flywheel=wheel))
    assert (row.mass, row.stock) == (wheel.mass, "round bar, at least 62 x 12")
    assert "4 holes 3.20 on a circle of 16.00" in row.remark
    assert "lightening" not in row.remark
    drilled = replace(wheel, web=replace(WEB, holes=HoleRing(6, 0.0233, 0.0095)))
    (row,) = bill_rows(replace(paper_device(), flywheel=drilled))
    assert "web 1.50 with 6 lightening holes 19.00 on a circle of 46.60" in row.remark


def test_a_screw_that_is_longer_than_usual_may_be_a_special_order():
    """M3 through 3 mm of plate and a sleeve: 24 mm take M3 x 30, 24.1 mm M3 x 35."""
    device = DEVICES["on a plate"]

    def trunk_screws(sleeve):
        plate = replace(device.plate, sleeves=(sleeve,) * 4)
        rows = bill_rows(replace(device, plate=plate))
        return next(row for row in rows if row.remark.startswith("plate on trunk"))

    usual, longer = trunk_screws(0.024), trunk_screws(0.0241)
    assert (usual.part, usual.material) == ("screw ISO 4762 M3 x 30", "steel, class 8.8")
    assert "special" not in usual.remark
    assert longer.part == "screw ISO 4762 M3 x 35"
    assert longer.remark.endswith(
        "longer than M3 is usually sold (30 mm, ISO 4762): may be a special order"
    )


def test_only_parts_of_the_device_are_listed():
    assert [row.part for row in bill_rows(paper_device())] == ["flywheel rim"]
    bare = driven_device(carrier=replace(EC45_BODY, mass=EC45.mass))
    assert [row.part for row in bill_rows(bare) if row.mass] == ["flywheel rim", "motor test"]


@pytest.mark.parametrize(
    ("inner", "stock"),
    [
        (0.0, "round bar, at least 62 x 12"),
        (0.015, "round bar, at least 62 x 12"),
        (0.022, "tube or plate, at least 62 x 12, at most 42 inside"),
    ],
)
def test_the_rim_fits_into_its_stock(inner, stock):
    """A rim of 60 mm by 10 mm with 1 mm of allowance on each side."""
    device = paper_device()
    device = replace(device, flywheel=replace(device.flywheel, inner_radius=inner))
    assert bill_rows(device)[0].stock == stock


def test_materials_are_listed_as_they_are_ordered():
    """A disc of more than 250 mm comes from plate: no standard has a strength of such bars."""
    device = full_device()
    steel = replace(device.flywheel, material="steel-4140-qt", inner_radius=0.0)
    row = rows_of(bill_csv(replace(device, flywheel=steel)))[0]
    ordered = "42CrMo4+QT (1.7225), EN 10083-3 (AISI 4140, quenched and tempered)"
    assert row["material"] == f"steel-4140-qt: {ordered}"
    for radius, form in ((0.124, "round bar"), (0.125, "disc cut from plate")):
        wide = replace(device, flywheel=replace(steel, outer_radius=radius))
        assert bill_rows(wide)[0].stock == f"{form}, at least {2e3 * radius + 2:.0f} x 12"


@pytest.mark.parametrize("name", ["=1+1", "+A1", "-2", "@SUM(A1)", "\t=1", "\r=1", " \n=1"])
def test_names_that_look_like_formulas_are_quoted(name):
    assert plain(name) == "'" + name.strip()
    assert plain("EC 45 flat, 70 W = good") == "EC 45 flat, 70 W = good"
    wheel = replace(PAPER_WHEEL, material=name)
    text = bill_csv(replace(paper_device(), flywheel=wheel))
    assert rows_of(text)[0]["material"] == "'" + name.strip()


def test_names_with_quotes_and_line_breaks_stay_in_their_cell():
    drive = replace(EC45, name='a "b", c', source="d\ne")
    text = bill_csv(driven_device(drive=drive))
    motor = rows_of(text)[1]
    assert motor["part"] == 'motor a "b", c'
    assert motor["source"] == "d e"
    assert motor["remark"].startswith("run at 24 V; the motor's threads are not in the catalogue")
    assert list(motor) == list(COLUMNS)


def test_motor_controllers_are_listed_without_a_mass():
    """1.0 N m behind a gear of 4 with an efficiency of 0.8 and k_t of 0.025: 12.5 A, no less."""
    drive = replace(
        EC45, torque_constant=0.025, bus_voltage=24.0, torque_limit=1.0, gear_ratio=4.0,
        gear_efficiency=0.8,
    )  # fmt: skip
    device = driven_device(drive=drive)
    (row,) = (part for part in rows_of(bill_csv(device)) if part["part"] == "motor controller")
    assert (row["quantity"], row["mass [g]"]) == ("2", "")
    # As sines 12.5 A / (sqrt(3) / 2) of amplitude, and 12.5 A / sqrt(3/2) rms; 1.2 x 24 V.
    assert "at least 13 A through two lines" in row["remark"]
    assert "15 A of amplitude or 11 A rms of a phase; rated for 29 V" in row["remark"]


def margin(name, demand, unit="A"):
    return Margin(name=name, demand=demand, capacity=None, unit=unit)


def test_the_battery_is_rated_for_the_currents_of_the_flights():
    """28.2 A at 24 V are 676.8 W; a margin of power takes precedence over the product."""
    margins = (
        margin("bus current", 28.2),
        margin("bus current, fed back", 22.0),
        margin("energy from the bus", 137.0, "J"),
    )
    device = driven_device(drive=replace(EC45, bus_voltage=24.0))
    text = bill_csv(device, margins)
    (battery,) = (row for row in rows_of(text) if row["part"] == "battery")
    assert battery["remark"].startswith(
        "gives at least 29 A (677 W) and takes back at least 22 A (528 W) at 24 V; a maneuver "
        "takes at most 137 J out"
    )
    assert "brake resistor with switch" in {row["part"] for row in rows_of(text)}
    power = (*margins, margin("bus power", 600.0, "W"))
    (battery,) = (row for row in bill_rows(device, power) if row.part == "battery")
    assert "29 A (600 W)" in battery.remark
    # Without flights there is no such line.
    assert "battery" not in {row.part for row in bill_rows(driven_device())}


def test_the_bill_lists_retaining_compound_or_threadlocker():
    """Retaining compound for a wheel on a shaft, threadlocker for one screwed to a rotor."""
    for name, compound in (("by its face", "retaining compound"), ("caged", "threadlocker")):
        rows = {row.part: row for row in bill_rows(DEVICES[name])}
        assert rows[compound].mass == 0.0
    assert "retaining compound" not in {row.part for row in bill_rows(DEVICES["caged"])}


@pytest.mark.parametrize(("rated", "warned"), [(16.8, True), (24.0, False), (None, False)])
def test_a_motor_above_its_rated_voltage_has_a_remark(rated, warned):
    device = full_device()
    motor = replace(device.motor, bus_voltage=24.0, rated_voltage=rated)
    rows = bill_rows(replace(device, motor=motor))
    remark = next(row.remark for row in rows if row.part.startswith("motor"))
    assert ("rated for 16.8 V: ask its maker before you buy" in remark) is warned


def test_wiring_is_listed_without_mass():
    """Fuse, switch and bus carry the larger of the currents drawn and fed back in the flights."""
    drive = replace(DEVICES["caged"].motor, bus_voltage=24.0)
    device = replace(DEVICES["caged"], motor=drive)
    margins = tuple(
        Margin(name=f"bus current{direction}", demand=current, capacity=None, unit="A")
        for direction, current in (("", 28.6), (", fed back", 41.2))
    )
    rows = {row.part: row for row in bill_rows(device, margins)}
    for part, count in (
        ("rotor angle sensor", 2),
        ("fuse with holder", 1),
        ("switch", 1),
        ("bus cables, two wires", 1),
        ("motor cables, three wires", 2),
    ):
        assert (rows[part].quantity, rows[part].mass) == (count, 0.0)
        assert rows[part].remark.endswith("not in the device's mass")
    for part in ("fuse with holder", "switch", "bus cables, two wires"):
        assert "42 A" in rows[part].remark
        assert "29 V" in rows[part].remark
    assert not any("fuse" in row.part for row in bill_rows(paper_device()))
