import re

import numpy as np
import pytest
from gyrostats import BACK_FLIP, DIAGONAL, EC_45_FLAT, FULL, PUSH, STANDING, body, drop

from ocs_design.actuation.drive import DriveLine
from ocs_design.device.layout import ISOTROPIC, Layout, LayoutName
from ocs_design.requirement.turns import TurnTo
from ocs_design.sizing.trajectory.flight import limit_violation
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import GENTLE, PLANNED, SPARE, TALL_SPARE, reference

FORTY = np.radians(40.0)


@pytest.mark.parametrize("kept", [1.0, 1.05])
def test_it_leaves_the_feedback_its_reserve_and_what_the_device_keeps(kept):
    found = reference(body(FORTY, 1.4e-4), EC_45_FLAT, drop(30.0), STANDING, kept)
    path, line = found.trajectory, EC_45_FLAT.reserved(PLANNED / kept)
    assert found.note == path.note == ""
    assert limit_violation(path.wheel_speed, path.wheel_torque, line) < 1e-6
    assert (np.diff(path.time) > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(path.vertical, axis=1), 1.0, rtol=1e-9)


def test_where_the_reserve_is_too_little_it_takes_all_and_says_so():
    """Between the smallest wheel with all of the drive and the one with what is reserved."""
    found = reference(body(FORTY, 9.2e-5), EC_45_FLAT, drop(30.0), STANDING)
    assert f"{PLANNED:.1%}" in found.note
    path = found.trajectory
    assert path.note == found.note
    used = limit_violation(path.wheel_speed, path.wheel_torque, EC_45_FLAT.reserved(PLANNED))
    assert used == pytest.approx(1.0 / PLANNED - 1.0, abs=0.01)
    assert limit_violation(path.wheel_speed, path.wheel_torque, EC_45_FLAT) < 1e-6


def test_where_no_plan_exists_there_is_none():
    found = reference(body(FORTY, 6e-5), EC_45_FLAT, drop(30.0), STANDING)
    assert found.trajectory is None
    assert "no optimal turn was found (no solution within the limits in" in found.note


def test_a_push_is_not_known_beforehand():
    found = reference(body(FORTY), EC_45_FLAT, PUSH, STANDING)
    assert found.trajectory is None
    assert "feedback" in found.note


@pytest.mark.slow
def test_a_turn_that_takes_longer_is_refused_with_its_time():
    """Between the time that fails and the one told the wheels of the theory's table turn by 90."""
    yaw = TurnTo(name="yaw", jump_height=1.0, yaw=np.pi / 2.0, duration=1.7)
    gyrostat = body(np.radians(39.0), 1.05e-4, DIAGONAL)
    found = reference(gyrostat, EC_45_FLAT, yaw, STANDING)
    assert found.trajectory is None
    told = re.fullmatch(r".* this turn in 1.7 s: they need (.*) s", found.note)
    assert told
    assert 1.0 / 1.05 < 2.0 / float(told[1]) < 1.05


@pytest.mark.slow
@pytest.mark.parametrize("layout", [LayoutName.TRIAD, LayoutName.PYRAMID])
def test_the_others_can_take_over_a_plan_whichever_drive_stops_at_its_start(layout):
    """The wheels left give its torque on the trunk and hold its momentum within their limits.

    With half of the spin inertia nothing is left for that, and the plan says so.
    """
    axes = Layout(layout).axes(ISOTROPIC)
    for inertia, follow in ((4e-4, True), (2e-4, False)):
        gyrostat = Gyrostat(FULL, axes, inertia)
        found = reference(gyrostat, EC_45_FLAT, BACK_FLIP, STANDING, one_stops=True)
        worst = 0.0
        for lost in range(axes.shape[1]):
            left = np.delete(axes, lost, axis=1)
            speed, torque = (
                np.linalg.lstsq(left, axes @ each.T, rcond=None)[0].T
                for each in (found.trajectory.wheel_speed, found.trajectory.wheel_torque)
            )
            worst = max(worst, limit_violation(speed, torque, EC_45_FLAT.reserved(PLANNED)))
        assert (worst < 1e-6) == follow
        assert (found.note == "") == follow
        assert (found.share <= PLANNED) == follow


@pytest.mark.slow
def test_the_supply_is_enough_for_the_others_whenever_a_drive_stops():
    """The satellite of docs/machines.md, 45 deg of pitch in 10 s with 62 W that friction leaves.

    Wheels that are left take the torque over and keep the momentum of all; what the one that
    stopped runs on with, they hold as well. A plan of least power for all four wheels has these
    work against each other, which three cannot do.
    """
    axes = Layout(LayoutName.PYRAMID).axes(ISOTROPIC)
    gyrostat = Gyrostat(np.diag([2.129, 3.311, 2.602]), axes, 6e-4)
    line = DriveLine(5.755, 1171.4, 0.709, 1407.4, 15.55)
    pitch = TurnTo(name="turn", pitch=np.pi / 4.0, duration=10.0, gravity=0.0, jump_height=9.0)
    shares = {}
    for one_stops in (True, False):
        path = reference(gyrostat, line, pitch, STANDING, one_stops=one_stops).trajectory
        assert path.note == ""
        largest = 0.0
        for lost in range(4):
            left = np.delete(axes, lost, axis=1)
            torque = np.linalg.solve(left, axes @ path.wheel_torque.T).T
            for stopped in range(0, len(path.time) - 1, len(path.time) // 8):
                kept = np.outer(
                    axes[:, lost], np.full(len(path.time), path.wheel_speed[stopped, lost])
                )
                speed = np.linalg.solve(left, axes @ path.wheel_speed.T - kept).T
                heat = line.no_load_speed / line.stall_torque * torque
                power = np.sum(torque * (speed + heat), axis=1)[stopped:]
                largest = max(largest, float(np.abs(power).max()))
        shares[one_stops] = largest / (4.0 * line.power_max)
    assert shares[True] < 0.95
    assert shares[False] > 2.0


@pytest.mark.slow
def test_a_loop_of_a_tall_body_leaves_more_of_the_drives():
    """As of Unitree's G1 with 3.5 times as much inertia about roll and pitch as about yaw."""
    yaw = TurnTo(name="yaw", jump_height=1.0, yaw=np.pi / 2.0, duration=4.0, gravity=1.62)
    axes = Layout(LayoutName.PAIR).axes(np.radians(45.0))
    line = DriveLine(25.0, 600.0, 7.4, np.inf, np.inf)
    found = {}
    for shape in ((3.2, 3.2, 0.9), (0.9, 0.9, 3.2)):
        for inertia in (2e-2, 8e-3):
            gyrostat = Gyrostat(np.diag(shape), axes, inertia)
            found[shape[0], inertia] = reference(gyrostat, line, yaw, STANDING)
    assert found[3.2, 2e-2].share == TALL_SPARE
    assert found[0.9, 2e-2].share == GENTLE[0]
    assert found[3.2, 2e-2].lacking(yaw.end) is None
    short = found[3.2, 8e-3]
    assert short.trajectory is not None
    assert short.lacking(yaw.end) == max(SPARE, short.share / TALL_SPARE) > SPARE
    assert found[0.9, 8e-3].lacking(yaw.end) is None
