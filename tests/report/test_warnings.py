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
from ocs_design.device.records.flights import Margin
from ocs_design.device.records.selection import ReserveRecord
from ocs_design.report.device import device_facts
from ocs_design.report.html.elements import Markup
from ocs_design.report.html.sections import robot_section
from ocs_design.report.story import Story
from ocs_design.report.text.size import print_design
from ocs_design.report.warnings import all_warnings, coupling_notes

DESIGN = Path(__file__).parents[1] / "data" / "design_0_1_0.json"


def changed(*, torque=0.5, fitting=(), sha256="", **motor):
    """A design with this demand on the motor torque [N m], fitting notes and motor fields."""
    sized = design(MOTOR)
    margin = Margin("motor torque", torque, 1.0, "N m")
    ocs = replace(sized.ocs, motor=replace(sized.ocs.motor, **motor), fitting=fitting)
    robot = replace(sized.robot, sha256=sha256)
    return replace(sized, ocs=ocs, robot=robot, margins=(margin,))


def warnings_with(design, words):
    return [warning for warning in all_warnings(design) if words in warning]


WARNED = {
    "a motor above its saturation torque": (
        *("saturates above 0.7 N m", {"torque": 1.7, "saturation_torque": 0.7}, {"torque": 0.69}),
    ),
    "a rotor without inertia": (
        *("never faster", {"rotor_inertia": 0.0}, {"rotor_inertia": 1e-6}),
    ),
    "an unchecked clearance of a robot from a file": (
        *("clearance NOT checked", {"sha256": "12ab"}, {"sha256": ""}),
    ),
}


@pytest.mark.parametrize(("words", "odd", "usual"), WARNED.values(), ids=WARNED)
def test_odd_values_raise_a_warning_and_usual_ones_do_not(words, odd, usual):
    assert len(warnings_with(changed(**odd), words)) == 1
    assert not warnings_with(changed(**odd | usual), words)


@pytest.mark.parametrize(("reliability", "count"), [(0.9999, 1), (0.999, 0)])
def test_a_reliability_beyond_the_samples_raises_a_warning(reliability, count):
    sized = design(MOTOR)
    reserve = ReserveRecord(
        reliability=reliability, predicted=1.0, scale=1.0, nominal=0.5,
        maneuvers=(), costs=(), curve=(),
    )  # fmt: skip
    reserved = replace(sized, selection=replace(sized.selection, kept=reserve))
    words = f"{100.0 * reliability:g} % of robots is set by the worst"
    assert len(warnings_with(reserved, words)) == count


def test_controllers_are_not_in_the_mass():
    """1.8 N m behind a gear of 2 with an efficiency of 0.8 and k_t of 0.025 take 45 A."""
    drive = {
        "torque_limit": 1.8, "gear_ratio": 2.0, "gear_efficiency": 0.8, "no_load_current": None,
        "torque_constant": 0.025,
    }  # fmt: skip
    for fields, current in (
        ({}, "45"),
        ({"no_load_current": 2.0}, "47"),
        ({"saturation_torque": 1.0}, "more than 45"),
    ):
        (warning,) = warnings_with(changed(**drive | fields), "motor controllers")
        assert f"each for {current} A at 24 V" in warning


def test_manual_work_is_listed_with_undesigned_parts_first():
    mounting = "how motor and gear are held is not designed: drill it"
    fitting = ("break the edges", mounting, "cut 14 mm off the shaft")
    *_, first, second, third = all_warnings(changed(fitting=fitting))
    assert (first, second, third) == (mounting, "break the edges", "cut 14 mm off the shaft")


def asymmetric(share, incidence, name="drop"):
    """A design in which a pure pitch needs this share of its momentum about roll."""
    design = read_design(DESIGN)
    (demand,) = (demand for demand in design.requirement.demands if demand.source == name)
    has_roll = incidence > 0.0
    coupled = replace(
        demand, incidence=incidence, roll_momentum=share if has_roll else 0.0, pitch_momentum=1.0
    )
    inertia = ((1.0, share * 2.0, 0.0), (share * 2.0, 2.0, 0.0), (0.0, 0.0, 2.0))
    return replace(
        design,
        ocs=replace(design.ocs, total_inertia=inertia),
        requirement=replace(design.requirement, demands=(coupled,)),
    )


@pytest.mark.parametrize("name", ["drop", "back-flip"])
def test_the_additional_demand_of_pitch_follows_the_rhombus(name):
    """|L_x| / s + |L_y| / c over |L_y| / c."""
    angle = np.radians(6.6)
    (note,) = coupling_notes(asymmetric(0.08, angle, name))
    more = 0.08 / np.sin(angle) * np.cos(angle)
    assert f"{name}: robot and device are not symmetric" in note
    assert f"{more:.0%} more from the busier wheel at 6.6 deg" in note


def test_an_axis_without_authority_drifts():
    """I_xx w_x = -I_xy w_y: 0.16 of roll per pitch."""
    (note,) = coupling_notes(asymmetric(0.08, 0.0))
    assert "cannot turn the robot in roll" in note
    assert "0.16 deg of roll per degree of pitch" in note


@pytest.mark.parametrize("incidence", [0.0, 0.1])
def test_symmetric_robots_have_no_coupling_note(incidence):
    assert not list(coupling_notes(asymmetric(0.0, incidence)))
    assert not list(coupling_notes(asymmetric(1e-5, incidence)))


def test_a_push_has_no_coupling_note():
    assert not list(coupling_notes(asymmetric(0.5, 0.1, "disturbance")))


def test_verbose_output_and_report_have_every_warning():
    sized = changed(torque=1.7, saturation_torque=0.7, sha256="12ab", fitting=("glue the rim",))
    console = Console(file=StringIO(), width=4000)
    print_design(console, sized)
    page = str(robot_section(Story(sized, (), ()), Markup("")))
    warnings = list(all_warnings(sized))
    assert len(warnings) == 4
    for warning in warnings:
        assert console.file.getvalue().count(warning) == 1
        assert escape(warning) in page


@pytest.mark.parametrize(
    ("criterion", "name"),
    [("equal-rate", "alpha*"), ("lightest", "alpha"), ("as specified", "alpha")],
)
def test_only_the_angle_of_a_criterion_is_called_alpha_star(criterion, name):
    """Once the angle of the lightest device was called so too."""
    ocs = replace(design().ocs, incidence_criterion=criterion)
    facts = dict(device_facts(replace(design(), ocs=ocs)))
    assert [fact for fact in facts if "alpha" in fact] == [f"incidence {name}"]
