"""Lengths and torques of the screws for every motor of the catalogue."""

from dataclasses import replace
from math import isfinite

import pytest

from ocs_design.actuation.fasteners import CLASSES, IN_PLASTIC, USUAL_CLASS, BoltedJoint, screw
from ocs_design.catalogue.motors import motors
from ocs_design.export.assembly.content import tightened
from ocs_design.parts.foot import PLATE_THICKNESS
from ocs_design.parts.housing import LID_SCREWS
from ocs_design.parts.joints import hub_joint, tightening_torque
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import FLOOR, PANEL, trunk_screws

SCREWED = [
    motor
    for motor in motors().values()
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
    return [screwed.fastening for screwed in mount_of(motor, None).screwed]


def test_every_screw_is_standard_and_holds():
    """Screws are as short as possible: the next shorter standard length would not hold.

    They go as deep as a thread of known depth allows, where it is shallower than required.
    """
    assert len(SCREWED) >= 9
    for motor in SCREWED:
        for fastening in (*fastenings(motor), LID_SCREWS, trunk_screws(PLATE_THICKNESS)):
            least = 1e3 * max(fastening.depth * fastening.screw.diameter, fastening.engagement_min)
            length = round(1e3 * fastening.length)
            engagement = length - 1e3 * fastening.thickness
            assert length in STANDARD
            assert engagement >= least - 1e-9
            required = IN_PLASTIC if fastening.joint.in_print else 1.0
            deepest = fastening.engagement_max / fastening.screw.diameter
            three_pitches = 3.0 * fastening.screw.pitch / fastening.screw.diameter
            assert (
                fastening.depth
                >= min(required, deepest, three_pitches if isfinite(deepest) else required) - 1e-12
            )
            shorter = max((other for other in STANDARD if other < length), default=0)
            assert shorter - 1e3 * fastening.thickness < least


def test_no_screw_is_longer_than_a_thread_of_known_depth():
    """The CAD model of U8 Lite has threads of 3.0 and 3.6 mm: M4 x 6 cut to 5.5 mm, and M4 x 6.

    The wheel's joint counts the engaged thread, and a usual one where the depth is not known.
    """
    wheel, stator, _ = fastenings(motors()["U8 Lite L KV110"])
    assert (wheel.designation, stator.designation) == ("ISO 4762 M4 x 6", "ISO 4762 M4 x 6")
    assert (wheel.engagement, stator.engagement) == pytest.approx((2.5e-3, 3.0e-3))
    assert wheel.purpose.endswith("a CAD model has 3 mm: shorten them to 5.5 mm")
    assert stator.purpose.endswith("a CAD model has 3.6 mm")
    drawn = 0
    for motor in SCREWED:
        circles = motor.mounting.rotor, motor.mounting.stator
        for fastening, circle in zip(fastenings(motor), filter(None, circles), strict=False):
            assert fastening.engagement <= circle.deepest + 1e-12
            drawn += circle.drawn is not None
        if motor.mounting.rotor is not None:
            of_wheel = fastenings(motor)[0]
            needed = CLASSES[of_wheel.strength].depth * of_wheel.screw.diameter
            share = min(1.0, of_wheel.engagement / needed)
            assert motor.mounting.rotor.preload_share == pytest.approx(share)
            unlimited = replace(motor.mounting.rotor, drawn=None, depth_max=None)
            free = hub_joint(replace(motor.mounting, rotor=unlimited), 0.0)
            assert hub_joint(motor.mounting, 0.0) == pytest.approx(share * free)
            torque = tightened(of_wheel).torque
            assert torque == pytest.approx(
                share * tightening_torque(of_wheel.screw, of_wheel.strength)
            )
    assert drawn > 20


@pytest.mark.parametrize("name", ["M4", "M8"])
def test_long_screws_are_standard_too(name):
    """Those through masts and posts: from 70 mm on the steps are 10 mm, from 160 mm 20 mm."""
    size = screw(name)
    for thickness in range(300 - round(1e3 * size.diameter)):
        least = thickness + 1e3 * size.diameter
        length = 1e3 * size.length_through(1e-3 * thickness)
        assert length == pytest.approx(next(other for other in STANDARD if other >= least - 1e-9))


def test_no_screw_is_longer_than_its_thread():
    """A cage's thread is as long as motor and gap; elsewhere a note asks to check the depth."""
    for motor in SCREWED:
        mount = mount_of(motor, None)
        for screwed in mount.screwed:
            fastening = screwed.fastening
            if fastening.joint.in_print:
                available = PANEL + PLATE_THICKNESS + mount.cage.length - FLOOR
                assert fastening.length <= available + 1e-12
            else:
                assert "check the depth of the motor's thread" in fastening.purpose


VDI_2230 = {"M4": (4.4e3, 3.0), "M5": (7.2e3, 5.9), "M6": (10.2e3, 10.1)}
"""Preload [N] and torque [N m] of class 8.8 at a friction of 0.12, VDI 2230-1, table A1, which is
for the hexagon heads of ISO 4014."""


@pytest.mark.parametrize("name", VDI_2230)
def test_torques_are_those_of_vdi_2230(name):
    preload, torque = VDI_2230[name]
    assert screw(name).preload == pytest.approx(preload, rel=0.01)
    assert screw(name).torque(screw(name).preload) == pytest.approx(torque, rel=0.05)


def test_no_torque_exceeds_the_strength_of_screw_thread_and_print():
    for motor in SCREWED:
        for fastening in (*fastenings(motor), LID_SCREWS, trunk_screws(PLATE_THICKNESS)):
            metal = fastening.joint is BoltedJoint.WHEEL
            own = BoltedJoint.MOTOR if metal else fastening.joint
            soft, hard = (
                tightened(replace(fastening, joint=joint)) for joint in (own, BoltedJoint.WHEEL)
            )
            strength_ratio = CLASSES[fastening.strength].yields / CLASSES[USUAL_CLASS].yields
            limit = fastening.screw.torque(strength_ratio * fastening.screw.preload)
            assert 0.0 < soft.torque <= hard.torque <= limit
            if fastening.joint.in_print:
                assert "PETG" in soft.rule


def test_a_printed_thread_takes_a_third_of_its_stripping_force():
    """M2 in 4.8 mm of PETG: pi 2 4.8 / 2 x 47 / sqrt(3) = 409 N strip it; a third, 136.4 N."""
    tightening = tightened(LID_SCREWS)
    lid_screw = LID_SCREWS.screw
    assert tightening.torque == pytest.approx(lid_screw.torque(136.4), rel=2e-3)
    assert tightening.engagement == pytest.approx(4.8e-3)
    assert "strips" in tightening.rule
