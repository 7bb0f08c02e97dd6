"""Reference trajectories: the margins that they leave to feedback, and how they fail."""

import re

import numpy as np
import pytest
from driven_wheels import EC45_LINE
from gyrostats import BACK_FLIP, DIAGONAL, FULL, PUSH, body, drop

from ocs_design.actuation.drive import DriveLine
from ocs_design.device.layout import ISOTROPIC, Layout, LayoutName
from ocs_design.requirement.turns import TurnTo
from ocs_design.sizing.trajectory.flight import limit_violation
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import (
    EXTRA_DEMAND,
    GENTLE_SHARES,
    PLANNED,
    TALL_SHARE_MAX,
    reference,
)

FORTY = np.radians(40.0)


@pytest.mark.parametrize("kept", [1.0, 1.05])
def test_a_reference_leaves_margins_for_feedback_and_reserve(kept):
    planned = reference(body(FORTY, 1.4e-4), EC45_LINE, drop(30.0), kept)
    path, line = planned.trajectory, EC45_LINE.reserved(PLANNED / kept)
    assert planned.note == path.note == ""
    assert limit_violation(path.wheel_speed, path.wheel_torque, line) < 1e-6
    assert (np.diff(path.time) > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(path.vertical, axis=1), 1.0, rtol=1e-9)


def test_a_reference_that_needs_the_whole_drive_says_so():
    """A wheel between the smallest one for the full drive and that with its margin."""
    planned = reference(body(FORTY, 9.2e-5), EC45_LINE, drop(30.0))
    assert f"{PLANNED:.1%}" in planned.note
    path = planned.trajectory
    assert path.note == planned.note
    used = limit_violation(path.wheel_speed, path.wheel_torque, EC45_LINE.reserved(PLANNED))
    assert used == pytest.approx(1.0 / PLANNED - 1.0, abs=0.01)
    assert limit_violation(path.wheel_speed, path.wheel_torque, EC45_LINE) < 1e-6


def test_infeasible_turns_have_no_reference():
    planned = reference(body(FORTY, 6e-5), EC45_LINE, drop(30.0))
    assert planned.trajectory is None
    assert "no optimal turn was found (no solution within the limits in" in planned.note


def test_a_push_has_no_reference():
    planned = reference(body(FORTY), EC45_LINE, PUSH)
    assert planned.trajectory is None
    assert "feedback" in planned.note


@pytest.mark.slow
def test_a_turn_that_is_too_fast_is_refused_with_a_feasible_time():
    """The theory's table has 2 s for these wheels, within 5 % of the named time."""
    yaw = TurnTo(name="yaw", jump_height=1.0, yaw=np.pi / 2.0, duration=1.7)
    gyrostat = body(np.radians(39.0), 1.05e-4, DIAGONAL)
    planned = reference(gyrostat, EC45_LINE, yaw)
    assert planned.trajectory is None
    match = re.fullmatch(r".* this turn in 1.7 s: they need (.*) s", planned.note)
    assert match
    assert 1.0 / 1.05 < 2.0 / float(match[1]) < 1.05


@pytest.mark.slow
@pytest.mark.parametrize("layout", [LayoutName.TRIAD, LayoutName.PYRAMID])
def test_a_plan_survives_the_failure_of_any_drive_at_its_start(layout):
    """The other wheels can apply its torque and store its momentum within their limits.

    With half of the spin inertia they cannot, and the plan says so.
    """
    axes = Layout(layout).axes(ISOTROPIC)
    for inertia, survives in ((4e-4, True), (2e-4, False)):
        gyrostat = Gyrostat(FULL, axes, inertia)
        planned = reference(gyrostat, EC45_LINE, BACK_FLIP, one_stops=True)
        worst = 0.0
        for lost in range(axes.shape[1]):
            left = np.delete(axes, lost, axis=1)
            speed, torque = (
                np.linalg.lstsq(left, axes @ each.T, rcond=None)[0].T
                for each in (planned.trajectory.wheel_speed, planned.trajectory.wheel_torque)
            )
            worst = max(worst, limit_violation(speed, torque, EC45_LINE.reserved(PLANNED)))
        assert (worst < 1e-6) == survives
        assert (planned.note == "") == survives
        assert (planned.share <= PLANNED) == survives


@pytest.mark.slow
def test_the_supply_is_sufficient_whenever_a_drive_fails():
    """The satellite of docs/machines.md: 45 deg of pitch in 10 s with 62 W left by friction.

    The other wheels take over torque and momentum, and compensate the momentum of the failed wheel,
    which keeps running. In a plan of least power the four wheels work against each other, which
    three cannot do.
    """
    axes = Layout(LayoutName.PYRAMID).axes(ISOTROPIC)
    gyrostat = Gyrostat(np.diag([2.129, 3.311, 2.602]), axes, 6e-4)
    line = DriveLine(5.755, 1171.4, 0.709, 1407.4, 15.55)
    pitch = TurnTo(name="turn", pitch=np.pi / 4.0, duration=10.0, gravity=0.0, jump_height=9.0)
    shares = {}
    for one_stops in (True, False):
        path = reference(gyrostat, line, pitch, one_stops=one_stops).trajectory
        assert path.note == ""
        largest = 0.0
        for lost in range(4):
            left = np.delete(axes, lost, axis=1)
            torque = np.linalg.solve(left, axes @ path.wheel_torque.T).T
            for failure in range(0, len(path.time) - 1, len(path.time) // 8):
                running_on = np.outer(
                    axes[:, lost], np.full(len(path.time), path.wheel_speed[failure, lost])
                )
                speed = np.linalg.solve(left, axes @ path.wheel_speed.T - running_on).T
                heat = line.no_load_speed / line.stall_torque * torque
                power = np.sum(torque * (speed + heat), axis=1)[failure:]
                largest = max(largest, float(np.abs(power).max()))
        shares[one_stops] = largest / (4.0 * line.power_max)
    assert shares[True] < 0.95
    assert shares[False] > 2.0


@pytest.mark.slow
def test_the_heading_loop_of_a_tall_body_leaves_larger_margins():
    """Unitree's G1 has 3.5 times as much inertia about roll and pitch as about yaw."""
    yaw = TurnTo(name="yaw", jump_height=1.0, yaw=np.pi / 2.0, duration=4.0, gravity=1.62)
    axes = Layout(LayoutName.PAIR).axes(np.radians(45.0))
    line = DriveLine(25.0, 600.0, 7.4, np.inf, np.inf)
    planned = {}
    for shape in ((3.2, 3.2, 0.9), (0.9, 0.9, 3.2)):
        for inertia in (2e-2, 8e-3):
            gyrostat = Gyrostat(np.diag(shape), axes, inertia)
            planned[shape[0], inertia] = reference(gyrostat, line, yaw)
    assert planned[3.2, 2e-2].share == TALL_SHARE_MAX
    assert planned[0.9, 2e-2].share == GENTLE_SHARES[0]
    assert planned[3.2, 2e-2].missing_demand(yaw.end) is None
    scarce = planned[3.2, 8e-3]
    assert scarce.trajectory is not None
    assert (
        scarce.missing_demand(yaw.end)
        == max(EXTRA_DEMAND, scarce.share / TALL_SHARE_MAX)
        > EXTRA_DEMAND
    )
    assert planned[0.9, 8e-3].missing_demand(yaw.end) is None
