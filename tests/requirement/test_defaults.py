"""Stating every default changes nothing of what is designed for."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from ocs_design.requirement.resolving import default_specification, resolve
from ocs_design.requirement.specification import Specification

SIZE = 2.0
GAINS = {"kp": 60.0, "kd": 12.0}


@pytest.fixture
def large(make_robot):
    """Of another mass, height and shape than Solo12, on another bus."""
    return make_robot(50.0, (2.0, 5.0, 6.0), 0.5)


@pytest.mark.parametrize("robot", ["solo12", "large"])
def test_stating_every_default_changes_nothing(robot, request):
    robot = request.getfixturevalue(robot)
    default = default_specification(robot, **GAINS)
    stated = replace(default, requirement=replace(default.requirement, maneuvers=None))
    assumed, told = (resolve(each, robot, SIZE) for each in (Specification(), stated))
    assert told.envelope == assumed.envelope
    assert asdict(told.requirement) == asdict(assumed.requirement)
    for name in ("motors", "gears", "materials", "supply", "wheel_speed_max"):
        assert getattr(told.choice, name) == getattr(assumed.choice, name)


def test_only_that_a_design_keeps_a_reserve_stays_an_assumption(solo12):
    default = default_specification(solo12, **GAINS)
    stated = replace(default, requirement=replace(default.requirement, maneuvers=None))
    left = " ".join(resolve(stated, solo12, SIZE).assumptions)
    for said in ("Rim:", "Rim mass", "Supply:", "Web:", "Stress:", "paper's three"):
        assert said not in left
    assert "Reserve" in left


def test_maneuvers_fall_as_gravity_has_it(solo12):
    disturbance, drop, flip = default_specification(solo12, **GAINS, gravity=3.7).maneuvers
    assert disturbance.gravity == drop.gravity == 3.7
    np.testing.assert_allclose(disturbance.takeoff_velocity[1], 2.4 * np.sqrt(3.7 / 9.81))
    assert flip.gravity == 1.62


@pytest.mark.parametrize(
    ("robot", "said"), [("solo12", "at most 250 g"), ("large", "at most 5 kg")]
)
def test_the_rim_mass_is_told_in_a_unit_that_needs_no_exponent(robot, said, request):
    assumptions = resolve(Specification(), request.getfixturevalue(robot), SIZE).assumptions
    assert said in next(each for each in assumptions if each.startswith("Rim mass"))
