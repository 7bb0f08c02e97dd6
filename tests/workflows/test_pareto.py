"""Points of a front: where they lie, what each is, and what becomes of those without a device."""

from dataclasses import replace

import pytest
from fronts import made_up_device, make_front, task_by_hand

from ocs_design.common.errors import QuantityError, SpecificationError, UsageError
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import SWEEPS
from ocs_design.sizing.comparison import draw_front
from ocs_design.workflows.pareto import read_task


@pytest.fixture(scope="module")
def task():
    return task_by_hand()


@pytest.mark.parametrize("name", SWEEPS)
def test_the_own_value_is_one_of_nine(task, name):
    sweep = SWEEPS[name]
    values = sweep.values(task, low=None, high=None, points=9)
    own = sweep.own(task)
    assert min(abs(value / own - 1.0) for value in values) < 1e-12
    assert values[0] < own < values[-1]


def test_values_as_stated(task):
    values = SWEEPS["time"].values(task, low="300ms", high="0.5", points=3)
    assert values == pytest.approx((0.3, 0.4, 0.5))


def test_one_end_may_be_left_to_its_default(task):
    own = SWEEPS["radius"].own(task)
    values = SWEEPS["radius"].values(task, low=None, high="60mm", points=2)
    assert values == pytest.approx((0.6 * own, 0.06))


@pytest.mark.parametrize(
    ("values", "error", "message"),
    [
        ({"low": "40mm", "high": "30mm"}, UsageError, "--from 40 mm is not below --to 30 mm"),
        ({"low": "30mm", "high": "30mm"}, UsageError, "not below"),
        ({"low": "0"}, UsageError, "--from 0: must be positive"),
        ({"high": "-1mm"}, UsageError, "--to -1mm: must be positive"),
        ({"low": "30ms"}, QuantityError, "--from"),
        ({"points": 1}, UsageError, "between 2 and 200"),
        ({"points": 201}, UsageError, "between 2 and 200"),
    ],
)
def test_values_that_make_no_front(task, values, error, message):
    wanted = {"low": None, "high": None, "points": 9, **values}
    with pytest.raises(error, match=message):
        SWEEPS["radius"].values(task, **wanted)


def test_a_point_without_a_device_says_why_and_the_others_stand(task):
    front = make_front(task)
    first, second = front.points[:2]
    assert first.device is None
    assert first.reason == "the wheels would have to be larger"
    assert second.device == made_up_device(
        task.with_specification(SWEEPS["time"].at(second.value, task))
    )
    assert second.reason == ""
    assert len(front.points) == 9
    assert len(front.feasible) == 8
    assert front.exit_code == 0


def test_a_value_that_contradicts_the_robot_is_a_point_without_a_device(task):
    """Room for the rim below its bore: no specification of its own could be so."""
    front = make_front(task, "radius", low="2mm", high="50mm", points=2)
    assert "leaves no room" in front.points[0].reason
    assert front.points[1].device is not None


def test_motors_above_their_rating_are_told_once_a_voltage(task):
    """As `size` tells it; a front against the voltage said nothing."""

    def fed(varied):
        volts = varied.specification.supply.voltage
        told = f"fed with {volts:g} V" if volts > 25.2 else ""
        return replace(made_up_device(task), overvoltage=told)

    front = draw_front(task, SWEEPS["voltage"], (12.0, 36.0, 36.0, 60.0), fed, lambda _: None)
    assert front.remarks[-2:] == ("fed with 36 V", "fed with 60 V")


def test_progress_is_told(task):
    told = []
    draw_front(task, SWEEPS["radius"], (0.04, 0.05), made_up_device, told.append)
    assert told == [0.5, 1.0]


def test_what_is_wrong_with_the_specification_itself_is_an_error(task):
    robot = task.specification.robot
    nothing = Specification(robot=robot, requirement=RequirementSection(maneuvers="none"))
    with pytest.raises(SpecificationError, match="does not fit"):
        read_task(nothing)


def test_other_errors_are_not_taken_for_an_answer(task):
    def broken(task):
        raise UsageError("no")

    with pytest.raises(UsageError):
        make_front(task, choose=broken)


def test_a_front_may_leave_the_own_value_out(task):
    assert make_front(task).spans_own_value
    assert not make_front(task, low="390ms", high="500ms").spans_own_value
