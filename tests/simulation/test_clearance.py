"""Clearance of the wheels against distances by hand."""

from dataclasses import replace

import numpy as np
import pytest
from robots import ROBOTS
from wheels import paper_device

from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.clearance import nearest_part

BOX = robot_by_hand(6.0, (0.05, 0.05, 0.05))
"""A cube: I = m a^2 / 6."""
HALF = np.sqrt(0.05) / 2.0


def device_at(x, y, z):
    """The paper's wheels with lateral axes."""
    device = paper_device(0.0)
    left, right = device.modules
    return replace(
        device,
        modules=(
            replace(left, position=np.array([x, y, z])),
            replace(right, position=np.array([x, -y, z])),
        ),
    )


def test_over_a_box():
    found = nearest_part(BOX, device_at(0.0, 0.05, HALF + 0.03 + 0.004))
    assert found.part == "base"
    assert found.distance == pytest.approx(0.004, abs=1e-6)


def test_between_the_wheels():
    found = nearest_part(BOX, device_at(0.0, 0.0065, HALF + 0.2))
    assert found.part == "ocs_right_flywheel"
    # Two wheels 10 mm high, centres 13 mm apart.
    assert found.distance == pytest.approx(0.003, abs=1e-6)


def test_inside_the_robot():
    assert nearest_part(BOX, device_at(0.0, 0.04, 0.0)).distance < 0.0


def test_wheels_in_the_torso_of_a_humanoid_are_seen():
    robot = read_robot(next(ROBOTS.rglob("talos_reduced.urdf")))
    found = nearest_part(robot, device_at(*(0.0, 0.1, 0.2)))
    assert found.distance < 0.0
    assert "torso" in found.part
