"""A ring around the bell in place of a wheel: worked figures, and for which motors there is one."""

from dataclasses import replace
from math import pi

import pytest
from wheels import EC45, PAPER_WHEEL, driven_device

from ocs_design.actuation.motor import BoltCircle, Face, Mounting
from ocs_design.device.bell_ring import GLUE_GAP, ring_on_bell, ring_size

BACK = Mounting(0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK)
MN5006 = replace(
    EC45,
    mounting=BACK,
    diameter=0.0556,
    length=0.025,
    torque_limit=0.55,
    rotor_inertia=0.0,
    no_load_speed=1131.0,
    speed_max=1190.0,
)


def device(drive=MN5006):
    wheel = replace(PAPER_WHEEL, density=7833.0, spin_inertia=1e-4)
    return replace(driven_device(drive=drive), flywheel=wheel)


def test_steel_around_an_mn5006():
    """1.0e-4 kg m^2 of steel need 104 g, R 34 mm around r 27.8 mm."""
    outer, mass = ring_size(1e-4, 7850.0, 0.0278, 0.011)
    assert (1e3 * outer, 1e3 * mass) == pytest.approx((34.0, 104.0), abs=0.3)


def test_it_has_the_wheel_s_inertia_and_fits_the_bell():
    ring = ring_on_bell(device())
    assert ring.inner_radius == pytest.approx(0.0278 + GLUE_GAP)
    disc = pi * 7833.0 * ring.height * (ring.outer_radius**4 - ring.inner_radius**4) / 2.0
    assert disc == pytest.approx(1e-4)
    volume = pi * ring.height * (ring.outer_radius**2 - ring.inner_radius**2)
    assert ring.mass == pytest.approx(7833.0 * volume)
    assert ring.beyond == pytest.approx(ring.mass - PAPER_WHEEL.mass)


@pytest.mark.parametrize(
    "drive",
    [
        replace(MN5006, mounting=None),
        replace(MN5006, mounting=replace(BACK, stator_face=Face.OUTPUT)),
        replace(MN5006, length=None),
        replace(MN5006, gear="2 to 1"),
    ],
    ids=["no mounting", "held by its front", "no length", "a gear"],
)
def test_without_a_bell_that_is_known_there_is_none(drive):
    assert ring_on_bell(device(drive)) is None
