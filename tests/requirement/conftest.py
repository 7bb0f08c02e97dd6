"""Robots specified by mass and inertia alone."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.robot import Robot


@pytest.fixture(scope="session")
def make_robot() -> Callable[..., Robot]:
    """Makes a robot of one body from its mass, principal inertias and standing height."""

    def make(mass: float, inertia: tuple[float, float, float], standing_height: float | None):
        robot = robot_by_hand(mass, inertia, name="figures")
        return replace(robot, standing_height=standing_height)

    return make


@pytest.fixture(scope="session")
def solo12(make_robot) -> Robot:
    """Solo12, the reference of the Froude scaling."""
    from ocs_design.requirement.froude import (
        SOLO12_GYRATION_RADIUS,
        SOLO12_HEIGHT,
        SOLO12_PITCH_INERTIA,
        SOLO12_ROLL_INERTIA,
    )

    gyration = 7.5 * SOLO12_GYRATION_RADIUS**2
    yaw = gyration - SOLO12_ROLL_INERTIA - SOLO12_PITCH_INERTIA
    return make_robot(2.5, (SOLO12_ROLL_INERTIA, SOLO12_PITCH_INERTIA, yaw), SOLO12_HEIGHT)
