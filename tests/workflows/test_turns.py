"""A device that cannot make its turns is sized anew, or says what time they take."""

from math import pi

import pytest
from robots import SOLO12

from ocs_design.requirement import turns
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection
from ocs_design.requirement.phrases import About
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import Specification
from ocs_design.workflows import rounds as rounds_of
from ocs_design.workflows.size import design_ocs

QUARTER = Specification(
    robot=RobotSection(file=str(SOLO12)),
    requirement=RequirementSection(
        gravity=1.62, turn=(About(0.0, 0.0, pi / 2.0, 2.9, "rad"),), reliability=0.5
    ),
    flywheel=FlywheelSection(r_max=0.06),
    motor=MotorSection(name="Antigravity MN5008 KV400"),
    validation=ValidationSection(enabled=False),
)


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize("rounds", [rounds_of.TURN_ROUNDS, 0])
def test_a_closed_form_that_asks_too_little_is_made_good_by_the_plan(rounds, tmp_path, monkeypatch):
    full = turns.loop_length
    monkeypatch.setattr(turns, "loop_length", lambda heading: 0.6 * full(heading))
    monkeypatch.setattr(rounds_of, "TURN_ROUNDS", rounds)
    told = []
    outcome = design_ocs(
        QUARTER, out=tmp_path / "x", progress=lambda name, _part: told.append(name)
    )
    warnings = outcome.design.ocs.warnings
    unmade = [each for each in warnings if "do not make this turn in 2.9 s: they need" in each]
    assert ("size the device anew for its turns" in told) is (rounds > 0)
    assert len(unmade) == (0 if rounds else 1)
