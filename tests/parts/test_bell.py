"""Rings around bells: motors with a bell, tension in the bond, and the fixture."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from part_gaps import overlap_volume, turning_clearance

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import Face, Mounting
from ocs_design.catalogue.motors import motors
from ocs_design.parts.bell import FIXTURE_FIT, FIXTURE_FLOOR, GLUE_GAP, bell_of, fixture_part
from ocs_design.parts.joints import (
    BELL_EXPANSION,
    BOND_SHARE,
    COLDEST,
    EPOXY_STRENGTH,
    HOTTEST,
    MADE,
    bell_bond_radius,
    bell_bond_tension,
)
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import CLEARANCE, PANEL
from ocs_design.parts.solids import Part, hollow_cylinder
from ocs_design.parts.turning_rings import Ring, TurningRings

MN5006 = motors()["Antigravity MN5006 KV450"]
STEEL = {"density": 7833.0, "elastic_modulus": 207e9, "poisson_ratio": 0.32}


def test_the_bell_of_an_mn5006():
    """55.6 mm across, 25 mm long, its shaft 5 mm out."""
    bell = bell_of(MN5006)
    assert bell.bore == pytest.approx(0.0278 + GLUE_GAP)
    assert bell.straight == pytest.approx(0.45 * 0.025 - 0.005 - CLEARANCE)
    # Motor, shaft and clearance fill the housing from floor to lid.
    assert bell.room + 2.0 * CLEARANCE == pytest.approx(0.025 + 0.005 + CLEARANCE)
    # The ring is in the middle of the housing, and within the middle 45 % of the motor.
    from_back = 0.025 - bell.front
    assert from_back == pytest.approx((bell.room + 2.0 * CLEARANCE) / 2.0)
    assert from_back + bell.straight / 2.0 == pytest.approx(0.025 / 2.0 + 0.45 * 0.025 / 2.0)


@pytest.mark.parametrize(
    "changed",
    [
        {"mounting": None},
        {"mounting": replace(MN5006.mounting, stator_face=Face.OUTPUT)},
        {"mounting": replace(MN5006.mounting, stator=None)},
        {"mounting": replace(MN5006.mounting, shaft_length=0.02)},
        {"length": None},
        {"diameter": None},
    ],
    ids=["no mounting", "front mounting", "no threads", "long shaft", "no length", "no diameter"],
)
def test_motors_without_a_known_bell_have_none(changed):
    assert bell_of(replace(MN5006, **changed)) is None


def test_screws_of_a_motor_on_the_floor_reach_through_plate_and_floor():
    mount = mount_of(MN5006, None, on_bell=True)
    (screwed,) = mount.screwed
    assert mount.cage is None
    assert screwed.fastening.length > PANEL + mount.foot_plate
    middle = mount.foot_plate + mount.gap + MN5006.length / 2.0
    assert middle == pytest.approx(-PANEL - MN5006.length / 2.0)
    assert mount.behind(MN5006).depth == pytest.approx(screwed.fastening.screw.head_height)


@pytest.mark.parametrize("speed", [300.0, 1200.0])
@pytest.mark.parametrize("expansion", [4.5e-6, BELL_EXPANSION, 20.5e-6])
def test_bond_tension_is_that_of_a_ring_on_a_rigid_bell(speed, expansion):
    """Against the equations of rings with a massless core, a million times as stiff."""
    core = Ring(0.0, 0.0279, 0.01, 1e-9, 1e6 * 207e9, 0.3)
    ring = Ring(0.0279, 0.042, 0.01, 7833.0, 207e9, 0.32)
    gaps = [(expansion - BELL_EXPANSION) * (at - MADE) * 0.0279 for at in (COLDEST, HOTTEST)]
    turning = [TurningRings.of((core, ring), speed, [-gap]) for gap in gaps]
    tension = bell_bond_tension(0.0279, 0.042, **STEEL, expansion=expansion, speed=speed)
    assert tension == pytest.approx(max(-each.pressure(0) for each in turning), rel=1e-4)


def test_the_widest_ring_has_the_permitted_bond_tension():
    figures = {name: np.array([value]) for name, value in STEEL.items()}
    figures |= {"expansion": np.array([12.3e-6]), "speed": np.array([1200.0])}
    widest = bell_bond_radius(np.array([0.0279]), 0.1, **figures)
    tension = bell_bond_tension(0.0279, widest, **figures)
    assert tension == pytest.approx(BOND_SHARE * EPOXY_STRENGTH, rel=1e-4)
    assert tension <= BOND_SHARE * EPOXY_STRENGTH


def test_the_fixture_holds_bell_and_ring_on_one_axis():
    bell = bell_of(
        replace(MN5006, mounting=Mounting(0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK))
    )
    outer, height = 0.042, 0.0034
    fixture = fixture_part(bell, outer, height)
    low = FIXTURE_FLOOR + bell.front - height / 2.0
    ring = Part("ring", 1.0, (hollow_cylinder(bell.bore, outer, low, low + height),))
    radius = bell.bore - GLUE_GAP
    motor = Part("bell", 1.0, (hollow_cylinder(0.0, radius, FIXTURE_FLOOR, 0.03),))
    assert overlap_volume(fixture, ring) + overlap_volume(fixture, motor) < 1e-14
    # Raised off step and floor, ring and bell have only the lateral play.
    lifted = Part("ring", 1.0, (hollow_cylinder(bell.bore, outer, low + 1e-3, low + height),))
    for part in (lifted, Part("bell", 1.0, (hollow_cylinder(0.0, radius, 0.005, 0.03),))):
        assert turning_clearance([part], [fixture], 0.01) == pytest.approx(FIXTURE_FIT, abs=1e-5)
    touching = Part("ring", 1.0, (hollow_cylinder(bell.bore, outer, low - 1e-4, low + height),))
    step = pi * (outer**2 - (radius + FIXTURE_FIT + 1e-3) ** 2) * 1e-4
    assert overlap_volume(fixture, touching) == pytest.approx(step, rel=1e-3)
