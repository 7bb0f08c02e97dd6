"""Layouts side by side: what they reach, with all wheels and with one lost, and what is refused."""

import numpy as np
import pytest
from robots import SOLO12

from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.device.layout import ISOTROPIC, PAIR, Layout, LayoutName
from ocs_design.device.records import read_design
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.specification import (
    LAYOUTS,
    OcsSection,
    Specification,
    specification_from_options,
)
from ocs_design.sizing.selection.problem import specified_layout
from ocs_design.workflows.layouts import compare_layouts, reach, reach_without_one
from ocs_design.workflows.size import design_ocs

S, C = np.sin(0.5), np.cos(0.5)
THIRD = np.sqrt(3.0)


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
    with pytest.raises(UsageError, match="no layout of one device"):
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


@pytest.mark.slow
def test_four_wheels_where_no_motor_is_strong_enough_for_two(tmp_path):
    """One motor to choose from: four share what two cannot; a pair that is stated is refused."""
    asked = {
        "robot.file": str(SOLO12),
        "motor.name": "XING 2806.5 KV1800",
        "requirement.reliability": "0.5",
        "validation.enabled": False,
    }
    with pytest.raises(Infeasible, match="XING"):
        design_ocs(specification_from_options({**asked, "ocs.layout": "pair"}), out=tmp_path / "a")
    told = []
    outcome = design_ocs(
        specification_from_options(asked),
        out=tmp_path / "b",
        progress=lambda label, share: told.append(label),
    )
    device = outcome.device
    assert device.layout.name is LayoutName.DOUBLE_PAIR
    assert len(device.modules) == 4
    assert any("double-pair" in line for line in outcome.design.requirement.assumptions)
    assert any("4 wheels" in label for label in told)
    again = read_design(outcome.folder).ocs
    assert again.axes == device.layout
    assert [each.name for each in again.modules] == ["left_1", "right_1", "left_2", "right_2"]


@pytest.mark.slow
def test_all_layouts_of_one_robot():
    """A flip alone: a single wheel is the lightest, and it does not roll the robot."""
    asked = specification_from_options(
        {"robot.file": str(SOLO12), "requirement.flip": "back", "requirement.gravity": "1.62"}
    )
    answer = compare_layouts(specification_of(asked))
    by_name = {each.layout: each for each in answer.layouts}
    assert tuple(by_name) == LAYOUTS
    assert by_name["single"].mass < by_name["pair"].mass < by_name["orthogonal"].mass
    assert by_name["single"].momentum[0] == 0.0
    assert min(by_name["pyramid"].momentum_without_one) > 0.0
    assert any("upright" in text or "horizontal" in text for text in by_name["pyramid"].open)
