"""The policy of the example, in one flight."""

from pathlib import Path

import numpy as np
import pytest
from scripts import script_at
from stories import design

from ocs_design.common.files import to_json

EXAMPLE = Path(__file__).parents[2] / "examples" / "learn_to_land.py"


@pytest.fixture
def example(tmp_path):
    module = script_at(EXAMPLE)
    (tmp_path / "design.json").write_bytes(to_json(design()))
    module.begin(str(tmp_path))
    return module


@pytest.mark.slow
def test_a_policy_that_turns_towards_level_earns_more_than_one_that_turns_away(example):
    observation, info = example.env.reset(options={"sample": 3})
    # Torque about pitch as of the control law at the start, and against the rate.
    towards = np.zeros((2, 4))
    towards[:, 3], towards[:, 1] = -30.0 * np.sign(info["law"]), 6.0 * np.sign(info["law"])
    assert (np.sign(example.action(towards, observation)) == np.sign(info["law"])).all()
    good, idle, bad = (example.learnt((sign * towards, 3)) for sign in (1.0, 0.0, -1.0))
    assert good > idle + 0.05 > bad + 0.1
    assert example.tested(None, 3)[0] is True
