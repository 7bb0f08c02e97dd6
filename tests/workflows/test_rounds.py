"""What is tried in turn, and that what was taken is told however often a device is sized anew."""

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
from ocs_design.sizing.on_robot import NeverHeld
from ocs_design.workflows import rounds
from ocs_design.workflows.rounds import Placed, size_for_turns, size_or_advise
from ocs_design.workflows.size import design_ocs

TURN = TurnTo(name="turn", jump_height=1.0, yaw=1.0, duration=1.0)


class Reference:
    """A turn whose plan asks for so much more."""

    def __init__(self, factor):
        self.factor = factor

    def missing_demand(self, _end):
        return self.factor


@pytest.fixture
def placed():
    task, found = design_with_motor()
    requirement = replace(task.resolved.requirement, maneuvers=(TURN,))
    resolved = replace(task.resolved, requirement=requirement, assumptions=("assumed",))
    return Placed(task.specification, task.robot, resolved, found, None, ("near",), None)


def test_after_a_round_for_turns(placed, monkeypatch):
    asked = []

    def size_again(_specification, _robot, *, strict, estimates):
        asked.append(dict(estimates))
        return replace(placed, estimates=estimates)

    plans = iter([{"turn": Reference(1.5)}, {"turn": Reference(None)}])
    monkeypatch.setattr(rounds, "references_of", lambda *_: next(plans))
    monkeypatch.setattr(rounds, "size_on_robot", size_again)
    taken = (("Layout: four wheels.",), ("four wheels are needed",))
    found = size_for_turns(placed.telling(taken), Steps(), strict=False)
    assert asked == [{"turn": 1.5}]
    assert found.estimates == {"turn": 1.5}
    assert found.resolved.assumptions == ("Layout: four wheels.", "assumed")
    assert found.warnings == ("four wheels are needed", "near")


def weighing(placed, asked, mass, motor):
    """What was placed for a specification, of that mass and with motors of that mass [kg]."""
    device = placed.designed.device
    carrier = replace(device.carrier, mass=mass / 2.0 - device.flywheel.mass)
    made = replace(device, carrier=carrier, motor=replace(device.motor, mass=motor))
    return replace(placed, specification=asked, designed=replace(placed.designed, device=made))


TWO, FOUR, SIX = None, "double-pair", "triple-pair"
AT_ALPHA, LIGHTEST = None, "lightest"


@pytest.mark.parametrize(
    ("motor", "weigh", "taken", "why"),
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
            [
                (TWO, AT_ALPHA),
                (FOUR, AT_ALPHA),
                (FOUR, LIGHTEST),
                (SIX, AT_ALPHA),
                (SIX, LIGHTEST),
            ],
            "",
        ),
    ],
    ids=["light motors", "four are heavier", "four are lighter", "lighter at an angle", "no more"],
)
def test_heavy_motors_give_way_to_more_wheels_that_weigh_less(
    placed, monkeypatch, motor, weigh, taken, why
):
    """Of devices of 3 kg on a robot of 2.5 kg, whose two motors weigh 19.2 or 20.8 % of it."""
    assert placed.robot.mass == pytest.approx(2.5)
    tried = []

    def size_one(asked, _robot, *, strict):
        key = asked.ocs.layout, asked.ocs.alpha_criterion
        tried.append(key)
        mass = weigh.get(key, weigh.get(key[0], 3.0))
        if mass is None:
            raise NeverHeld(placed.designed.choice.chosen, 1.0)
        return weighing(placed, asked, mass, motor)

    monkeypatch.setattr(rounds, "size_on_robot", size_one)
    specified = replace(placed.specification, ocs=replace(placed.specification.ocs, layout=None))
    found = size_or_advise(specified, placed.robot, Steps(), strict=False)
    assert tried == taken
    lightest = min([3.0, *(mass for mass in weigh.values() if mass)])
    assert found.designed.device.mass == pytest.approx(lightest)
    assert next(iter(found.resolved.assumptions)) == (why or "assumed")


def test_strict_looks_at_the_device_that_is_taken(placed, monkeypatch):
    """The pair of 120 % of the robot gives way to four of 20 %; alone it is refused."""

    def size_one(asked, _robot, *, strict):
        assert not strict
        mass = 3.0 if asked.ocs.layout is TWO or not lighter else 0.5
        return weighing(placed, asked, mass, motor=0.26)

    monkeypatch.setattr(rounds, "size_on_robot", size_one)
    monkeypatch.setattr(rounds, "placement_warnings", lambda *_, **__: ())
    specified = replace(placed.specification, ocs=replace(placed.specification.ocs, layout=None))
    lighter = True
    found = size_or_advise(specified, placed.robot, Steps(), strict=True)
    assert found.designed.device.mass == pytest.approx(0.5)
    lighter = False
    with pytest.raises(SpecificationError, match="120% of the robot"):
        size_or_advise(specified, placed.robot, Steps(), strict=True)


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
@pytest.mark.parametrize(
    "most", [rounds.TURN_ROUNDS, pytest.param(0, marks=pytest.mark.exhaustive)]
)
def test_a_closed_form_that_asks_too_little_is_made_good_by_the_plan(most, tmp_path, monkeypatch):
    full = turns.loop_length
    monkeypatch.setattr(turns, "loop_length", lambda heading: 0.6 * full(heading))
    monkeypatch.setattr(rounds, "TURN_ROUNDS", most)
    told = []
    outcome = design_ocs(
        QUARTER, out=tmp_path / "x", progress=lambda name, _part: told.append(name)
    )
    warnings = outcome.design.ocs.warnings
    unmade = [each for each in warnings if "cannot make this turn in 2.9 s: they need" in each]
    assert ("resize the device for its turns" in told) is (most > 0)
    assert len(unmade) == (0 if most else 1)
