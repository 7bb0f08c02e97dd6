"""What was taken in place of what is not stated is told, however often a device is sized anew."""

from dataclasses import replace

import pytest
from designed import designed

from ocs_design.report.text.console import Steps
from ocs_design.requirement.turns import TurnTo
from ocs_design.workflows import rounds
from ocs_design.workflows.rounds import Placed, size_for_turns

TURN = TurnTo(name="turn", jump_height=1.0, yaw=1.0, duration=1.0)


class Reference:
    """A turn whose plan asks for so much more."""

    def __init__(self, factor):
        self.factor = factor

    def lacking(self, _end):
        return self.factor


@pytest.fixture
def placed():
    task, found = designed()
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
    found = size_for_turns(placed.telling(taken), Steps.silent(), strict=False)
    assert asked == [{"turn": 1.5}]
    assert found.estimates == {"turn": 1.5}
    assert found.resolved.assumptions == ("Layout: four wheels.", "assumed")
    assert found.warnings == ("four wheels are needed", "near")
