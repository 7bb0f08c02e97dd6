"""The example that flies the paper's wheel on every motor, for three of them."""

from pathlib import Path

import pytest
from scripts import script_at

from ocs_design.catalogue.motors import motor

SCRIPT = Path(__file__).parents[2] / "examples" / "paper_wheel_motors.py"


@pytest.fixture(scope="module")
def example():
    return script_at(SCRIPT)


@pytest.mark.slow
def test_a_gimbal_motor_is_too_slow_and_a_strong_and_fast_one_does_all_three(example):
    robot = example.read_robot(example.ROBOT)
    maneuvers = example.MANEUVERS
    motors = [motor(name) for name in ("GL40 KV70", "EC 45 flat 70 W 411812", "MN4010 KV580")]
    devices = [example.on_paper_wheel(robot, each, 24.0) for each in motors]
    verdicts = example.fly(robot, devices, maneuvers)
    assert [[verdict.passed for verdict in three] for three in verdicts] == [
        [False, False, False],
        [True, True, False],
        [True, True, True],
    ]
    row = example.line(devices[2], maneuvers, verdicts[2])
    assert row.split()[-3:] == ["yes", "yes", "yes"]
