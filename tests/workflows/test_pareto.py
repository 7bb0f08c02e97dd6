"""Points of a front: their values, devices, and reasons where there is none."""

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
def test_the_specified_value_is_one_of_nine(task, name):
    sweep = SWEEPS[name]
    values = sweep.values(task, low=None, high=None, points=9)
    own = sweep.present_value(task)
    assert min(abs(value / own - 1.0) for value in values) < 1e-12
    assert values[0] < own < values[-1]


def test_specified_values(task):
    values = SWEEPS["time"].values(task, low="300ms", high="0.5", points=3)
    assert values == pytest.approx((0.3, 0.4, 0.5))


def test_one_end_may_be_left_to_its_default(task):
    own = SWEEPS["radius"].present_value(task)
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
def test_impossible_values_are_refused(task, values, error, message):
    arguments = {"low": None, "high": None, "points": 9, **values}
    with pytest.raises(error, match=message):
        SWEEPS["radius"].values(task, **arguments)


def test_a_point_without_a_device_has_a_reason(task):
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
    """An outer radius below the bore, which a specification alone would not allow."""
    front = make_front(task, "radius", low="2mm", high="50mm", points=2)
    assert "leaves no room" in front.points[0].reason
    assert front.points[1].device is not None


def test_motors_above_their_rating_have_one_remark_per_voltage(task):
    """Once only `size` had the remark, not a front against voltage."""

    def device_at(varied):
        volts = varied.specification.supply.voltage
        note = f"fed with {volts:g} V" if volts > 25.2 else ""
        return replace(made_up_device(task), overvoltage=note)

    front = draw_front(task, SWEEPS["voltage"], (12.0, 36.0, 36.0, 60.0), device_at, lambda _: None)
    assert front.remarks[-2:] == ("fed with 36 V", "fed with 60 V")


def test_progress_is_reported(task):
    fractions = []
    draw_front(task, SWEEPS["radius"], (0.04, 0.05), made_up_device, fractions.append)
    assert fractions == [0.5, 1.0]


def test_a_wrong_specification_is_an_error(task):
    robot = task.specification.robot
    without_maneuvers = Specification(robot=robot, requirement=RequirementSection(maneuvers="none"))
    with pytest.raises(SpecificationError, match="does not fit"):
        read_task(without_maneuvers)


def test_other_errors_are_raised(task):
    def broken(task):
        raise UsageError("no")

    with pytest.raises(UsageError):
        make_front(task, choose=broken)


def test_a_front_may_exclude_the_specified_value(task):
    assert make_front(task).spans_own_value
    assert not make_front(task, low="390ms", high="500ms").spans_own_value
