"""Layouts: momentum with all wheels and with one lost, sizing, survival and refusals."""

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
from ocs_design.workflows.restoring import read_design_and_device
from ocs_design.workflows.size import design_ocs

pytestmark = pytest.mark.usefixtures("no_alternatives", "no_files")


S, C = np.sin(0.5), np.cos(0.5)
THIRD = np.sqrt(3.0)
WITHOUT_FLIGHTS = {"validation__enabled": False}
"""Options of a design that is not validated."""


@pytest.mark.parametrize(
    ("layout", "angle", "all_wheels", "one_lost"),
    [
        (Layout(LayoutName.SINGLE), 0.0, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)),
        (PAIR, 0.5, (2.0 * S, 2.0 * C, 0.0), (0.0, 0.0, 0.0)),
        # With one of four lost, the two on the other axis match the remaining one.
        (Layout(LayoutName.DOUBLE_PAIR), 0.5, (4.0 * S, 4.0 * C, 0.0), (2.0 * S, 2.0 * C, 0.0)),
        (Layout(LayoutName.TRIPLE_PAIR), 0.5, (6.0 * S, 6.0 * C, 0.0), (4.0 * S, 4.0 * C, 0.0)),
        # Two wheels at 60 degrees to each other have sqrt(3) along their bisector and 1 across it;
        # with the wheel on pitch left, the other one needs twice the momentum about roll.
        (Layout(LayoutName.TRIAD), 0.0, (THIRD, 2.0, 0.0), (THIRD / 2.0, 1.0, 0.0)),
        (Layout(LayoutName.ORTHOGONAL), 0.0, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)),
        (Layout(LayoutName.PYRAMID), ISOTROPIC, (4.0 / THIRD,) * 3, (2.0 / THIRD,) * 3),
    ],
    ids=lambda value: value.name if isinstance(value, Layout) else "",
)
def test_momentum_of_layouts(layout, angle, all_wheels, one_lost):
    axes = layout.axes(angle)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=0), 1.0, rtol=1e-15)
    np.testing.assert_allclose(reach(axes), all_wheels, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(reach_without_one(axes), one_lost, rtol=1e-12, atol=1e-12)


def test_layouts_of_the_specification_are_those_of_devices():
    assert {*LAYOUTS, "by-hand"} == set(LayoutName)
    assert specified_layout(Specification()) == PAIR
    with pytest.raises(UsageError, match="not the layout of a single device"):
        specified_layout(Specification(ocs=OcsSection(layout="all")))


@pytest.mark.parametrize(
    "option", [{"ocs.alpha": "30deg"}, {"ocs.position": "0,0.1,0.1"}, {"motor.name": "none"}]
)
def test_options_of_a_pair_are_refused_for_other_layouts(option):
    (message,) = contradictions(specification_from_options({"ocs.layout": "triad", **option}))
    assert "layout" in message
    assert not [*contradictions(specification_from_options({"ocs.layout": "pair", **option}))]


def test_every_layout_can_be_certified():
    options = {"ocs.layout": "pyramid", "validation.certify": True}
    assert not [*contradictions(specification_from_options(options))]


def test_axes_by_hand():
    """Directions of any length, with a place for each wheel or for none."""
    options = {"ocs.axes": "0,2,0, 0,0,1, 3,0,4"}
    layout = specified_layout(specification_from_options(options))
    np.testing.assert_allclose(layout.axes(0.0), [[0, 0, 0.6], [1, 0, 0], [0, 1, 0.8]])
    assert layout.names == ("1", "2", "3")
    assert not [*contradictions(specification_from_options(options))]
    with_places = {**options, "ocs.position": "0,0.1,0.1, 0.1,0,0.1, -0.1,0,0.1"}
    assert not [*contradictions(specification_from_options(with_places))]
    for wrong in ({"ocs.layout": "triad"}, {"ocs.position": "0,0,0.1"}, {"ocs.axes": "0,0,0"}):
        assert len([*contradictions(specification_from_options({**options, **wrong}))]) == 1


@pytest.fixture
def no_advice(monkeypatch):
    """Refusals come without advice, since the search for it takes longer than the sizing."""
    monkeypatch.setattr("ocs_design.workflows.rounds.advised", lambda refusal, *_: refusal)


@pytest.mark.slow
@pytest.mark.usefixtures("no_advice")
def test_four_wheels_where_two_are_too_weak(tmp_path):
    """With a single motor to choose from; a specified pair is refused."""
    options = {
        **WITHOUT_FLIGHTS,
        "motor__name": "XING 2806.5 KV1800",
        "requirement__reliability": "0.5",
    }
    with pytest.raises(Infeasible, match="XING"):
        design_ocs(solo12_specification(**options, ocs__layout="pair"), out=tmp_path / "a")
    labels = []
    outcome = design_ocs(
        solo12_specification(**options),
        out=tmp_path / "b",
        progress=lambda label, share: labels.append(label),
    )
    device = outcome.device
    assert device.layout.name is LayoutName.DOUBLE_PAIR
    assert len(device.modules) == 4
    assert any("double-pair" in line for line in outcome.design.requirement.assumptions)
    assert any("4 wheels" in label for label in labels)
    recorded = read_design_and_device(outcome.folder)[0].ocs
    assert recorded.axes == device.layout
    assert [module.name for module in recorded.modules] == [
        "left_1",
        "right_1",
        "left_2",
        "right_2",
    ]


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


@pytest.mark.exhaustive
@pytest.mark.usefixtures("no_advice")
def test_the_default_reliability_falls_to_90_percent_where_99_is_infeasible(tmp_path):
    """A pair that is infeasible for the roll of 99 % is sized for 90 %, unless 99 % is specified.

    Of normal rates 90 % stay below 1.645 standard deviations, 99 % below 2.576.
    """
    motor = "Antigravity MN5006 KV450"
    options = solo12_specification(
        **WITHOUT_FLIGHTS, motor__name=motor, ocs__layout="pair", ocs__alpha="33deg"
    )
    specified = merge(options, parse_specification(ROLLING, "test"))
    certain = merge(specified, specification_from_options({"requirement.reliability": "0.99"}))
    with pytest.raises(Infeasible, match="MN5006"):
        design_ocs(certain, out=tmp_path / "a")
    design = design_ocs(specified, out=tmp_path / "b").design
    assert design.requirement.reliability == 0.9
    assert any(text.startswith("Reliability: 90%") for text in design.requirement.assumptions)
    assert any("no device is feasible for 99%" in text for text in design.ocs.warnings)
    (maneuver,) = design.selection.kept.maneuvers
    assert 1.6 < maneuver.undone / 1.3 < 2.1


@pytest.mark.slow
def test_the_lightest_is_the_same_without_the_plates_of_the_others():
    task = solo12_task(motor__gear="direct")
    ranked_design, single_design = (design_device(task, ranked=ranked) for ranked in (True, False))
    assert single_design.device.mass == ranked_design.device.mass
    assert single_design.device.motor == ranked_design.device.motor
    assert len(single_design.choice.selection.ranking) < len(ranked_design.choice.selection.ranking)


@pytest.mark.exhaustive
def test_layouts_of_one_robot_compared(monkeypatch):
    """For a flip a single wheel is the lightest, and it cannot roll the robot.

    Four layouts are sized here; the next test has all of them without sizing.
    """
    compared = ("single", "pair", "orthogonal", "pyramid")
    monkeypatch.setattr(layouts, "LAYOUTS", compared)
    options = {"requirement__flip": "back", "requirement__gravity": "1.62", "motor__gear": "direct"}
    answer = compare_layouts(solo12_specification(**options))
    by_name = {row.layout: row for row in answer.layouts}
    assert tuple(by_name) == compared
    assert by_name["single"].mass < by_name["pair"].mass < by_name["orthogonal"].mass
    assert by_name["single"].momentum[0] == 0.0
    assert min(by_name["pyramid"].momentum_without_one) > 0.0
    assert any("upright" in text or "horizontal" in text for text in by_name["pyramid"].open)


def test_the_robot_is_read_once_and_the_exit_code_is_4_without_any_device(monkeypatch):
    """Standard input can be read only once."""
    reads, read = [], layouts.read_specified_robot

    def infeasible(*_, **__):
        raise Infeasible("no motor is strong enough", binding=(Constraint.TORQUE,))

    def counted(*arguments, **options):
        reads.append(arguments)
        return read(*arguments, **options)

    monkeypatch.setattr(layouts, "read_specified_robot", counted)
    monkeypatch.setattr(layouts, "design_device", infeasible)
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
def test_layouts_that_cannot_lose_any_wheel_are_refused(layout):
    with pytest.raises(
        CannotSurvive, match=f"'{layout}' cannot tolerate the failure of a drive: without wheel"
    ):
        design_device(solo12_task(**SURVIVES, ocs__layout=layout))


@pytest.mark.parametrize(
    "option", [{"motor.name": "none"}, {"ocs.co_design": True}], ids=["motor", "co-design"]
)
def test_options_that_exclude_survival(option):
    options = {"requirement.survives": "any one motor"}
    assert not [*contradictions(specification_from_options(options))]
    (message,) = contradictions(specification_from_options({**options, **option}))
    assert "survives" in message
    assert not [*contradictions(specification_from_options({"requirement.survives": "none"}))]


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["single", "double-pair"])
def test_wheels_share_the_supply_in_sizing_and_planning(layout):
    """Once four wheels were sized with half of it each, and the drop had no plan."""
    drop = {"requirement__fall": "1m", "requirement__tilt": "30deg", "supply__power_max": "600 W"}
    task = solo12_task(**drop, ocs__layout=layout)
    designed = design_device(task)
    power = designed.choice.chosen.line.power_max
    assert drive_line_of(designed.device).power_max == pytest.approx(power, rel=1e-9)
    maneuvers = task.resolved.requirement.maneuvers
    for reference in plan(task.robot.mass_properties, designed.device, maneuvers).values():
        assert reference.trajectory is not None, reference.note


@pytest.mark.slow
@pytest.mark.parametrize(("layout", "direct"), [("pair", False), ("orthogonal", True)])
def test_wheels_with_authority_about_yaw_are_sized_for_a_direct_turn(layout, direct):
    """The wheels are those of the closed form, and the plan stays within their limits."""
    turning = {"requirement__turn": "yaw 90deg in 2s", "requirement__gravity": "1.62"}
    task = solo12_task(**turning, ocs__layout=layout)
    problem = selection_problem(task)
    (turn,) = problem.requirement.maneuvers
    assert turn.has_heading_demand == direct
    assert (turn.turn == 0.0).all() == direct
    if direct:
        designed = design_device(task)
        plans = plan(task.robot.mass_properties, designed.device, (turn,))
        assert plans[turn.name].share < 1.0
        (demand,) = designed.choice.chosen.demands
        assert demand.spin_inertia == pytest.approx(designed.device.flywheel.spin_inertia, rel=2e-2)


@pytest.mark.slow
def test_a_tiny_demand_is_met_by_the_smallest_rim():
    """The lower bound for a turn about z alone is zero, and no rim is that small."""
    specification = specification_from_options(
        {
            "robot.mass": "50kg",
            "robot.inertia": "2.129,3.311,2.602",
            "ocs.layout": "orthogonal",
            "requirement.turn": "yaw 45deg in 10s",
            "requirement.gravity": "orbit",
            "supply.voltage": "28V",
        }
    )
    task = read_task(specification)
    chosen = design_device(task).choice.chosen
    (demand,) = chosen.demands
    assert demand.spin_inertia <= chosen.spin_inertia
    problem = selection_problem(task)
    least = RimFloor.of(problem).mass
    assert np.isfinite(least[:, 0]).all()
    assert (np.diff(np.nan_to_num(least, posinf=1e9), axis=1) >= 0.0).all()


@pytest.mark.slow
def test_a_triad_for_solo12_can_be_built(tmp_path):
    """It is on one plate, which is in the mass of the device and is read back."""
    specification = solo12_specification(
        **WITHOUT_FLIGHTS, ocs__layout="triad", motor__gear="direct"
    )
    design = design_ocs(specification, out=tmp_path / "a").design
    assert design.buildable.yes is True
    assert design.buildable.open == ()
    ocs, plate = design.ocs, design.ocs.plate
    assert plate.arms == len(ocs.modules)
    modules = len(ocs.modules) * (ocs.flywheel.mass + ocs.carrier.mass)
    assert ocs.mass_total == pytest.approx(modules + plate.mass)
    assert read_design_and_device(tmp_path / "a")[1].plate == plate


@pytest.mark.exhaustive
@pytest.mark.parametrize("layout", ["triad", "pyramid"])
def test_a_surviving_device_lands_whichever_drive_stops(layout, tmp_path):
    """Every drive stops at every instant; the additional mass and all flights are recorded."""
    outcome = design_ocs(solo12_specification(**SURVIVES, ocs__layout=layout), out=tmp_path / "a")
    survival = outcome.design.survival
    assert not survival.lost
    assert outcome.device.mass > survival.mass_without
    assert read_design_and_device(outcome.folder)[0].survival == survival
    rows = (outcome.folder / "validation" / "stopped.csv").read_text().splitlines()
    assert len(rows) == 1 + len(survival.flights) == 1 + 8 * len(outcome.device.modules)
    assert read_design(outcome.folder).requirement.detection == 0.02


@pytest.mark.slow
def test_a_refusal_names_a_surviving_layout_with_its_mass(tmp_path, monkeypatch):
    monkeypatch.setattr("ocs_design.sizing.design.REDUNDANT_LAYOUTS", ("triad",))
    with pytest.raises(CannotSurvive) as refused:
        design_ocs(solo12_specification(**SURVIVES), out=tmp_path / "a")
    assert re.search(r"`--layout triad` \d+ g", refused.value.hint)
    assert not (tmp_path / "a").exists()
