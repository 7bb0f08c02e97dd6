"""Whether a robot's parts add up to what the specification says it weighs."""

import pytest
from commands import SOLO12, run

from ocs_design.common.errors import RobotError
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification

TOLD = "the parts' masses add up to 2.5"


def warnings_of(weighed, **options):
    stated = Specification(robot=RobotSection(file=SOLO12, weighed=weighed))
    return read_specified_robot(stated, **options).warnings


@pytest.mark.parametrize(("weighed", "word"), [(2.7, "missing"), (2.2, "too heavy")])
def test_parts_that_do_not_add_up_are_told(weighed, word):
    told = [warning for warning in warnings_of(weighed) if warning.startswith(TOLD)]
    assert len(told) == 1
    assert word in told[0]
    with pytest.raises(RobotError, match=TOLD):
        warnings_of(weighed, strict=True)


@pytest.mark.parametrize("weighed", [2.47, 2.53])
def test_a_robot_that_weighs_the_sum_of_its_parts_is_no_matter(weighed):
    assert not any(warning.startswith(TOLD) for warning in warnings_of(weighed))


def test_it_is_an_option_with_a_unit():
    assert TOLD in run("inspect", SOLO12, "--weighed", "2700g").said
