"""Whether known screws hold a motor."""

from dataclasses import replace

import pytest

from ocs_design.actuation.motor import BoltCircle, Face, GearRoom, Mounting
from ocs_design.catalogue.motors import motor
from ocs_design.parts.motor_mount import is_held, mount_of

FLAT = replace(motor("MN5212 KV340"), diameter=0.059, length=0.0335)
AT_BACK = Mounting(0.004, None, BoltCircle(0.025, 4, "M3"), Face.BACK)
AT_OUTPUT = replace(AT_BACK, stator_face=Face.OUTPUT)


def on(mounting):
    return replace(FLAT, mounting=mounting)


def test_screws_hold_it_by_either_face():
    assert is_held(on(AT_OUTPUT), None)
    assert is_held(on(AT_BACK), None)


@pytest.mark.parametrize(
    "loose",
    [
        on(None),
        on(replace(AT_BACK, stator=None, stator_face=None)),
        on(Mounting(rotor=BoltCircle(0.017, 3, "M3"))),
        # The cage around it needs its size.
        replace(on(AT_BACK), length=None),
    ],
)
def test_nothing_that_is_known_holds_it(loose):
    """Also where it is known how the wheel is screwed to the rotor."""
    assert not is_held(loose, None)


def test_behind_a_gear_it_is_not_known_what_holds_it():
    assert not is_held(on(AT_OUTPUT), GearRoom())


@pytest.mark.parametrize(("name", "wheel"), [("188 LV", 16), ("208 LV", 20)])
def test_screws_reach_as_deep_as_the_maker_asks(name, wheel):
    """3 mm of hub and 13 mm are M6 x 16; 16 to 16.8 mm are M8 x 20, and 0.2 mm too much."""
    on_rotor, at_back, _ = mount_of(motor(name), None).screwed
    assert on_rotor.fastening.length == pytest.approx(1e-3 * wheel)
    shorten = "shorten them to 19.8 mm" in on_rotor.fastening.purpose
    assert shorten == (name == "208 LV")
    for each in (on_rotor, at_back):
        reaches = each.fastening.length - each.fastening.thickness
        assert each.circle.depth - 1e-12 <= reaches
        assert reaches <= each.circle.depth_max + (2e-4 if shorten else 0.0) + 1e-12
