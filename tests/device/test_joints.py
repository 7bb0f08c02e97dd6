"""Joints and balance of a device: which kind it is, its figures, and what is not known."""

from dataclasses import replace
from math import pi

import pytest
from built_devices import DEVICES
from wheels import EC45, PAPER_WHEEL, driven_device

from ocs_design.actuation.fasteners import screw
from ocs_design.actuation.motor import BoltCircle, Face, Mounting, ShaftForm
from ocs_design.catalogue.materials import material
from ocs_design.device.device import Web
from ocs_design.device.joints import (
    balance_of,
    joints_of,
    rim_fit,
    wheel_rings,
    yield_margin,
)
from ocs_design.device.resonances import resonances_of
from ocs_design.device.solids import foot_of, motor_mount
from ocs_design.export.device_parts import printed_parts
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.joints import friction_torque
from ocs_design.parts.motor_mount import motor_front
from ocs_design.parts.pedestal import Pedestal, seat_compliance, strengthened
from ocs_design.parts.plate_strength import plate_frequency
from ocs_design.parts.rim import WEB_THICKNESS, Hub
from ocs_design.parts.turning_rings import TurningRings

STEEL, ALUMINIUM = material("steel-4140-normalized"), material("aluminium-6061-t6")
HUB = Hub(0.0096, 0.005, 0.002, 4, 0.006, 0.0017, chamfer=0.2e-3)
THREADS = Mounting(shaft_diameter=0.004, rotor=BoltCircle(0.012, 4, "M3"))


def device(mounting=THREADS, web=STEEL, hub=HUB, **wheel):
    """A rim of steel on such a web and motor, 0.9 N m and 9,000 rpm."""
    drive = replace(EC45, mounting=mounting, torque_limit=0.9, speed_max=300.0 * pi)
    joined = Web(web.name, web.density, WEB_THICKNESS, 0.02, hub)
    made = replace(PAPER_WHEEL, material=STEEL.name, density=STEEL.density, web=joined)
    sized = replace(made, inner_radius=0.036, outer_radius=0.04, height=0.006, **wheel)
    return replace(driven_device(drive=drive), flywheel=sized)


def named(found):
    return {joint.name: joint for joint in joints_of(found)}


def test_one_piece_stands_its_largest_stress_at_over_speed():
    one = device()
    joint = named(one)["largest stress of the wheel"]
    turning = TurningRings.of(wheel_rings(one.flywheel), 1.2 * one.motor.top_speed)
    peaks = [turning.peak(ring) for ring in range(3)]
    assert joint.demand == pytest.approx(max(*peaks, turning.peak_at_hole(0, 0.006)))
    assert joint.capacity == STEEL.yield_strength
    assert joint.margin == pytest.approx(joint.capacity / joint.demand)
    assert joint.note.startswith("in the web at 1.2 x top speed, against yield; one piece")
    # With the square of the speed.
    where, factor = yield_margin(one, 1.05 * one.motor.top_speed)
    assert where == "the web"
    assert factor == pytest.approx(joint.margin * (1.2 / 1.05) ** 2)
    assert one.motor.top_speed == pytest.approx(min(650.4, 300.0 * pi))


def test_a_foot_breaks_at_the_shock_that_is_told():
    """253 g x 355 m/s^2 x 45.6 mm on 39.2 mm x (5 mm)^2 / 6: the 25 MPa of PETG across layers."""
    shock = named(device())["landing shock, foot"]
    assert (shock.demand, shock.unit) == (pytest.approx(20.0 * 9.80665), "m/s2")
    assert 0.2527 * shock.capacity * 0.0456 / (0.03924 * 0.005**2 / 6.0) == pytest.approx(
        25e6, rel=1e-3
    )
    assert "landing shock, cage" not in named(device())


def test_screws_of_a_plate_have_a_shock_too():
    """Beside the cage and the foot that it has without a plate."""
    plain, on_plate = named(DEVICES["caged"]), named(DEVICES["on a plate"])
    (name,) = set(on_plate) - set(plain)
    assert name == "landing shock, screws in the trunk"
    assert on_plate[name].note.endswith(
        "until one of 4 M3 of class 8.8 breaks, or a sleeve gives way"
    )
    assert on_plate[name].margin > 1.0


def test_a_cages_floor_breaks_at_the_shock_that_is_told():
    """As a plate that motor and wheel tilt, clamped by the posts along half of its edge."""
    caged = DEVICES["caged"]
    shock, cage = named(caged)["landing shock, cage"], motor_mount(caged).cage
    tilting = caged.motor.mass * cage.motor_length / 2.0 + caged.flywheel.mass * cage.seat
    around = cage.holes.screws
    held = around.radius + screw(around.thread).head_diameter / 2.0
    ring = (cage.bore**2 - held**2) / (cage.bore**2 + held**2)
    stress = 3.0 * tilting * shock.capacity * ring / (pi * held * cage.floor**2)
    assert 2.0 * stress == pytest.approx(47e6)
    assert shock.margin > 1.0


def test_heads_of_a_cage_s_screws_sink_in_where_its_floor_is_strong():
    """Four M2 press on 4 x 6.82 mm^2 around their holes, of PETG that yields at 47 MPa: 1,282 N.

    They hold what the motor's side of the foot weighs, as it is exported.
    """
    thick = replace(DEVICES["caged"], foot_plate=0.03)
    heavy = replace(thick, motor=replace(thick.motor, mass=8.0, length=0.08))
    found = named(heavy)["landing shock, cage"]
    printed = next(part for part in printed_parts(heavy) if part.name == "cage")
    held = 8.0 + heavy.flywheel.mass + 1270.0 * part_manifold(printed).volume()
    assert "heads of the cage's screws" in found.note
    assert found.capacity == pytest.approx(1282.0 / held, rel=1e-3)
    assert type(found.capacity) is float, "design.json takes no number of NumPy's"


def test_a_rim_on_another_web_is_shrunk_on():
    found = named(device(web=ALUMINIUM))
    assert set(found) >= {"rim joint", "web of the shrink fit", "rim of the shrink fit"}
    fit = rim_fit(device(web=ALUMINIUM))
    joint = found["rim joint"]
    # 1.5 x 0.9 N m, and no more than the last micrometre across adds.
    assert (joint.demand, joint.capacity, joint.unit) == (pytest.approx(1.35), fit.torque, "N m")
    assert 1.0 <= joint.margin < 1.5
    assert (2e6 * fit.least, 2e6 * fit.most) == pytest.approx(
        (round(2e6 * fit.least), round(2e6 * fit.most))
    )
    assert rim_fit(device()) is None
    where, factor = yield_margin(device(web=ALUMINIUM), device().motor.top_speed)
    both = {name: found[f"{name} of the shrink fit"].margin for name in ("web", "rim")}
    assert (where.removeprefix("the "), factor) == min(both.items(), key=lambda each: each[1])


def test_screws_carry_by_friction_and_shear_is_a_reserve():
    found = named(device())
    joint, reserve = found["shaft joint"], found["shaft joint, screws in shear"]
    assert joint.demand == reserve.demand == pytest.approx(1.35)
    assert joint.capacity == friction_torque(screw("M3"), 4, 0.006)
    assert reserve.capacity > joint.capacity > joint.demand


def test_a_shaft_alone_is_bonded():
    """4 mm by 4.6 mm under half of 25 MPa: pi d^2 / 2 L tau = 1.445 N m."""
    joint = named(device(Mounting(shaft_diameter=0.004)))["shaft joint"]
    assert joint.capacity == pytest.approx(1.445, abs=1e-3)
    assert "alone carries nothing" in joint.note


@pytest.mark.parametrize(
    ("out", "length", "carries"), [(0.0035, 2.3, 0.723), (0.005, 3.8, 1.194), (0.009, 4.6, 1.445)]
)
def test_a_bond_is_as_long_as_the_shaft_reaches_into_the_hub(out, length, carries):
    """A cage holds the motor 1 mm behind the hub of 5 mm, whose first 0.2 mm are a chamfer."""
    mounting = Mounting(0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK, out, ShaftForm.PLAIN)
    made = device(mounting)
    made = replace(made, motor=replace(made.motor, diameter=0.0556, length=0.025))
    assert motor_front(motor_mount(made), made.flywheel.height) == pytest.approx(-0.0035)
    joint = named(made)["shaft joint"]
    assert joint.capacity == pytest.approx(carries, abs=1e-3)
    assert f"over {length} mm of its length in the hub" in joint.note


@pytest.mark.parametrize(
    "unknown",
    [device(None), replace(device(), motor=replace(device().motor, gear="5 to 1"))],
    ids=["no mounting", "a gear"],
)
def test_what_is_not_in_the_catalogue_has_no_capacity(unknown):
    joint = named(unknown)["shaft joint"]
    assert joint.capacity is joint.margin is None
    assert "not in the catalogue" in joint.note


def test_a_material_without_figures_has_no_capacity():
    plain = replace(device().flywheel, material="stainless-paper")
    unknown = replace(plain, web=replace(plain.web, material="stainless-paper"))
    assert (
        named(replace(device(), flywheel=unknown))["largest stress of the wheel"].capacity is None
    )


def test_massless_spokes_have_no_joints():
    assert joints_of(replace(device(), flywheel=PAPER_WHEEL)) == ()


def test_balance_is_g_6_3_at_the_top_speed():
    """20,160 rpm leave 2.98 um."""
    fast = replace(EC45, no_load_speed=3000.0, speed_max=20_160.0 * pi / 30.0)
    found = balance_of(replace(device(), motor=fast))
    assert 1e6 * found.eccentricity == pytest.approx(2.98, abs=0.005)
    assert found.unbalance == pytest.approx(found.eccentricity * PAPER_WHEEL.mass)


def test_what_centres_a_wheel_says_how_far_off_it_may_be():
    """H7/h6 on 4 mm: (12 + 8) / 2 um, and half of 50 um of run-out; on screws half of 0.1 mm."""
    on_shaft, screwed = (
        balance_of(device()),
        balance_of(device(replace(THREADS, shaft_diameter=None))),
    )
    assert on_shaft.off_centre == pytest.approx(35e-6)
    assert screwed.off_centre == pytest.approx(50e-6)
    assert (on_shaft.shifted, screwed.shifted) == (False, True)
    assert balance_of(device(None)).off_centre is None


def test_resonances_are_those_below_top_speed_and_follow_the_unbalance():
    """U w^2 at the mode, and Q = 1 / (2 x 1 %) times U / m, whatever the stiffness."""
    device = DEVICES["on a plate"]
    device = replace(device, motor=replace(device.motor, no_load_speed=3e3, speed_max=None))
    plate, foot, twisted = resonances_of(device)
    mass, unbalance = device.flywheel.mass + device.carrier.mass, balance_of(device).unbalance
    assert plate.frequency == plate_frequency(device.plate, mass)
    assert plate.force == pytest.approx(unbalance * (2.0 * pi * plate.frequency) ** 2)
    assert plate.amplitude == pytest.approx(50.0 * unbalance / mass)
    assert foot.frequency < twisted.frequency < plate.frequency
    assert twisted.amplitude == plate.amplitude
    assert foot.amplitude < plate.amplitude
    slow = replace(device, motor=replace(device.motor, no_load_speed=6.0 * foot.frequency))
    assert resonances_of(slow) == ()


def test_on_a_pedestal_a_module_shakes_on_its_seat_and_its_foot_is_softer():
    """Springs in a row: one over the square of their frequency is the sum of those of each."""
    device = DEVICES["caged"]
    device = replace(device, motor=replace(device.motor, no_load_speed=3e5, speed_max=None))
    (alone,), foot = resonances_of(device), foot_of(device)
    seats = tuple(
        strengthened(
            Pedestal(foot.base_radius, foot.slot_radius, foot.wheel_height, lean, 0.04), 0.4
        )
        for lean in (0.6, 1.2)
    )
    seat, stem = resonances_of(replace(device, pedestals=seats))
    mass = device.flywheel.mass + device.carrier.mass
    square, along = (max(each) for each in zip(*map(seat_compliance, seats), strict=True))
    assert (2.0 * pi * seat.frequency) ** 2 == pytest.approx(1.0 / (square * mass))
    own = 1.0 / (2.0 * pi) ** 2 / (along * mass)
    assert stem.frequency**-2 == pytest.approx(alone.frequency**-2 + 1.0 / own)
    assert stem.frequency < alone.frequency
    assert (seat.name, stem.name) == ("pedestal", "foot")
    assert seat.force == pytest.approx(
        balance_of(device).unbalance * (2.0 * pi * seat.frequency) ** 2
    )
