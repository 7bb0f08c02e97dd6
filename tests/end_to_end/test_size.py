"""The main job with a motor of the catalogue: rim, drive and choice, and what they are held to."""

from types import SimpleNamespace

import numpy as np
import pytest
from naive_wheel import solid, turned
from products import device_of

from ocs_design.actuation.motor import build_gaps
from ocs_design.catalogue.materials import material
from ocs_design.catalogue.motors import motors
from ocs_design.parts.joints import hub_joint
from ocs_design.parts.rim import hub_height

pytestmark = pytest.mark.parametrize("product", ["motor"], indirect=True)


def web_body(wheel):
    """Mass, inertia about the axis and across it: a disc, a boss around it, less the bore."""
    web, hub = wheel.web, wheel.web["hub"]
    assert hub["bolts"] == 0
    t, density, chamfer = web["thickness"], web["density"], hub["chamfer"]
    disc = solid(wheel.inner_radius, t, density)
    boss = turned(hub["radius"], -chamfer, hub["height"], density)
    bore = turned(hub["bore_radius"], chamfer, hub["height"], density)
    holes = web["holes"]
    lost = holes["count"] * np.pi * holes["hole_radius"] ** 2 * t * density
    axial = lost * (holes["circle_radius"] ** 2 + holes["hole_radius"] ** 2 / 2.0)
    drilled = np.array([lost, axial, axial / 2.0 + lost * t**2 / 12.0])
    return disc + boss - solid(hub["radius"], t, density) - bore - drilled


def rim_body(wheel):
    """Likewise: a cylinder less its bore, all edges broken."""
    chamfer = wheel.cuts["chamfer"]
    assert chamfer > 0.0
    whole = turned(wheel.outer_radius, -chamfer, wheel.height, wheel.density)
    return whole - turned(wheel.inner_radius, chamfer, wheel.height, wheel.density)


def test_the_rim_is_the_cylinder_that_it_says(document):
    ocs = document["ocs"]
    wheel, motor = SimpleNamespace(**ocs["flywheel"]), SimpleNamespace(**ocs["motor"])
    speed = min(motor.no_load_speed, motor.speed_max)
    mass, axial, transverse = rim_body(wheel) + web_body(wheel)
    expected = {
        "mass": mass,
        "spin_inertia": axial + motor.rotor_inertia,
        "transverse_inertia": transverse,
        "stored_energy": wheel.spin_inertia * speed**2 / 2.0,
    }
    for name, value in expected.items():
        assert getattr(wheel, name) == pytest.approx(value, rel=1e-9), name
    metal = material(wheel.material)
    nu = metal.poisson_ratio
    stress = (3.0 + nu) * wheel.outer_radius**2 + (1.0 - nu) * wheel.inner_radius**2
    assert wheel.hoop_stress == pytest.approx(wheel.density * speed**2 / 4.0 * stress, rel=1e-9)
    # At 1.2 times the highest speed the rim still has the safety of 2 that is assumed.
    assert metal.yield_strength / (1.2**2 * wheel.hoop_stress) >= 2.0 * (1.0 - 1e-9)
    assert ocs["spin_inertia"] == wheel.spin_inertia


def test_the_masses_add_up(document):
    ocs = document["ocs"]
    row = motors()[ocs["motor"]["name"]]
    assert ocs["motor"]["mass"] == row.mass
    bought = row.mass + ocs["motor"]["gear_mass"] + ocs["motor"]["controller_mass"]
    assert ocs["motor"]["controller_mass"] > 0.0
    assert ocs["carrier"]["mass"] - bought > 0.0
    modules = 2.0 * (ocs["flywheel"]["mass"] + ocs["carrier"]["mass"])
    plate = device_of(document).plate.mass
    assert plate > 0.0
    assert ocs["mass_total"] == pytest.approx(modules + plate, rel=1e-12)
    assert document["sizing"]["objective"] == pytest.approx(ocs["mass_total"], rel=1e-9)
    lightest = document["selection"]["ranking"][0]
    assert lightest["mass"] == pytest.approx(modules + plate, rel=1e-9)
    names = ("wheels", "motors", "gears", "housings", "plate")
    parts = [lightest[f"{name}_mass"] for name in names]
    assert sum(parts) == pytest.approx(lightest["mass"], rel=1e-12)


def test_the_drive_is_the_motors_data_sheet_at_the_bus(document):
    """V = R i + k_t w, by hand from the row of the catalogue."""
    drive = document["ocs"]["motor"]
    row, volts = motors()[drive["name"]], document["selection"]["bus_voltage"]
    assert (drive["gear"], drive["gear_ratio"], volts) == ("direct", 1.0, 24.0)
    assert drive["no_load_speed"] == pytest.approx(volts / row.torque_constant, rel=1e-12)
    stall = volts * row.torque_constant / row.resistance
    assert drive["stall_torque"] == pytest.approx(stall, rel=1e-12)
    # What the idle current takes up does not reach the wheel.
    useful = row.peak_torque - row.torque_constant * row.no_load_current
    assert drive["torque_limit"] == pytest.approx(useful, rel=1e-12)


def test_the_choice_says_what_it_looked_at(document):
    selection = document["selection"]
    masses = [entry["mass"] for entry in selection["ranking"]]
    # What differs by less is as heavy, and the stronger goes first.
    assert (np.diff(masses) > -1e-5 * np.array(masses[1:])).all()
    assert len(masses) >= 10
    assert len({entry["motor"] for entry in selection["ranking"]}) >= 5
    # Each motor with a gear in a rim of each of the five steels, at one incidence.
    assert selection["candidates"] % 5 == 0
    assert selection["candidates"] >= 5 * len({entry["motor"] for entry in selection["ranking"]})
    for task in selection["tasks"]:
        assert task["time_needed"] <= task["time_given"] * (1.0 + 1e-9)
        assert task["spin_inertia"] <= document["ocs"]["spin_inertia"] * (1.0 + 1e-9)
    listed = {entry["motor"] for entry in selection["ranking"]}
    fallen = {entry["motor"] for entry in selection["rejections"]}
    complete = {name: row for name, row in motors().items() if not build_gaps(row)}
    carried = {
        name
        for name, row in complete.items()
        if hub_joint(row.mounting, hub_height(row.mounting) - 1e-3) >= 1.5 * row.peak_torque
        and (row.voltage_max or row.rated_voltage) >= 24.0
    }
    assert listed | fallen == carried < set(complete) < set(motors())
    assert listed.isdisjoint(fallen)


def test_the_flights_stay_within_the_motor(document):
    motor = document["ocs"]["motor"]
    for run in (run["metrics"] for run in document["validation"] if run["ocs"]):
        # The trunk's own motion carries a wheel a little past the speed where its motor stops.
        assert run["peak_wheel_speed"] <= motor["speed_max"] * (1.0 + 1e-5)
        assert run["peak_wheel_torque"] <= motor["torque_limit"] * (1.0 + 1e-12)
