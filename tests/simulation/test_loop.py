"""Stability margins of the wheels' loop against python-control and the poles of delayed loops."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
from trajectories import from_rest
from wheels import driven_device

from ocs_design.requirement.froude import default_maneuvers
from ocs_design.simulation.loop import level_margins, loop_margins, plan_margins
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.trajectory.plans import drive_line_of
from ocs_design.sizing.trajectory.tracking import tracking_gains

STATE, CONTROL = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]])
GAINS = [(60.0, 12.0), (400.0, 4.0), (2.0, 30.0)]


@pytest.fixture(scope="module")
def control():
    """python-control, imported only here because it loads matplotlib."""
    return importlib.import_module("control")


@pytest.fixture(scope="module")
def world(solo12):
    return WorldBuilder(solo12, driven_device()).flight(default_maneuvers(solo12)[0], Wheels.ACTIVE)


# The polynomials of python-control lose digits at 1 kHz; it warns and uses frequencies instead.
@pytest.mark.filterwarnings("ignore:stability_margins", "ignore:invalid value:RuntimeWarning")
@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("gains", GAINS)
def test_a_single_axis_has_the_margins_of_python_control(control, gains, rate):
    period, feedback = 1.0 / rate, np.array([gains])
    plant = control.c2d(control.ss(STATE, CONTROL, feedback, 0.0), period, method="zoh")
    _, phase, _, crossover = control.margin(plant)
    margins = loop_margins(STATE, CONTROL, feedback, period)
    assert margins.crossover == pytest.approx(crossover, rel=1e-4)
    assert np.degrees(margins.phase) == pytest.approx(phase, abs=0.01)
    assert margins.delay == pytest.approx(np.radians(phase) / crossover, rel=1e-3)


@pytest.mark.parametrize("rate", [200.0, 1000.0])
def test_the_law_on_a_robot_has_the_margins_of_one_axis(world, rate):
    """The law inverts the dynamics: roll and pitch are two double integrators."""
    gains = np.column_stack([world.law.stiffness, world.law.damping])
    single_axis = loop_margins(STATE, CONTROL, gains, 1.0 / rate)
    robot_axes = level_margins(world.law, world.body, 1.0 / rate)
    assert robot_axes.crossover == pytest.approx(single_axis.crossover, rel=1e-4)
    assert robot_axes.phase == pytest.approx(single_axis.phase, rel=1e-3)
    assert robot_axes.delay == pytest.approx(single_axis.delay, rel=1e-3)


@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("gains", GAINS)
def test_the_closed_loop_is_stable_up_to_the_delay_margin(control, gains, rate):
    """Poles of the closed loop with whole steps of delay below and above the margin."""
    period, feedback = 1.0 / rate, np.array([gains])
    delay = loop_margins(STATE, CONTROL, feedback, period).delay
    margin = int(delay / period)
    plant = control.c2d(control.ss(STATE, CONTROL, feedback, 0.0), period, method="zoh")
    for steps, stable in ((max(margin - 1, 0), True), (margin + 2, False)):
        delayed = control.ss(control.tf([1.0], [1.0, *[0.0] * steps], period))
        poles = control.feedback(plant * delayed, 1.0).poles()
        assert bool(np.abs(poles).max() < 1.0) is stable


def test_a_regulated_plan_has_the_phase_margin_of_an_lqr(world):
    """At least 60 deg at the end (Anderson and Moore, Optimal Control, section 5.4)."""
    turn = replace(world.turn, axis=np.array([0.0, 1.0, 0.0]), end=1.0, at_once=False)
    plan = from_rest(world.body, turn, samples=401)
    gains = tracking_gains(world.body, drive_line_of(driven_device()), plan)
    settled = replace(plan, gains=np.broadcast_to(gains[0], gains.shape))
    assert np.degrees(plan_margins(settled, world.body, 1e-4).phase) > 60.0


def test_phase_and_delay_margin_belong_to_the_same_crossover():
    """Of two independent axes the slow one has less phase, the fast one a smaller delay margin."""
    none = np.zeros_like(STATE)
    state, control = np.block([[STATE, none], [none, STATE]]), np.kron(np.eye(2), CONTROL)
    gains = [(2.0, 0.1), (400.0, 40.0)]
    slow, fast = (loop_margins(STATE, CONTROL, np.array([axis]), 0.001) for axis in gains)
    assert slow.phase < fast.phase
    assert slow.delay > fast.delay
    feedback = np.zeros((2, 4))
    feedback[0, :2], feedback[1, 2:] = gains
    both = loop_margins(state, control, feedback, 0.001)
    assert both.crossover == pytest.approx(fast.crossover, rel=1e-3)
    assert both.phase == pytest.approx(fast.phase, rel=1e-3)
    assert both.delay == pytest.approx(fast.delay, rel=1e-3)


def test_a_loop_that_is_unstable_without_delay_has_no_margin(world):
    """`x'' = u` with steps T is stable for `K_d T < 2`: with these gains for T of 0.15 s."""
    assert loop_margins(STATE, CONTROL, np.array([[60.0, 12.0]]), 0.15).delay > 0.0
    for margins in (
        loop_margins(STATE, CONTROL, np.array([[60.0, 12.0]]), 0.2),
        level_margins(world.law, world.body, 0.2),
    ):
        assert (margins.phase, margins.delay) == (0.0, 0.0)
    # An inverted pendulum with a pole at 5 rad/s.
    unstable = np.array([[0.0, 1.0], [25.0, 0.0]])
    feedback = np.array([[200.0, 25.0]])
    assert loop_margins(unstable, CONTROL, feedback, 0.005).delay > 0.01
    assert loop_margins(unstable, CONTROL, feedback, 0.1).delay == 0.0


def test_a_loop_without_crossover_has_an_infinite_delay_margin():
    assert loop_margins(-np.eye(1), np.eye(1), 0.1 * np.eye(1), 0.005).delay == np.inf
