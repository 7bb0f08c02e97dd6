"""The example that flies the paper's wheel on every motor, here on three."""

from pathlib import Path

import pytest
from scripts import script_at

from ocs_design.catalogue.motors import motor

SCRIPT = Path(__file__).parents[2] / "examples" / "paper_wheel_motors.py"


@pytest.fixture(scope="module")
def example():
    return script_at(SCRIPT)


@pytest.mark.slow
def test_three_motors_pass_none_two_and_three_maneuvers(example):
    robot = example.read_robot(example.ROBOT)
    maneuvers = example.MANEUVERS
    motors = [motor(name) for name in ("GL40 KV70", "EC 45 flat 70 W 411812", "MN4010 KV580")]
    devices = [example.on_paper_wheel(robot, row, 24.0) for row in motors]
    verdicts = example.fly(robot, devices, maneuvers)
    assert [[verdict.passed for verdict in three] for three in verdicts] == [
        [False, False, False],
        [True, True, False],
        [True, True, True],
    ]
    row = example.line(devices[2], maneuvers, verdicts[2])
    assert row.split()[-3:] == ["yes", "yes", "yes"]
