"""The paper's experiments, scaled, on robots from 1.3 kg to 93 kg, with two legs and with four."""

import numpy as np
import pytest
from robots import ROBOTS
from sampled import every
from wheels import paper_maneuvers, scaled_device

from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import run_scenarios

QUADRUPEDS = [
    "a1_description/urdf/a1",
    "anymal_c_simple_description/urdf/anymal",
    "hyq_description/robots/hyq_no_sensors",
]
BIPEDS = [
    "bolt_description/robots/bolt",
    "icub_description/robots/icub",
    "talos_data/robots/talos_full_v2",
]


def fly(path):
    robot = read_robot(ROBOTS / f"{path}.urdf")
    return run_scenarios(robot, scaled_device(robot), paper_maneuvers(robot))


@pytest.mark.parametrize("path", every(3, [*QUADRUPEDS, *BIPEDS]))
def test_flights_keep_their_momentum_and_land_level_with_the_device(path):
    runs = fly(path)
    if path in QUADRUPEDS:
        assert [run.passed for run in runs] == [True, False] * 3
    for run in runs:
        assert run.metrics.momentum_error < 1e-7
        tilt = max(abs(run.metrics.touchdown_roll), abs(run.metrics.touchdown_pitch))
        flipped = abs(run.metrics.turned_angle) > np.radians(355.0)
        if run.ocs:
            assert tilt < np.radians(5.0), run.reason
            assert flipped == (run.scenario == "back-flip")
        else:
            assert run.passed is False


def test_a_biped_without_balance_is_judged_on_touchdown_alone():
    """On Earth it falls over on its joint drives; at a sixth of the weight they hold it up."""
    runs = fly("bolt_description/robots/bolt")
    assert [run.passed for run in runs] == [True, False] * 3
    jump, drop, flip = (run.reason for run in runs if run.ocs)
    assert "standing is not judged" in jump
    assert "standing is not judged" in drop
    assert "and stands" in flip
