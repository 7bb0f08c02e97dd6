"""Layouts side by side: what they reach, with all wheels and with one lost, and what is refused."""

import re

import numpy as np
import pytest
from commands import SOLO12, run
from designed_devices import solo12_specification, solo12_task

from ocs_design.actuation.wheel_load import reach, reach_without_one
from ocs_design.common.errors import Constraint, Infeasible, UsageError
from ocs_design.device.layout import ISOTROPIC, PAIR, Layout, LayoutName
from ocs_design.device.records.design import read_design
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.device_sections import OcsSection
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.specification import Specification, merge, specification_from_options
from ocs_design.requirement.vocabulary import LAYOUTS
from ocs_design.sizing.design import design_device
from ocs_design.sizing.selection.bounds import RimFloor
from ocs_design.sizing.specified import CannotSurvive, selection_problem, specified_layout
from ocs_design.sizing.trajectory.plans import drive_line_of, plan
from ocs_design.workflows import layouts
from ocs_design.workflows.layouts import compare_layouts
from ocs_design.workflows.pareto import read_task
from ocs_design.workflows.restoring import read_designed
from ocs_design.workflows.size import design_ocs

pytestmark = pytest.mark.usefixtures("no_alternatives", "no_files")


S, C = np.sin(0.5), np.cos(0.5)
THIRD = np.sqrt(3.0)
DESIGNED = {"validation__enabled": False}
"""Not flown."""


@pytest.mark.parametrize(
    ("layout", "angle", "all_wheels", "one_lost"),
    [
        (Layout(LayoutName.SINGLE), 0.0, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)),
        (PAIR, 0.5, (2.0 * S, 2.0 * C, 0.0), (0.0, 0.0, 0.0)),
        # With one of four lost the two on the other axis hold as much as the one that is left.
        (Layout(LayoutName.DOUBLE_PAIR), 0.5, (4.0 * S, 4.0 * C, 0.0), (2.0 * S, 2.0 * C, 0.0)),
        (Layout(LayoutName.TRIPLE_PAIR), 0.5, (6.0 * S, 6.0 * C, 0.0), (4.0 * S, 4.0 * C, 0.0)),
        # Two wheels left at 60 degrees to each other hold sqrt(3) along their bisector and 1 across
        # it; beside the wheel on pitch the other one must hold twice what it gives to roll.
        (Layout(LayoutName.TRIAD), 0.0, (THIRD, 2.0, 0.0), (THIRD / 2.0, 1.0, 0.0)),
        (Layout(LayoutName.ORTHOGONAL), 0.0, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)),
        (Layout(LayoutName.PYRAMID), ISOTROPIC, (4.0 / THIRD,) * 3, (2.0 / THIRD,) * 3),
    ],
    ids=lambda value: value.name if isinstance(value, Layout) else "",
)
def test_what_layouts_reach(layout, angle, all_wheels, one_lost):
    axes = layout.axes(angle)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=0), 1.0, rtol=1e-15)
    np.testing.assert_allclose(reach(axes), all_wheels, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(reach_without_one(axes), one_lost, rtol=1e-12, atol=1e-12)


def test_every_layout_of_the_specification_is_one():
    assert {*LAYOUTS, "by-hand"} == set(LayoutName)
    assert specified_layout(Specification()) == PAIR
    with pytest.raises(UsageError, match="not the layout of a single device"):
        specified_layout(Specification(ocs=OcsSection(layout="all")))


@pytest.mark.parametrize(
    "option", [{"ocs.alpha": "30deg"}, {"ocs.position": "0,0.1,0.1"}, {"motor.name": "none"}]
)
def test_what_only_a_pair_has_is_refused_of_others(option):
    (said,) = contradictions(specification_from_options({"ocs.layout": "triad", **option}))
    assert "layout" in said
    assert not [*contradictions(specification_from_options({"ocs.layout": "pair", **option}))]


def test_every_layout_can_be_certified():
    asked = {"ocs.layout": "pyramid", "validation.certify": True}
    assert not [*contradictions(specification_from_options(asked))]


def test_axes_by_hand():
    """Directions of any length, for one to six wheels, each with its place if any has."""
    asked = {"ocs.axes": "0,2,0, 0,0,1, 3,0,4"}
    layout = specified_layout(specification_from_options(asked))
    np.testing.assert_allclose(layout.axes(0.0), [[0, 0, 0.6], [1, 0, 0], [0, 1, 0.8]])
    assert layout.names == ("1", "2", "3")
    assert not [*contradictions(specification_from_options(asked))]
    nine = {**asked, "ocs.position": "0,0.1,0.1, 0.1,0,0.1, -0.1,0,0.1"}
    assert not [*contradictions(specification_from_options(nine))]
    for wrong in ({"ocs.layout": "triad"}, {"ocs.position": "0,0,0.1"}, {"ocs.axes": "0,0,0"}):
        assert len([*contradictions(specification_from_options({**asked, **wrong}))]) == 1


@pytest.fixture
def no_advice(monkeypatch):
    """Refusals come without what would do, whose search takes longer than the sizing."""
    monkeypatch.setattr("ocs_design.workflows.rounds.advised", lambda refusal, *_: refusal)


@pytest.mark.slow
@pytest.mark.usefixtures("no_advice")
def test_four_wheels_where_no_motor_is_strong_enough_for_two(tmp_path):
    """One motor to choose from: four share what two cannot; a pair that is stated is refused."""
    asked = {**DESIGNED, "motor__name": "XING 2806.5 KV1800", "requirement__reliability": "0.5"}
    with pytest.raises(Infeasible, match="XING"):
        design_ocs(solo12_specification(**asked, ocs__layout="pair"), out=tmp_path / "a")
    told = []
    outcome = design_ocs(
        solo12_specification(**asked),
        out=tmp_path / "b",
        progress=lambda label, share: told.append(label),
    )
    device = outcome.device
    assert device.layout.name is LayoutName.DOUBLE_PAIR
    assert len(device.modules) == 4
    assert any("double-pair" in line for line in outcome.design.requirement.assumptions)
    assert any("4 wheels" in label for label in told)
    again = read_designed(outcome.folder)[0].ocs
    assert again.axes == device.layout
    assert [each.name for each in again.modules] == ["left_1", "right_1", "left_2", "right_2"]


ROLLING = """
[reality]
takeoff_rate = "normal(0, 1.3rad/s)"
[[maneuver]]
kind = "flip"
name = "flip"
gravity = 1.62
jump_height = 1.0
angle = "-360deg"
duration = 2.0
"""


@pytest.mark.slow
@pytest.mark.usefixtures("no_advice")
def test_fewer_robots_where_nothing_is_sure_for_99_of_100(tmp_path):
    """A pair that has no room for the roll of 99 % has it for 90 %, and only where none is stated.

    Of a normal rate 90 % stay below 1.645 deviations, 99 % below 2.576.
    """
    motor = "Antigravity MN5006 KV450"
    asked = solo12_specification(
        **DESIGNED, motor__name=motor, ocs__layout="pair", ocs__alpha="33deg"
    )
    specified = merge(asked, parse_specification(ROLLING, "test"))
    sure = merge(specified, specification_from_options({"requirement.reliability": "0.99"}))
    with pytest.raises(Infeasible, match="MN5006"):
        design_ocs(sure, out=tmp_path / "a")
    design = design_ocs(specified, out=tmp_path / "b").design
    assert design.requirement.reliability == 0.9
    assert any(each.startswith("Reliability: 90%") for each in design.requirement.assumptions)
    assert any("no device is feasible for 99%" in each for each in design.ocs.warnings)
    (kept,) = design.selection.kept.maneuvers
    assert 1.6 < kept.undone / 1.3 < 2.1


@pytest.mark.slow
def test_the_lightest_is_the_same_without_the_plates_of_the_others():
    task = solo12_task(motor__gear="direct")
    whole, alone = (design_device(task, ranked=ranked) for ranked in (True, False))
    assert alone.device.mass == whole.device.mass
    assert alone.device.motor == whole.device.motor
    assert len(alone.choice.selection.ranking) < len(whole.choice.selection.ranking)


@pytest.mark.slow
def test_layouts_of_one_robot_compared(monkeypatch):
    """A flip alone: a single wheel is the lightest, and it does not roll the robot.

    Of four layouts; below all of them are asked for, and none is sized.
    """
    some = ("single", "pair", "orthogonal", "pyramid")
    monkeypatch.setattr(layouts, "LAYOUTS", some)
    asked = {"requirement__flip": "back", "requirement__gravity": "1.62", "motor__gear": "direct"}
    answer = compare_layouts(solo12_specification(**asked))
    by_name = {each.layout: each for each in answer.layouts}
    assert tuple(by_name) == some
    assert by_name["single"].mass < by_name["pair"].mass < by_name["orthogonal"].mass
    assert by_name["single"].momentum[0] == 0.0
    assert min(by_name["pyramid"].momentum_without_one) > 0.0
    assert any("upright" in text or "horizontal" in text for text in by_name["pyramid"].open)


def test_the_robot_is_read_once_and_no_device_at_all_is_told_by_the_exit_code(monkeypatch):
    """Standard input can be read once only."""
    reads, read = [], layouts.read_specified_robot

    def none(*_, **__):
        raise Infeasible("no motor is strong enough", binding=(Constraint.TORQUE,))

    def counted(*asked, **options):
        reads.append(asked)
        return read(*asked, **options)

    monkeypatch.setattr(layouts, "read_specified_robot", counted)
    monkeypatch.setattr(layouts, "design_device", none)
    result = run("size", SOLO12, "--layout", "all", "--json")
    assert result.code == 4
    assert len(result.document["layouts"]) == len(LAYOUTS)
    assert len(reads) == 1


SURVIVES = {
    "motor__gear": "direct",
    "requirement__survives": "one",
    "requirement__fall": "1m",
    "requirement__tilt": "20deg",
    "validation__ballistic": True,
}


@pytest.mark.parametrize("layout", ["single", "pair", "orthogonal"])
def test_layouts_that_cannot_do_without_any_one_wheel_are_refused(layout):
    with pytest.raises(
        CannotSurvive, match=f"'{layout}' cannot tolerate the failure of a drive: without wheel"
    ):
        design_device(solo12_task(**SURVIVES, ocs__layout=layout))


@pytest.mark.parametrize(
    "option", [{"motor.name": "none"}, {"ocs.co_design": True}], ids=["motor", "co-design"]
)
def test_what_does_not_go_with_a_stopped_drive(option):
    asked = {"requirement.survives": "any one motor"}
    assert not [*contradictions(specification_from_options(asked))]
    (said,) = contradictions(specification_from_options({**asked, **option}))
    assert "survives" in said
    assert not [*contradictions(specification_from_options({"requirement.survives": "none"}))]


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["single", "double-pair"])
def test_wheels_share_the_supply_when_sized_as_when_planned(layout):
    """Four wheels that were promised the half of it each found no plan of the drop."""
    drop = {"requirement__fall": "1m", "requirement__tilt": "30deg", "supply__power_max": "600 W"}
    task = solo12_task(**drop, ocs__layout=layout)
    designed = design_device(task)
    promised = designed.choice.chosen.line.power_max
    assert drive_line_of(designed.device).power_max == pytest.approx(promised, rel=1e-9)
    standing = task.resolved.requirement.standing_height
    maneuvers = task.resolved.requirement.maneuvers
    for found in plan(task.robot.mass_properties, designed.device, maneuvers, standing).values():
        assert found.trajectory is not None, found.note


@pytest.mark.slow
@pytest.mark.parametrize(("layout", "direct"), [("pair", False), ("orthogonal", True)])
def test_wheels_that_reach_yaw_are_sized_for_it_without_a_loop(layout, direct):
    """The wheels are what the closed form asks for, and a plan for them leaves something."""
    turning = {"requirement__turn": "yaw 90deg in 2s", "requirement__gravity": "1.62"}
    task = solo12_task(**turning, ocs__layout=layout)
    problem = selection_problem(task)
    (turn,) = problem.requirement.maneuvers
    assert turn.headed == direct
    assert (turn.turn == 0.0).all() == direct
    if direct:
        designed = design_device(task)
        standing = task.resolved.requirement.standing_height
        found = plan(task.robot.mass_properties, designed.device, (turn,), standing)
        assert found[turn.name].share < 1.0
        (demand,) = designed.choice.chosen.demands
        assert demand.spin_inertia == pytest.approx(designed.device.flywheel.spin_inertia, rel=2e-2)


@pytest.mark.slow
def test_what_needs_less_than_the_smallest_rim_gets_a_larger_one():
    """No bound on the wheels of a turn about z alone is above zero, and no rim is that small."""
    asked = specification_from_options(
        {
            "robot.mass": "50kg",
            "robot.inertia": "2.129,3.311,2.602",
            "ocs.layout": "orthogonal",
            "requirement.turn": "yaw 45deg in 10s",
            "requirement.gravity": "orbit",
            "supply.voltage": "28V",
        }
    )
    task = read_task(asked)
    chosen = design_device(task).choice.chosen
    (demand,) = chosen.demands
    assert demand.spin_inertia <= chosen.spin_inertia
    problem = selection_problem(task)
    least = RimFloor.of(problem).mass
    assert np.isfinite(least[:, 0]).all()
    assert (np.diff(np.nan_to_num(least, posinf=1e9), axis=1) >= 0.0).all()


@pytest.mark.slow
def test_a_triad_for_solo12_can_be_built(tmp_path):
    """On one plate, whose mass is a part of the device's; read again it is the same."""
    asked = solo12_specification(**DESIGNED, ocs__layout="triad", motor__gear="direct")
    design = design_ocs(asked, out=tmp_path / "a").design
    assert design.buildable.yes is True
    assert design.buildable.open == ()
    ocs, plate = design.ocs, design.ocs.plate
    assert plate.arms == len(ocs.modules)
    modules = len(ocs.modules) * (ocs.flywheel.mass + ocs.carrier.mass)
    assert ocs.mass_total == pytest.approx(modules + plate.mass)
    assert read_designed(tmp_path / "a")[1].plate == plate


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["triad", pytest.param("pyramid", marks=pytest.mark.exhaustive)])
def test_what_survives_lands_whichever_drive_stops(layout, tmp_path):
    """Every drive at every instant; what costs mass is told, and the table has each flight."""
    outcome = design_ocs(solo12_specification(**SURVIVES, ocs__layout=layout), out=tmp_path / "a")
    survival = outcome.design.survival
    assert not survival.lost
    assert outcome.device.mass > survival.mass_without
    assert read_designed(outcome.folder)[0].survival == survival
    rows = (outcome.folder / "validation" / "stopped.csv").read_text().splitlines()
    assert len(rows) == 1 + len(survival.flights) == 1 + 8 * len(outcome.device.modules)
    assert read_design(outcome.folder).requirement.detection == 0.02


@pytest.mark.slow
def test_a_refusal_names_what_would_survive_with_its_mass(tmp_path, monkeypatch):
    monkeypatch.setattr("ocs_design.sizing.design.SURVIVORS", ("triad",))
    with pytest.raises(CannotSurvive) as refused:
        design_ocs(solo12_specification(**SURVIVES), out=tmp_path / "a")
    assert re.search(r"`--layout triad` \d+ g", refused.value.hint)
    assert not (tmp_path / "a").exists()
