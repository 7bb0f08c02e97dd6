"""Wheels are braked while the robot stands."""

import numpy as np
import pytest
from wheels import paper_device

from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.pivoted import Balance
from ocs_design.simulation.desaturation import SETTLING
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world_builder import Options, WorldBuilder


@pytest.fixture(scope="module")
def landed(solo12):
    """A disturbed jump, after which the wheels have momentum, without and with braking."""
    jump = default_maneuvers(solo12)[0]
    worlds = [
        WorldBuilder(solo12, paper_device(), Options(desaturate=brake)).flight(jump, Wheels.ACTIVE)
        for brake in (False, True)
    ]
    return simulate(worlds), worlds


def test_about_a_pivot_the_brake_torque_is_zero(solo12):
    """The robot does not stand on a pivot; in C the limit would apply to all maneuvers."""
    tilted = Balance(name="tilted", pivot=(0.0, 0.0, -0.3), roll=0.03, duration=1.0)
    builder = WorldBuilder(solo12, paper_device(), Options(desaturate=True))
    assert builder.flight(tilted, Wheels.ACTIVE).desaturation.torque_max == 0.0


def test_braking_starts_after_the_settling_time(landed):
    recording, _ = landed
    touchdown = recording.time[recording.contact[:, 0].argmax()]
    before = recording.time < touchdown + SETTLING
    assert recording.wheel_speed[before, 0].any()
    np.testing.assert_array_equal(
        recording.wheel_speed[before, 0], recording.wheel_speed[before, 1]
    )


def test_the_wheels_slow_down_and_the_robot_stays_on_its_feet(landed):
    recording, worlds = landed
    free, braked = np.abs(recording.wheel_speed[-1]).max(axis=1)
    assert braked < 0.5 * free
    assert recording.height[-1, 1] == pytest.approx(recording.height[-1, 0], abs=0.01)
    assert worlds[1].desaturation.torque_max > 0.0
