from pathlib import Path

import pytest
from robots import SOLO12
from wheels import paper_device

from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot
from ocs_design.simulation.world_builder import WorldBuilder


@pytest.fixture(scope="session")
def solo12() -> Robot:
    return read_robot(Path(SOLO12))


@pytest.fixture(scope="session")
def builder(solo12) -> WorldBuilder:
    """Worlds of Solo12 with the paper's device."""
    return WorldBuilder(solo12, paper_device())
