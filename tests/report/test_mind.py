"""What a reader has to mind of a design, all of it under one heading."""

from dataclasses import replace

import pytest
from designed import MOTOR
from stories import design

from ocs_design.design_file import MarginRecord
from ocs_design.report.mind import mind


def changed(*, asked=0.5, fitting=(), sha256="", **motor):
    """A design that asks a wheel for so much torque [N m]."""
    found = design(MOTOR)
    torque = MarginRecord(
        name="torque, to the current limit", demand=asked, capacity=1.0, unit="N m", margin=None,
        maneuver="", note="",
    )  # fmt: skip
    ocs = replace(found.ocs, motor=replace(found.ocs.motor, **motor), fitting=fitting)
    robot = replace(found.robot, sha256=sha256)
    return replace(found, ocs=ocs, robot=robot, margins=(torque,))


def said(design, words):
    return [each for each in mind(design) if words in each]


@pytest.mark.parametrize(("asked", "told"), [(1.7, 1), (0.69, 0)])
def test_a_motor_past_its_saturation_is_minded_where_it_is_used_so(asked, told):
    found = said(changed(asked=asked, saturation_torque=0.7), "saturates from 0.7 N m")
    assert len(found) == told


@pytest.mark.parametrize(("inertia", "told"), [(0.0, 1), (1e-6, 0)])
def test_a_rotor_that_counts_as_nothing_is_minded(inertia, told):
    assert len(said(changed(rotor_inertia=inertia), "never faster")) == told


def test_controllers_are_not_in_the_mass():
    """45 A: 1.8 N m behind a gear of 2 with an efficiency of 0.8 and k_t of 0.025."""
    drive = {"torque_limit": 1.8, "gear_ratio": 2.0, "gear_efficiency": 0.8}
    (found,) = said(changed(torque_constant=0.025, **drive), "motor controllers")
    assert "each for 45 A at 24 V" in found
    saturating = changed(torque_constant=0.025, saturation_torque=1.0, **drive)
    assert said(saturating, "each for more than 45 A at 24 V")


def test_parts_that_are_left_to_design_are_named_and_the_rest_counted():
    held = "how motor and gear are held is not designed: drill it"
    fitting = ("break the edges", held, "mind the shaft")
    found = said(changed(fitting=fitting), "not designed")
    assert found == [held]
    assert said(changed(fitting=fitting), "are 2 notes more")
    assert said(changed(fitting=fitting[:2]), "is a note more")


@pytest.mark.parametrize(("sha256", "told"), [("12ab", 1), ("", 0)])
def test_a_clearance_that_was_not_checked_is_minded_of_a_robot_from_a_file(sha256, told):
    assert len(said(changed(sha256=sha256), "clearance NOT checked")) == told
