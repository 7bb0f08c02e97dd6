"""Mounts of motors: screws, hubs and shafts."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wheels import PAPER_WHEEL

from ocs_design.actuation.fasteners import LIGAMENT, SCREWS, BoltCircle
from ocs_design.actuation.motor import Face, GearRoom, Mounting
from ocs_design.catalogue.motors import motor
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.motor_mount import (
    HUB_WALL,
    PILOT_BORE,
    bond_length,
    hub_of,
    is_held,
    motor_front,
    mount_of,
)
from ocs_design.parts.rim import WEB_THICKNESS, Hub, wheel_body
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import Flywheel, Web, wheel_parts

FLAT = replace(motor("MN5212 KV340"), diameter=0.059, length=0.0335)
AT_BACK = Mounting(0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK)
AT_OUTPUT = replace(AT_BACK, stator_face=Face.OUTPUT)


def motor_with(mounting):
    return replace(FLAT, mounting=mounting)


@pytest.mark.parametrize(
    ("motor", "room", "held"),
    [
        (motor_with(AT_OUTPUT), None, True),
        (motor_with(AT_BACK), None, True),
        (motor_with(None), None, False),
        (motor_with(replace(AT_BACK, stator=None, stator_face=None)), None, False),
        # Only the screws of the rotor are known.
        (motor_with(Mounting(rotor=BoltCircle(0.017, 3, "M3"))), None, False),
        # A cage needs the motor's length.
        (replace(motor_with(AT_BACK), length=None), None, False),
        # The mount of a motor behind a gear is unknown.
        (motor_with(AT_OUTPUT), GearRoom(), False),
    ],
)
def test_a_motor_is_held_by_known_screws(motor, room, held):
    assert is_held(motor, room) == held


@pytest.mark.parametrize(("name", "wheel"), [("188 LV", 16), ("208 LV", 20)])
def test_screws_reach_the_depth_that_the_maker_requires(name, wheel):
    """3 mm of hub and 13 mm are M6 x 16; 16 to 16.8 mm are M8 x 20, which is 0.2 mm too long."""
    on_rotor, at_back, _ = mount_of(motor(name), None).screwed
    assert on_rotor.fastening.length == pytest.approx(1e-3 * wheel)
    shorten = "shorten them to 19.8 mm" in on_rotor.fastening.purpose
    assert shorten == (name == "208 LV")
    for each in (on_rotor, at_back):
        depth = each.fastening.length - each.fastening.thickness
        assert each.circle.depth - 1e-12 <= depth
        assert depth <= each.circle.depth_max + (2e-4 if shorten else 0.0) + 1e-12


PLAIN = replace(motor("MN5212 KV340"), diameter=0.05, mounting=None)


def test_the_tallest_rim_leaves_the_shaft_its_length_in_the_hub():
    """30 mm less plate, wall, gap and half of the hub: 2 x (30 - 5 - 3.2 - 2.5) mm of rim."""
    behind = mount_of(motor_with(replace(AT_OUTPUT, shaft_length=0.03)), None)
    assert behind.rim_height_max == pytest.approx(0.0386)
    front = motor_front(behind, behind.rim_height_max)
    through = replace(AT_OUTPUT, shaft_length=0.03)
    assert bond_length(through, 0.005, 0.0, front) == pytest.approx(0.005)
    assert bond_length(through, 0.005, 0.0, front - 0.001) == pytest.approx(0.004)
    # A shaft too short for any rim is reported by its joint.
    assert mount_of(motor_with(replace(AT_OUTPUT, shaft_length=0.01)), None).rim_height_max == inf
    assert bond_length(replace(through, shaft_length=0.01), 0.005, 0.0, front) == 0.0


def wheel_on(hub: Hub) -> Flywheel:
    """A wheel with the smallest steel rim that fits this hub."""
    inner, density = hub.radius + LIGAMENT, PAPER_WHEEL.density
    mass = cylinder_mass(0.0, inner, WEB_THICKNESS, density) + hub.beyond_web(density).mass
    web = Web(PAPER_WHEEL.material, density, WEB_THICKNESS, mass, hub)
    return replace(PAPER_WHEEL, inner_radius=inner, outer_radius=inner + 0.01, web=web)


def hub_on(mounting: Mounting) -> Hub:
    return hub_of(mounting, PLAIN.diameter)


@st.composite
def mountings(draw: st.DrawFn) -> Mounting:
    """Mountings that the catalogue accepts."""
    thread = draw(st.sampled_from(SCREWS)).name
    rotor = BoltCircle(draw(st.floats(0.008, 0.045)), draw(st.integers(3, 8)), thread)
    shaft = draw(st.none() | st.floats(0.001, 0.01))
    assume(rotor.inside >= (shaft or 0.0) / 2.0 + LIGAMENT)
    assume(rotor.spacing >= LIGAMENT)
    return Mounting(shaft, rotor)


@given(mountings())
def test_hubs_for_all_accepted_mountings_can_be_made_with_the_sized_mass(mounting):
    wheel = wheel_on(hub_on(mounting))
    parts = total(wheel_parts(wheel.shape))
    exact = [parts.mass, parts.inertia[2, 2], parts.inertia[0, 0]]
    size = (wheel.inner_radius, wheel.outer_radius, wheel.height, wheel.density)
    body = wheel_body(*size, wheel.web.hub)
    expected = [body.mass, body.axial_inertia, body.transverse_inertia]
    np.testing.assert_allclose(exact, expected, rtol=1e-9)
    assert parts.inertia[1, 1] == pytest.approx(parts.inertia[0, 0], rel=1e-12)


def test_hub_of_a_known_shaft_and_threads():
    """MN5212: a shaft of 4 mm, 3 x M3 on 17 mm; M3 passes through 3.4 mm."""
    known = motor("MN5212 KV340")
    hub = hub_of(known.mounting, known.diameter)
    assert (hub.bore_radius, hub.bolts) == (0.002, 3)
    assert (hub.bolt_circle_radius, hub.bolt_hole_radius) == pytest.approx((0.0085, 0.0017))
    assert hub.radius == pytest.approx(0.0085 + 0.0017 + HUB_WALL)


def test_a_hub_without_threads_is_as_long_and_twice_as_wide_as_the_shaft():
    bare, shaft = hub_of(None, PLAIN.diameter), hub_on(Mounting(shaft_diameter=0.006))
    assert (bare.bore_radius, bare.bolts) == (PILOT_BORE / 2.0, 0)
    assert shaft == replace(bare, bore_radius=0.003, radius=0.006, height=0.006)
    wide = hub_on(Mounting(shaft_diameter=0.04))
    assert (wide.radius, wide.height) == pytest.approx((0.04, 0.04))
    thin = hub_on(Mounting(shaft_diameter=0.003))
    assert (thin.radius, thin.height) == pytest.approx((0.0015 + HUB_WALL, 0.005))


def test_a_pilot_bore_clears_the_screws():
    hub = hub_on(Mounting(rotor=BoltCircle(0.007, 3, "M2")))
    assert hub.bore_radius == pytest.approx(0.0035 - 0.0012 - LIGAMENT)
    assert hub.bore_radius < PILOT_BORE / 2.0
