"""Sweeps vary one figure and keep all others."""

from dataclasses import replace
from math import hypot, radians

import pytest

from ocs_design.common.errors import UsageError
from ocs_design.requirement.phrases import About
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import SWEEPS, Task, sweep_of
from ocs_design.requirement.turns import Drop

WITH_ROLL = """
[[maneuver]]
name = "push"
kind = "disturbance"
takeoff_velocity = [0, 2.4]
torque = [0.2, 0.8, 0]
onset = 0.1
duration = 0.05

[[maneuver]]
name = "drop"
kind = "drop"
height = 0.8
roll = "-12deg"
pitch = "9deg"

[[maneuver]]
name = "back-flip"
kind = "flip"
jump_height = 0.8
angle = "-360deg"
duration = 0.75
"""


@pytest.fixture
def task(solo12):
    def make(text=""):
        return Task.of(parse_specification(text, "text"), solo12)

    return make


def varied(sweep, value, task):
    """The task with the sweep's figure at another value."""
    return task.with_specification(sweep.at(value, task))


@pytest.mark.parametrize("name", SWEEPS)
@pytest.mark.parametrize("text", ["", WITH_ROLL])
@pytest.mark.parametrize("ratio", [0.9, 1.0, 1.3])
def test_a_sweep_sets_its_value(task, name, text, ratio):
    sweep, specified = SWEEPS[name], task(text)
    value = ratio * sweep.present_value(specified)
    assert sweep.present_value(varied(sweep, value, specified)) == pytest.approx(value, rel=1e-14)


def test_own_values_of_solo12(task):
    specified = task()
    assert SWEEPS["time"].present_value(specified) == pytest.approx(0.385, abs=5e-4)
    assert SWEEPS["angle"].present_value(specified) == pytest.approx(radians(30.0))
    assert SWEEPS["radius"].present_value(specified) == 0.05
    assert SWEEPS["height"].present_value(specified) == 0.01
    assert SWEEPS["voltage"].present_value(specified) == 24.0


def test_longer_falls_and_flips_start_higher(task):
    longer = varied(
        SWEEPS["time"], 2.0 * SWEEPS["time"].present_value(task(WITH_ROLL)), task(WITH_ROLL)
    )
    push, drop, flip = longer.maneuvers
    standing = drop.standing_height
    assert drop.height - standing == pytest.approx(4.0 * (0.8 - standing))
    assert (drop.roll, drop.pitch) == pytest.approx((radians(-12.0), radians(9.0)))
    assert flip.duration == pytest.approx(1.5)
    assert flip.flight_time / flip.duration == pytest.approx(
        task(WITH_ROLL).maneuvers[2].flight_time / 0.75
    )
    assert vars(push) == vars(task(WITH_ROLL).maneuvers[0])


def test_a_larger_angle_keeps_direction_and_sign(task):
    wider = varied(SWEEPS["angle"], 1.5 * hypot(radians(12.0), radians(9.0)), task(WITH_ROLL))
    push, drop, flip = wider.maneuvers
    assert (drop.roll, drop.pitch) == pytest.approx((radians(-18.0), radians(13.5)))
    assert drop.height == 0.8
    assert flip.angle == pytest.approx(radians(-540.0))
    assert isinstance(push, Disturbance)


def test_a_sweep_of_one_maneuver(task):
    sweep = sweep_of("time", "back-flip")
    assert sweep.present_value(task(WITH_ROLL)) == 0.75
    _, drop, flip = varied(sweep, 0.7, task(WITH_ROLL)).maneuvers
    assert isinstance(drop, Drop)
    assert drop.height == 0.8
    assert flip.duration == pytest.approx(0.7)


def test_remarks_name_what_varies_and_what_does_not(task):
    remarks = " ".join(SWEEPS["time"].remarks(task(WITH_ROLL)))
    assert remarks == (
        "The time is that of 'drop'. Varied in proportion: back-flip. Not varied: push."
    )
    alone = " ".join(sweep_of("angle", "back-flip").remarks(task(WITH_ROLL)))
    assert alone == "The angle is that of 'back-flip'. Not varied: push, drop."
    assert SWEEPS["radius"].remarks(task()) == ()


def test_a_sweep_replaces_the_papers_three_by_tables(task):
    """With a varied figure they are not the paper's any more."""
    specified = task('[requirement]\nmaneuvers = "paper"')
    specification = SWEEPS["time"].at(0.4, specified)
    assert len(specification.maneuvers) == 3
    assert specification.requirement.maneuvers is None


@pytest.mark.parametrize(
    ("name", "maneuver", "text", "message"),
    [
        ("speed", "", "", "--against speed: is not one of time, angle"),
        ("radius", "drop", "", "the radius is not a figure of a maneuver"),
        ("time", "somersault", "", "there is no such maneuver"),
        ("time", "disturbance", "", "disturbance has no turn"),
        (
            "angle",
            "",
            '[requirement]\nmaneuvers = "none"\nrate_change = 2',
            "the specification has no turn",
        ),
    ],
)
def test_invalid_sweeps_are_refused(task, name, maneuver, text, message):
    with pytest.raises(UsageError, match=message):
        sweep_of(name, maneuver).present_value(task(text))


def test_a_level_drop_has_no_angle_to_scale(task):
    level = '[[maneuver]]\nname = "fall"\nkind = "drop"\nheight = 0.8\npitch = 0\n'
    level += "[requirement]\nrate_change = 2\n"
    with pytest.raises(UsageError, match="has no turn"):
        SWEEPS["angle"].present_value(task(level))


def test_a_variant_keeps_the_estimate_from_the_plan_of_a_turn(solo12):
    """A turn that needs 1.3 times its closed form does so in another envelope, too."""
    words = Specification(requirement=RequirementSection(turn=(About(0.5, 0.0, 0.0, 0.5, "rad"),)))
    task = Task.of(words, solo12)
    task = replace(task, resolved=task.resolved.estimated({"turn": 1.3}))
    varied = task.with_specification(task.with_key("flywheel", "r_max", 0.06))
    assert [each.estimate for each in varied.maneuvers] == [1.3]
