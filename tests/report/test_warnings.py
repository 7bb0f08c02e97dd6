"""Warnings about a design, and notes on robots that are not symmetric to their sagittal plane."""

from dataclasses import replace
from html import escape
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from designed_devices import MOTOR
from rich.console import Console
from stories import design

from ocs_design.device.records.design import read_design
from ocs_design.device.records.device import Margin
from ocs_design.device.records.selection import ReserveRecord
from ocs_design.report.device import device_facts
from ocs_design.report.html.elements import Markup
from ocs_design.report.html.sections import robot_section
from ocs_design.report.story import Story
from ocs_design.report.text.size import print_design
from ocs_design.report.warnings import all_warnings, coupling_notes

DESIGN = Path(__file__).parents[1] / "data" / "design_0_1_0.json"


def changed(*, asked=0.5, fitting=(), sha256="", **motor):
    """A design that asks a wheel for so much torque [N m]."""
    found = design(MOTOR)
    torque = Margin("motor torque", asked, 1.0, "N m")
    ocs = replace(found.ocs, motor=replace(found.ocs.motor, **motor), fitting=fitting)
    robot = replace(found.robot, sha256=sha256)
    return replace(found, ocs=ocs, robot=robot, margins=(torque,))


def said(design, words):
    return [each for each in all_warnings(design) if words in each]


MINDED = {
    "a motor past its saturation": (
        *("saturates above 0.7 N m", {"asked": 1.7, "saturation_torque": 0.7}, {"asked": 0.69}),
    ),
    "a rotor that counts as nothing": (
        *("never faster", {"rotor_inertia": 0.0}, {"rotor_inertia": 1e-6}),
    ),
    "a clearance not checked of a robot from a file": (
        *("clearance NOT checked", {"sha256": "12ab"}, {"sha256": ""}),
    ),
}


@pytest.mark.parametrize(("words", "odd", "usual"), MINDED.values(), ids=MINDED)
def test_what_is_odd_is_minded_and_what_is_not_is_not(words, odd, usual):
    assert len(said(changed(**odd), words)) == 1
    assert not said(changed(**odd | usual), words)


@pytest.mark.parametrize(("reliability", "told"), [(0.9999, 1), (0.999, 0)])
def test_a_reserve_for_more_than_the_robots_drawn_can_tell_is_minded(reliability, told):
    found = design(MOTOR)
    kept = ReserveRecord(
        reliability=reliability, predicted=1.0, scale=1.0, nominal=0.5,
        maneuvers=(), costs=(), curve=(),
    )  # fmt: skip
    surer = replace(found, selection=replace(found.selection, kept=kept))
    assert len(said(surer, f"{100.0 * reliability:g} % of robots is set by the worst")) == told


def test_controllers_are_not_in_the_mass():
    """45 A: 1.8 N m behind a gear of 2 with an efficiency of 0.8 and k_t of 0.025."""
    drive = {
        "torque_limit": 1.8, "gear_ratio": 2.0, "gear_efficiency": 0.8, "no_load_current": None,
        "torque_constant": 0.025,
    }  # fmt: skip
    for more, current in (
        ({}, "45"),
        ({"no_load_current": 2.0}, "47"),
        ({"saturation_torque": 1.0}, "more than 45"),
    ):
        (found,) = said(changed(**drive | more), "motor controllers")
        assert f"each for {current} A at 24 V" in found


def test_all_work_by_hand_is_minded_and_parts_that_are_left_to_design_first():
    held = "how motor and gear are held is not designed: drill it"
    fitting = ("break the edges", held, "cut 14 mm off the shaft")
    *_, first, second, third = all_warnings(changed(fitting=fitting))
    assert (first, second, third) == (held, "break the edges", "cut 14 mm off the shaft")


def lopsided(share, incidence, name="drop"):
    """A design whose pure pitch takes this share of its momentum about roll."""
    design = read_design(DESIGN)
    (demand,) = (each for each in design.requirement.demands if each.source == name)
    reached = incidence > 0.0
    asked = replace(
        demand, incidence=incidence, roll_momentum=share if reached else 0.0, pitch_momentum=1.0
    )
    inertia = ((1.0, share * 2.0, 0.0), (share * 2.0, 2.0, 0.0), (0.0, 0.0, 2.0))
    return replace(
        design,
        ocs=replace(design.ocs, total_inertia=inertia),
        requirement=replace(design.requirement, demands=(asked,)),
    )


@pytest.mark.parametrize("name", ["drop", "back-flip"])
def test_what_a_pitch_asks_more_is_that_of_the_rhombus(name):
    """|L_x| / s + |L_y| / c over |L_y| / c."""
    angle = np.radians(6.6)
    (said,) = coupling_notes(lopsided(0.08, angle, name))
    more = 0.08 / np.sin(angle) * np.cos(angle)
    assert f"{name}: robot and device are not symmetric" in said
    assert f"{more:.0%} more from the busier wheel at 6.6 deg" in said


def test_an_axis_out_of_reach_drifts():
    """I_xx w_x = -I_xy w_y: 0.16 of roll per pitch."""
    (said,) = coupling_notes(lopsided(0.08, 0.0))
    assert "cannot turn the robot in roll" in said
    assert "0.16 deg of roll per degree of pitch" in said


@pytest.mark.parametrize("incidence", [0.0, 0.1])
def test_nothing_is_said_of_symmetric_robots(incidence):
    assert not list(coupling_notes(lopsided(0.0, incidence)))
    assert not list(coupling_notes(lopsided(1e-5, incidence)))


def test_a_push_asks_for_what_it_is():
    assert not list(coupling_notes(lopsided(0.5, 0.1, "disturbance")))


def test_with_v_and_in_the_report_everything_to_mind_is_told():
    found = changed(asked=1.7, saturation_torque=0.7, sha256="12ab", fitting=("glue the rim",))
    console = Console(file=StringIO(), width=4000)
    print_design(console, found)
    page = str(robot_section(Story(found, (), ()), Markup("")))
    minded = list(all_warnings(found))
    assert len(minded) == 4
    for each in minded:
        assert console.file.getvalue().count(each) == 1
        assert escape(each) in page


@pytest.mark.parametrize(
    ("criterion", "name"),
    [("equal-rate", "alpha*"), ("lightest", "alpha"), ("as specified", "alpha")],
)
def test_only_an_angle_by_a_criterion_is_called_alpha_star(criterion, name):
    """The lightest one was too."""
    ocs = replace(design().ocs, incidence_criterion=criterion)
    facts = dict(device_facts(replace(design(), ocs=ocs)))
    assert [each for each in facts if "alpha" in each] == [f"incidence {name}"]
