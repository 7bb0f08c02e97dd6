"""Demand of kicks that also turn the heading."""

from dataclasses import replace

import numpy as np
import pytest

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import gauge, without_each
from ocs_design.device.layout import PAIR, Layout, LayoutName
from ocs_design.requirement.pushes import Disturbance, Shove
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.selection.demand import seen_at, wheel_task

KICK = Disturbance(
    name="kick", takeoff_velocity=(0.0, 2.5), torque=(2.0, 0.4, -3.0), onset=0.1, duration=0.05
)
INERTIA, YAW_INERTIA = TiltInertia.uncoupled([[[0.03, 0.05]]]), np.array([[0.06]])
ORTHOGONAL, TRIAD = Layout(LayoutName.ORTHOGONAL), Layout(LayoutName.TRIAD)


def load_of(kick, layout, *, detection=None):
    """Load on the busiest wheel."""
    requirement = Requirement((kick,), None, 1.0, None, detection=detection)
    axes = layout.axes(np.array([[0.9]]))
    return wheel_task([kick], requirement, INERTIA, YAW_INERTIA, axes).load()


@pytest.mark.parametrize(("layout", "stops"), [(PAIR, False), (TRIAD, False), (TRIAD, True)])
def test_a_yawing_trunk_asks_most_at_one_of_the_headings_that_it_passes(layout, stops):
    load = load_of(KICK, layout, detection=0.0 if stops else None)
    turned = -0.15 / 0.06 * KICK.time_left
    headings = np.linspace(0.0, turned, 1000)
    momentum = seen_at(headings, np.array(KICK.torque[:2]) * KICK.duration)
    axes = layout.axes(0.9)[:2]
    expected = max(
        gauge(wheels, momentum).busiest.max()
        for wheels in (without_each(axes) if stops else (axes,))
    )
    assert abs(turned) > 0.7
    assert 0.98 * expected < load.momentum.item() <= expected * (1.0 + 1e-9)
    assert load.excess == pytest.approx(load.momentum * KICK.duration / 2.0)


def test_without_yaw_and_on_feet_the_heading_does_not_count():
    level = replace(KICK, torque=(2.0, 0.4, 0.0))
    shove = Shove(name="shove", torque=KICK.torque, duration=0.05, settling=0.4)
    expected = gauge(PAIR.axes(0.9)[:2], np.array([0.1, 0.02])).busiest
    for kick in (level, shove):
        assert load_of(kick, PAIR).momentum.item() == pytest.approx(expected, rel=1e-12)
    assert not shove.with_wheels(direct=True).has_heading_demand


def test_wheels_that_act_about_the_vertical_also_stop_the_yaw():
    direct = KICK.with_wheels(direct=True)
    assert direct.has_heading_demand
    assert load_of(direct, ORTHOGONAL).momentum.item() == pytest.approx(0.15, rel=1e-12)
    swept, held = direct.heading(np.full((2, 1), 0.06))
    np.testing.assert_allclose(held, -0.15)
    np.testing.assert_allclose(swept, -0.15 * 0.05 / 2.0)


def test_momentum_stands_still_in_space_while_the_trunk_yaws():
    """A trunk that turned to the left by a quarter sees what was ahead on its right."""
    np.testing.assert_allclose(seen_at(np.array(np.pi / 2.0), np.array([1.0, 0.0])), [0.0, -1.0],
                               atol=1e-15)  # fmt: skip
    np.testing.assert_allclose(
        seen_at(np.array([0.0, np.pi]), np.array([1.0, 2.0, 3.0])), [[1, 2, 3], [-1, -2, 3]],
        atol=1e-15,
    )  # fmt: skip
