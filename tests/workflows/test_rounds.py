"""Rounds of sizing: more wheels for heavy motors, and turns whose plan needs larger wheels."""

from dataclasses import replace
from math import pi

import pytest
from designed_devices import design_with_motor
from robots import SOLO12

from ocs_design.common.errors import SpecificationError
from ocs_design.report.text.console import Steps
from ocs_design.requirement import turns
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection
from ocs_design.requirement.phrases import About
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.turns import TurnTo
from ocs_design.sizing.on_robot import NoMountHolds
from ocs_design.workflows import rounds
from ocs_design.workflows.rounds import PlacedDevice, size_for_turns, size_or_advise
from ocs_design.workflows.size import design_ocs

TURN = TurnTo(name="turn", jump_height=1.0, yaw=1.0, duration=1.0)


class Reference:
    """The reference of a turn whose plan needs wheels larger by a factor."""

    def __init__(self, factor):
        self.factor = factor

    def missing_demand(self, _end):
        return self.factor


@pytest.fixture
def placed():
    task, sizing = design_with_motor()
    requirement = replace(task.resolved.requirement, maneuvers=(TURN,))
    resolved = replace(task.resolved, requirement=requirement, assumptions=("assumed",))
    return PlacedDevice(task.specification, task.robot, resolved, sizing, None, ("near",), None)


def test_a_turn_that_needs_larger_wheels_is_sized_again(placed, monkeypatch):
    requests = []

    def size_again(_specification, _robot, *, strict, reserve, estimates):
        requests.append(dict(estimates))
        return replace(placed, estimates=estimates)

    plans = iter([{"turn": Reference(1.5)}, {"turn": Reference(None)}])
    monkeypatch.setattr(rounds, "turn_references", lambda *_: next(plans))
    monkeypatch.setattr(rounds, "size_on_robot", size_again)
    changes = (("Layout: four wheels.",), ("four wheels are needed",))
    final = size_for_turns(placed.with_substitutions(changes), Steps(), strict=False)
    assert requests == [{"turn": 1.5}]
    assert final.estimates == {"turn": 1.5}
    assert final.resolved.assumptions == ("Layout: four wheels.", "assumed")
    assert final.warnings == ("four wheels are needed", "near")


def with_masses(placed, specification, mass, motor):
    """The placed device for a specification, with this mass and mass of a motor [kg]."""
    device = placed.designed.device
    carrier = replace(device.carrier, mass=mass / 2.0 - device.flywheel.mass)
    changed = replace(device, carrier=carrier, motor=replace(device.motor, mass=motor))
    return replace(
        placed, specification=specification, designed=replace(placed.designed, device=changed)
    )


TWO, FOUR, SIX = None, "double-pair", "triple-pair"
AT_ALPHA, LIGHTEST = None, "lightest"


@pytest.mark.parametrize(
    ("motor", "masses", "expected", "assumption"),
    [
        (0.24, {}, [(TWO, AT_ALPHA)], ""),
        (0.26, {FOUR: 4.0}, [(TWO, AT_ALPHA), (FOUR, AT_ALPHA)], ""),
        (
            0.26,
            {FOUR: 2.0, SIX: 2.5},
            [(TWO, AT_ALPHA), (FOUR, AT_ALPHA), (SIX, AT_ALPHA)],
            "Layout: double-pair, 4 wheels. With two: 3 kg.",
        ),
        (
            0.26,
            {(FOUR, AT_ALPHA): None, FOUR: 2.0, SIX: 2.5},
            [(TWO, AT_ALPHA), (FOUR, AT_ALPHA), (FOUR, LIGHTEST), (SIX, AT_ALPHA)],
            "Layout: double-pair, 4 wheels. With two: 3 kg.",
        ),
        (
            0.26,
            {FOUR: None, SIX: None},
            [(TWO, AT_ALPHA), (FOUR, AT_ALPHA), (FOUR, LIGHTEST), (SIX, AT_ALPHA), (SIX, LIGHTEST)],
            "",
        ),
    ],
    ids=["light motors", "four are heavier", "four are lighter", "lighter at an angle", "no more"],
)
def test_more_wheels_replace_heavy_motors_where_they_are_lighter(
    placed, monkeypatch, motor, masses, expected, assumption
):
    """Devices of 3 kg on a robot of 2.5 kg, with two motors of 19.2 or 20.8 % of its mass."""
    assert placed.robot.mass == pytest.approx(2.5)
    tried = []

    def size_one(specification, _robot, *, strict):
        key = specification.ocs.layout, specification.ocs.alpha_criterion
        tried.append(key)
        mass = masses.get(key, masses.get(key[0], 3.0))
        if mass is None:
            raise NoMountHolds(placed.designed.choice.chosen, 1.0)
        return with_masses(placed, specification, mass, motor)

    monkeypatch.setattr(rounds, "size_on_robot", size_one)
    specified = replace(placed.specification, ocs=replace(placed.specification.ocs, layout=None))
    final = size_or_advise(specified, placed.robot, Steps(), strict=False)
    assert tried == expected
    lightest = min([3.0, *(mass for mass in masses.values() if mass)])
    assert final.designed.device.mass == pytest.approx(lightest)
    assert next(iter(final.resolved.assumptions)) == (assumption or "assumed")


def test_strict_applies_to_the_final_device(placed, monkeypatch):
    """Four wheels of 20 % replace a pair of 120 % of the robot, which alone is refused."""

    def size_one(specification, _robot, *, strict):
        assert not strict
        mass = 3.0 if specification.ocs.layout is TWO or not lighter else 0.5
        return with_masses(placed, specification, mass, motor=0.26)

    monkeypatch.setattr(rounds, "size_on_robot", size_one)
    monkeypatch.setattr(rounds, "placement_warnings", lambda *_, **__: ())
    specified = replace(placed.specification, ocs=replace(placed.specification.ocs, layout=None))
    lighter = True
    final = size_or_advise(specified, placed.robot, Steps(), strict=True)
    assert final.designed.device.mass == pytest.approx(0.5)
    lighter = False
    with pytest.raises(SpecificationError, match="120% of the robot"):
        size_or_advise(specified, placed.robot, Steps(), strict=True)


QUARTER_TURN = Specification(
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
@pytest.mark.parametrize(
    "rounds_allowed", [rounds.TURN_ROUNDS, pytest.param(0, marks=pytest.mark.exhaustive)]
)
def test_rounds_correct_a_closed_form_that_is_too_low(rounds_allowed, tmp_path, monkeypatch):
    original = turns.loop_length
    monkeypatch.setattr(turns, "loop_length", lambda heading: 0.6 * original(heading))
    monkeypatch.setattr(rounds, "TURN_ROUNDS", rounds_allowed)
    steps = []
    outcome = design_ocs(
        QUARTER_TURN, out=tmp_path / "x", progress=lambda name, _part: steps.append(name)
    )
    warnings = outcome.design.ocs.warnings
    infeasible = [text for text in warnings if "cannot make this turn in 2.9 s: they need" in text]
    assert ("resize the device for its turns" in steps) is (rounds_allowed > 0)
    assert len(infeasible) == (0 if rounds_allowed else 1)
