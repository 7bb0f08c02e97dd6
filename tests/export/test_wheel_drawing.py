"""The drawing says of the wheel what the design says."""

import math
from dataclasses import replace

import pytest
from wheels import paper_device

from ocs_design.device.device import Web
from ocs_design.export.device_parts import wheel_geometry
from ocs_design.export.drawing.wheel_sheet import device_hash, wheel_drawing
from ocs_design.parts.rim import WEB_MATERIAL, WEB_THICKNESS, Hub

DEVICE = paper_device()
HUB = Hub(0.010, 0.005, 0.0015, bolts=4, bolt_circle_radius=0.006, bolt_hole_radius=0.0011)


def on_a_web(device):
    wheel = device.flywheel
    web = Web(WEB_MATERIAL, 2710.0, WEB_THICKNESS, 0.01, HUB)
    return replace(device, flywheel=replace(wheel, web=web))


def test_mass_and_inertia_are_the_designed_ones():
    drawing = wheel_drawing(DEVICE, "solo12")
    found, wheel = drawing.mass_properties, DEVICE.flywheel
    assert found.mass == pytest.approx(wheel.mass, rel=1e-9)
    rotor = DEVICE.motor.rotor_inertia
    assert found.inertia[2, 2] == pytest.approx(wheel.spin_inertia - rotor, rel=1e-9)
    assert found.inertia[0, 0] == pytest.approx(wheel.transverse_inertia, rel=1e-9)


def test_a_web_is_made_with_the_hub_that_was_sized():
    made = wheel_geometry(on_a_web(DEVICE).flywheel)
    assert (made.hub.bolts.count, made.hub.bolts.radius) == (4, 0.006)
    assert made.hub.material == WEB_MATERIAL
    no_bolts = replace(HUB, bolts=0)
    web = replace(on_a_web(DEVICE).flywheel.web, hub=no_bolts)
    assert wheel_geometry(replace(DEVICE.flywheel, web=web)).hub.bolts is None


def test_the_hash_follows_the_parts_and_not_their_place():
    turned = DEVICE.at_incidence(0.3)
    heavier = replace(DEVICE, flywheel=replace(DEVICE.flywheel, height=0.02))
    assert device_hash(DEVICE) == device_hash(turned) != device_hash(heavier)
    assert len(device_hash(DEVICE)) == 12


@pytest.mark.parametrize(("fastest", "said"), [(math.inf, None), (800.0, 800.0)])
def test_a_speed_without_limit_is_no_speed(fastest, said):
    motor = replace(DEVICE.motor, no_load_speed=fastest, speed_max=None)
    device = replace(DEVICE, motor=motor)
    assert wheel_drawing(device, "x").speed == said
