"""Joints, balance and resonances of a device: kinds, figures, and missing data."""

from dataclasses import replace
from math import pi

import pytest
from built_devices import DEVICES
from wheels import EC45, PAPER_WHEEL, driven_device

from ocs_design.actuation.fasteners import BoltCircle, screw
from ocs_design.actuation.motor import Face, Mounting, ShaftForm
from ocs_design.catalogue.materials import material
from ocs_design.device.joints import (
    balance_of,
    joints_of,
    least_web_thickness,
    rim_fit,
    wheel_rings,
    yield_margin,
)
from ocs_design.device.resonances import resonances_of
from ocs_design.export.device_parts import printed_parts
from ocs_design.export.meshes import part_manifold
from ocs_design.parts.joints import friction_torque
from ocs_design.parts.motor_mount import motor_front
from ocs_design.parts.pedestal import Pedestal, seat_compliance, strengthened
from ocs_design.parts.plate_strength import plate_frequency
from ocs_design.parts.rim import WEB_THICKNESS, Hub
from ocs_design.parts.turning_rings import TurningRings
from ocs_design.parts.web_bending import bent_web
from ocs_design.parts.wheel import Web

STEEL, ALUMINIUM = material("steel-4140-qt"), material("aluminium-6061-t6")
HUB = Hub(0.0096, 0.005, 0.002, 4, 0.006, 0.0017, chamfer=0.2e-3)
THREADS = Mounting(shaft_diameter=0.004, rotor=BoltCircle(0.012, 4, "M3"))


def device(mounting=THREADS, web=STEEL, hub=HUB, **wheel):
    """A device with a rim of steel on this web and motor, 0.9 N m and 9,000 rpm."""
    drive = replace(EC45, mounting=mounting, torque_limit=0.9, speed_max=300.0 * pi)
    joined_web = Web(web.name, web.density, WEB_THICKNESS, 0.02, hub)
    rim = replace(PAPER_WHEEL, material=STEEL.name, density=STEEL.density, web=joined_web)
    sized = replace(rim, inner_radius=0.036, outer_radius=0.04, height=0.006, **wheel)
    return replace(driven_device(drive=drive), flywheel=sized)


def joints_by_name(device):
    return {joint.name: joint for joint in joints_of(device)}


def test_a_wheel_of_one_piece_withstands_overspeed():
    one_piece = device()
    joint = joints_by_name(one_piece)["largest stress of the wheel"]
    rings = TurningRings.of(wheel_rings(one_piece.flywheel), 1.2 * one_piece.motor.top_speed)
    peaks = [rings.peak(ring) for ring in range(3)]
    assert joint.demand == pytest.approx(max(*peaks, rings.peak_at_hole(0, 0.006)))
    assert joint.capacity == STEEL.yield_strength
    assert joint.margin == pytest.approx(joint.capacity / joint.demand)
    assert joint.note.startswith("in the web at 1.2 x top speed, against yield; one piece")
    # The stress grows with the square of the speed.
    part, factor = yield_margin(one_piece, 1.05 * one_piece.motor.top_speed)
    assert part == "the web"
    assert factor == pytest.approx(joint.margin * (1.2 / 1.05) ** 2)
    assert one_piece.motor.top_speed == pytest.approx(min(650.4, 300.0 * pi))


def test_the_landing_shock_that_a_foot_withstands():
    """253 g x 355 m/s^2 x 45.6 mm on 39.2 mm x (5 mm)^2 / 6: the 25 MPa of PETG across layers."""
    shock = joints_by_name(device())["landing shock, foot"]
    assert (shock.demand, shock.unit) == (pytest.approx(20.0 * 9.80665), "m/s2")
    assert 0.2527 * shock.capacity * 0.0456 / (0.03924 * 0.005**2 / 6.0) == pytest.approx(
        25e6, rel=1e-3
    )
    assert "landing shock, cage" not in joints_by_name(device())


def test_screws_of_a_plate_have_a_landing_shock_too():
    """In addition to those of cage and foot, which a device without a plate has."""
    plain, on_plate = joints_by_name(DEVICES["caged"]), joints_by_name(DEVICES["on a plate"])
    (name,) = set(on_plate) - set(plain)
    assert name == "landing shock, screws in the trunk"
    assert on_plate[name].note.endswith(
        "until one of 4 M3 of class 8.8 breaks, or a sleeve gives way"
    )
    assert on_plate[name].margin > 1.0


def test_the_landing_shock_that_the_floor_of_a_cage_withstands():
    """A plate under the moment of motor and wheel, clamped by the posts along half of its edge."""
    caged = DEVICES["caged"]
    shock, cage = joints_by_name(caged)["landing shock, cage"], caged.mount.cage
    mass_moment = caged.motor.mass * cage.motor_length / 2.0 + caged.flywheel.mass * cage.seat
    circle = cage.holes.screws
    radius = circle.radius + screw(circle.thread).head_diameter / 2.0
    ring = (cage.bore**2 - radius**2) / (cage.bore**2 + radius**2)
    stress = 3.0 * mass_moment * shock.capacity * ring / (pi * radius * cage.floor**2)
    assert 2.0 * stress == pytest.approx(47e6)
    assert shock.margin > 1.0


def test_heads_of_cage_screws_limit_the_shock_where_the_floor_is_strong():
    """Four M2 press on 4 x 6.82 mm^2 of PETG, which yields at 47 MPa: 1,282 N.

    They hold the mass of motor, wheel and printed cage.
    """
    thick = replace(DEVICES["caged"], foot_plate=0.03)
    heavy = replace(
        thick,
        motor=replace(thick.motor, mass=3.0, length=0.08),
        flywheel=replace(thick.flywheel, mass=5.0),
    )
    joint = joints_by_name(heavy)["landing shock, cage"]
    printed = next(part for part in printed_parts(heavy) if part.name == "cage")
    mass = 8.0 + 1270.0 * part_manifold(printed).volume()
    assert "heads of the cage's screws" in joint.note
    assert joint.capacity == pytest.approx(1282.0 / mass, rel=1e-3)
    assert type(joint.capacity) is float, "design.json accepts no NumPy scalars"


def test_the_web_withstands_a_landing_at_top_speed_without_touching_the_housing():
    """20 g on the wheel bend it; spinning takes its part of the strength, and 2 mm are free."""
    light, heavy = device(mass=0.1), device(mass=3.0)
    spun = TurningRings.of(wheel_rings(light.flywheel), light.motor.top_speed).peak(1)
    for spinning in (light, heavy):
        wheel = spinning.flywheel
        bent = bent_web(
            20 * 9.80665 * wheel.mass, (HUB.radius, 0.036), WEB_THICKNESS,
            elastic_modulus=STEEL.elastic_modulus, poisson_ratio=STEEL.poisson_ratio,
        )  # fmt: skip
        joint = joints_by_name(spinning)["landing shock, web"]
        assert joint.margin == pytest.approx((STEEL.yield_strength - spun) / bent.stress)
        assert "its web yields" in joint.note
    assert joints_by_name(light)["landing shock, web"].margin > 1.0
    # A wide web of a strong steel gives before it yields.
    wide = replace(light, flywheel=replace(light.flywheel, inner_radius=0.25, outer_radius=0.26))
    assert "its rim touches the housing" in joints_by_name(wide)["landing shock, web"].note


def test_webs_are_as_thick_as_a_landing_needs_them():
    """Stress falls with the square of the thickness, to the next half millimetre, up to the hub's
    5 mm."""
    assert least_web_thickness(device(mass=0.1)) == WEB_THICKNESS
    for mass in (0.5, 1.5, 3.0):
        heavy = device(mass=mass)
        thickness = least_web_thickness(heavy)
        margins = [
            joints_by_name(with_web(heavy, web))["landing shock, web"].margin
            for web in (thickness, thickness - 0.5e-3)
        ]
        assert margins[0] >= 1.0 > margins[1] or thickness == WEB_THICKNESS
        assert round(2e3 * thickness, 9) % 1.0 == 0.0
    assert least_web_thickness(device(mass=200.0)) == pytest.approx(HUB.height)


def with_web(device, thickness):
    web = replace(device.flywheel.web, thickness=thickness)
    return replace(device, flywheel=replace(device.flywheel, web=web))


def test_a_rim_on_another_web_is_shrunk_on():
    joints = joints_by_name(device(web=ALUMINIUM))
    assert set(joints) >= {"rim joint", "web of the shrink fit", "rim of the shrink fit"}
    fit = rim_fit(device(web=ALUMINIUM))
    joint = joints["rim joint"]
    # 1.5 x 0.9 N m, rounded up by at most a micrometre of interference.
    assert (joint.demand, joint.capacity, joint.unit) == (pytest.approx(1.35), fit.torque, "N m")
    assert 1.0 <= joint.margin < 1.5
    assert (2e6 * fit.least, 2e6 * fit.most) == pytest.approx(
        (round(2e6 * fit.least), round(2e6 * fit.most))
    )
    assert rim_fit(device()) is None
    part, factor = yield_margin(device(web=ALUMINIUM), device().motor.top_speed)
    both = {name: joints[f"{name} of the shrink fit"].margin for name in ("web", "rim")}
    assert (part.removeprefix("the "), factor) == min(both.items(), key=lambda item: item[1])


def test_screws_transmit_torque_by_friction_with_shear_as_reserve():
    joints = joints_by_name(device())
    joint, reserve = joints["shaft joint"], joints["shaft joint, screws in shear"]
    assert joint.demand == reserve.demand == pytest.approx(1.35)
    assert joint.capacity == friction_torque(screw("M3"), 4, 0.006)
    assert reserve.capacity > joint.capacity > joint.demand


def test_a_wheel_on_a_shaft_is_bonded():
    """4 mm by 4.6 mm under half of 25 MPa: pi d^2 / 2 L tau = 1.445 N m."""
    joint = joints_by_name(device(Mounting(shaft_diameter=0.004)))["shaft joint"]
    assert joint.capacity == pytest.approx(1.445, abs=1e-3)
    assert "alone carries nothing" in joint.note


@pytest.mark.parametrize(
    ("shaft_length", "bond_length", "capacity"),
    [(0.0035, 2.3, 0.723), (0.005, 3.8, 1.194), (0.009, 4.6, 1.445)],
)
def test_the_bond_is_as_long_as_the_shaft_in_the_hub(shaft_length, bond_length, capacity):
    """A cage holds the motor 1 mm behind the hub of 5 mm, whose first 0.2 mm are a chamfer."""
    mounting = Mounting(
        0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK, shaft_length, ShaftForm.PLAIN
    )
    bonded = device(mounting)
    bonded = replace(bonded, motor=replace(bonded.motor, diameter=0.0556, length=0.025))
    assert motor_front(bonded.mount, bonded.flywheel.height) == pytest.approx(-0.0035)
    joint = joints_by_name(bonded)["shaft joint"]
    assert joint.capacity == pytest.approx(capacity, abs=1e-3)
    assert f"over {bond_length} mm of its length in the hub" in joint.note


@pytest.mark.parametrize(
    "unknown",
    [device(None), replace(device(), motor=replace(device().motor, gear="5 to 1"))],
    ids=["no mounting", "a gear"],
)
def test_unknown_joints_have_no_capacity(unknown):
    joint = joints_by_name(unknown)["shaft joint"]
    assert joint.capacity is joint.margin is None
    assert "not in the catalogue" in joint.note


def test_an_unknown_material_has_no_capacity():
    plain = replace(device().flywheel, material="stainless-paper")
    unknown = replace(plain, web=replace(plain.web, material="stainless-paper"))
    assert (
        joints_by_name(replace(device(), flywheel=unknown))["largest stress of the wheel"].capacity
        is None
    )


def test_massless_spokes_have_no_joints():
    assert joints_of(replace(device(), flywheel=PAPER_WHEEL)) == ()


def test_balance_is_g_6_3_at_the_top_speed():
    """At 20,160 rpm the permissible eccentricity is 2.98 um."""
    fast = replace(EC45, no_load_speed=3000.0, speed_max=20_160.0 * pi / 30.0)
    balance = balance_of(replace(device(), motor=fast))
    assert 1e6 * balance.eccentricity == pytest.approx(2.98, abs=0.005)
    assert balance.unbalance == pytest.approx(balance.eccentricity * PAPER_WHEEL.mass)


def test_the_eccentricity_depends_on_what_centres_the_wheel():
    """H7/h6 on 4 mm: (12 + 8) / 2 um and half of 50 um of run-out; with screws half of 0.1 mm."""
    on_shaft, screwed = (
        balance_of(device()),
        balance_of(device(replace(THREADS, shaft_diameter=None))),
    )
    assert on_shaft.off_centre == pytest.approx(35e-6)
    assert screwed.off_centre == pytest.approx(50e-6)
    assert (on_shaft.shifted, screwed.shifted) == (False, True)
    assert balance_of(device(None)).off_centre is None


def test_resonances_below_top_speed_follow_the_unbalance():
    """The force is U w^2, the amplitude U / m times Q = 1 / (2 x 1 %) for any stiffness."""
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


def test_a_pedestal_adds_a_mode_and_softens_that_of_the_foot():
    """Springs in series: inverse squares of their frequencies add up."""
    device = DEVICES["caged"]
    device = replace(device, motor=replace(device.motor, no_load_speed=3e5, speed_max=None))
    (alone,), foot = resonances_of(device), device.foot
    seats = tuple(
        strengthened(
            Pedestal(foot.base_radius, foot.slot_radius, foot.wheel_height, lean, 0.04), 0.4
        )
        for lean in (0.6, 1.2)
    )
    seat, stem = resonances_of(replace(device, pedestals=seats))
    mass = device.flywheel.mass + device.carrier.mass
    square, along = (max(values) for values in zip(*map(seat_compliance, seats), strict=True))
    assert (2.0 * pi * seat.frequency) ** 2 == pytest.approx(1.0 / (square * mass))
    of_seat = 1.0 / (2.0 * pi) ** 2 / (along * mass)
    assert stem.frequency**-2 == pytest.approx(alone.frequency**-2 + 1.0 / of_seat)
    assert stem.frequency < alone.frequency
    assert (seat.name, stem.name) == ("pedestal", "foot")
    assert seat.force == pytest.approx(
        balance_of(device).unbalance * (2.0 * pi * seat.frequency) ** 2
    )
