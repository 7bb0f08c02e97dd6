"""Screws against what they go through and end in, for every motor of the catalogue."""

from dataclasses import replace
from math import isfinite

import pytest

from ocs_design.actuation.fasteners import CLASSES, IN_PLASTIC, USUAL_CLASS, BoltedJoint, screw
from ocs_design.catalogue.motors import known_motors
from ocs_design.export.assembly.content import tightened
from ocs_design.parts.foot import PLATE_THICKNESS
from ocs_design.parts.housing import LID_SCREWS
from ocs_design.parts.joints import hub_joint, tightening_torque
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import FLOOR, PANEL, trunk_screws

HELD = [
    motor
    for motor in known_motors(None).values()
    if motor.mounting is not None and mount_of(motor, None).screwed
]

# fmt: off
STANDARD = (
    2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70,
    80, 90, 100, 110, 120, 130, 140, 150, 160, 180, 200, 220, 240, 260, 280, 300,
)
# fmt: on
"""Lengths of ISO 4762:2004, table 1 [mm]."""


def fastenings(motor):
    return [each.fastening for each in mount_of(motor, None).screwed]


def test_every_screw_is_standard_and_holds():
    """As short as it may be: the next shorter standard length would not hold.

    As deep as a thread of known depth lets it, where that is less than it asks for.
    """
    assert len(HELD) >= 9
    for motor in HELD:
        for each in (*fastenings(motor), LID_SCREWS, trunk_screws(PLATE_THICKNESS)):
            least = 1e3 * max(each.depth * each.screw.diameter, each.least)
            length = round(1e3 * each.length)
            held = length - 1e3 * each.thickness
            assert length in STANDARD
            assert held >= least - 1e-9
            asked = IN_PLASTIC if each.joint.in_print else 1.0
            deepest = each.most / each.screw.diameter
            turns = 3.0 * each.screw.pitch / each.screw.diameter
            assert each.depth >= min(asked, deepest, turns if isfinite(deepest) else asked) - 1e-12
            shorter = max((other for other in STANDARD if other < length), default=0)
            assert shorter - 1e3 * each.thickness < least


def test_no_screw_reaches_beyond_the_only_depth_that_is_known():
    """U8 Lite's model draws 3.0 and 3.6 mm: M4 x 6 cut to 5.5, and M4 x 6 as it is; 2.5 mm of 4.

    The wheel's joint counts the thread that its screws have, and a usual one where none is known.
    """
    wheel, stator, _ = fastenings(known_motors(None)["U8 Lite L KV110"])
    assert (wheel.designation, stator.designation) == ("ISO 4762 M4 x 6", "ISO 4762 M4 x 6")
    assert (wheel.engagement, stator.engagement) == pytest.approx((2.5e-3, 3.0e-3))
    assert wheel.purpose.endswith("a CAD model has 3 mm: shorten them to 5.5 mm")
    assert stator.purpose.endswith("a CAD model has 3.6 mm")
    drawn = 0
    for motor in HELD:
        circles = motor.mounting.rotor, motor.mounting.stator
        for each, circle in zip(fastenings(motor), filter(None, circles), strict=False):
            assert each.engagement <= circle.deepest + 1e-12
            drawn += circle.drawn is not None
        if motor.mounting.rotor is not None:
            held = fastenings(motor)[0]
            needed = CLASSES[held.strength].depth * held.screw.diameter
            share = min(1.0, held.engagement / needed)
            assert motor.mounting.rotor.preload_share == pytest.approx(share)
            whole = replace(motor.mounting.rotor, drawn=None, depth_max=None)
            free = hub_joint(replace(motor.mounting, rotor=whole), 0.0)
            assert hub_joint(motor.mounting, 0.0) == pytest.approx(share * free)
            found = tightened(held).torque
            assert found == pytest.approx(share * tightening_torque(held.screw, held.strength))
    assert drawn > 20


@pytest.mark.parametrize("name", ["M4", "M8"])
def test_long_screws_are_standard_too(name):
    """Those through masts and posts: from 70 mm on the steps are 10 mm, from 160 mm 20 mm."""
    held = screw(name)
    for through in range(300 - round(1e3 * held.diameter)):
        least = through + 1e3 * held.diameter
        length = 1e3 * held.length_through(1e-3 * through)
        assert length == pytest.approx(next(each for each in STANDARD if each >= least - 1e-9))


def test_no_screw_ends_in_what_is_behind_its_thread():
    """In a cage its thread is as long as the motor and the gap; else the depth is to be checked."""
    for motor in HELD:
        mount = mount_of(motor, None)
        for each in mount.screwed:
            held = each.fastening
            if held.joint.in_print:
                room = PANEL + PLATE_THICKNESS + mount.cage.length - FLOOR
                assert held.length <= room + 1e-12
            else:
                assert "check the depth of the motor's thread" in held.purpose


VDI_2230 = {"M4": (4.4e3, 3.0), "M5": (7.2e3, 5.9), "M6": (10.2e3, 10.1)}
"""Preload [N] and torque [N m] of class 8.8 at a friction of 0.12, VDI 2230-1, table A1, which is
for the hexagon heads of ISO 4014."""


@pytest.mark.parametrize("name", VDI_2230)
def test_torques_are_those_of_vdi_2230(name):
    preload, torque = VDI_2230[name]
    assert screw(name).preload == pytest.approx(preload, rel=0.01)
    assert screw(name).torque(screw(name).preload) == pytest.approx(torque, rel=0.05)


def test_no_torque_is_beyond_what_screw_thread_and_print_stand():
    for motor in HELD:
        for each in (*fastenings(motor), LID_SCREWS, trunk_screws(PLATE_THICKNESS)):
            own = BoltedJoint.MOTOR if each.joint is BoltedJoint.WHEEL else each.joint
            soft, hard = (
                tightened(replace(each, joint=joint)) for joint in (own, BoltedJoint.WHEEL)
            )
            stronger = CLASSES[each.strength].yields / CLASSES[USUAL_CLASS].yields
            most = each.screw.torque(stronger * each.screw.preload)
            assert 0.0 < soft.torque <= hard.torque <= most
            if each.joint.in_print:
                assert "PETG" in soft.rule


def test_a_print_s_thread_is_tightened_by_hand():
    """M2 in 4.8 mm of PETG: pi 2 4.8 / 2 x 47 / sqrt(3) = 409 N strip it; a third, 136.4 N."""
    found = tightened(LID_SCREWS)
    each = LID_SCREWS.screw
    assert found.torque == pytest.approx(each.torque(136.4), rel=2e-3)
    assert found.engagement == pytest.approx(4.8e-3)
    assert "strips" in found.rule
