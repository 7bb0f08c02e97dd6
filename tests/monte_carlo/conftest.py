from pathlib import Path

import pytest
from robots import SOLO12

from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot


@pytest.fixture(scope="session")
def solo12() -> Robot:
    return read_robot(Path(SOLO12))
