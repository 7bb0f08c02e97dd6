"""Two wheels on their robot: the fixed point recomputed independently, and failures."""

from dataclasses import replace

import gyrostats
import numpy as np
import pinocchio
import pytest
from gyrostats import PUSH
from products import coupling
from rims import STEEL, envelope_with

from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.device.layout import Criterion, incidence_by_criterion, module_axes
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.turns import Drop
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_sizing import (
    PRECISION,
    DeviceProblem,
    find_fixed_point,
    size_device,
)
from ocs_design.sizing.limits import RIM_LIMITS, TOP_SPEED

SOLO12 = MassProperties(
    2.5,
    [0.002, 0.0, -0.024],
    [[0.0300, 0.0001, 0.0004], [0.0001, 0.0515, -0.0002], [0.0004, -0.0002, 0.0680]],
)
ENVELOPE = envelope_with(
    0.05, 0.01, inner_radius_min=0.005, height_min=0.002, wall_min=0.002, mass_max=0.25,
    stress_safety=2.0,
)  # fmt: skip
SPEED = 754.0
DROP = Drop(name="drop", standing_height=0.25, height=1.0, pitch=np.radians(30.0))
BACK_FLIP = replace(gyrostats.BACK_FLIP, incidence=0.0)
MANEUVERS = (PUSH, DROP, BACK_FLIP)


def place(outer_radius, height):
    return np.array([[0.01, 0.07, 0.1 + outer_radius], [0.01, -0.07, 0.1 + outer_radius]])


def require(*maneuvers, rate_change=None, wheel_speed_max=SPEED, spin_inertia=None):
    return Requirement(maneuvers, rate_change, wheel_speed_max, spin_inertia)


def problem_of(requirement, envelope=ENVELOPE, *, incidence=None, criterion=Criterion.EQUAL_RATE):
    return DeviceProblem(SOLO12, requirement, envelope, STEEL, place, incidence, criterion)


def size(*arguments, **options):
    return size_device(problem_of(*arguments, **options))


def by_pinocchio(rim, centers, incidence):
    """Total of robot and wheels by Pinocchio, each wheel a cylinder less its bore."""
    total = pinocchio.Inertia(SOLO12.mass, SOLO12.com, SOLO12.inertia)
    for center, axis in zip(centers, module_axes(incidence).T, strict=True):
        rotation = pinocchio.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis).matrix()
        mass, spin, across = rim.mass, rim.spin_inertia, rim.transverse_inertia
        solid = pinocchio.Inertia.FromCylinder(
            np.pi * STEEL.density * rim.height * rim.outer_radius**2, rim.outer_radius, rim.height
        )
        hole = pinocchio.Inertia.FromCylinder(
            np.pi * STEEL.density * rim.height * rim.inner_radius**2, rim.inner_radius, rim.height
        )
        inertia = solid.inertia - hole.inertia
        assert np.diag(inertia) == pytest.approx([across, across, spin], rel=1e-9)
        wheel = pinocchio.Inertia(mass, np.zeros(3), inertia)
        total += pinocchio.SE3(rotation, center).act(wheel)
    return total


@pytest.mark.parametrize("criterion", [Criterion.EQUAL_RATE, Criterion.SIMULTANEOUS])
def test_fixed_point_from_scratch(criterion):
    """Total inertia, incidence and all demands, recomputed from the sized wheels alone."""
    requirement = require(*MANEUVERS, rate_change=3.0)
    sizing = size(requirement, criterion=criterion)
    total = by_pinocchio(sizing.rim, sizing.centers, sizing.incidence)
    assert sizing.total.mass == pytest.approx(total.mass, rel=1e-12)
    assert sizing.total.com == pytest.approx(total.lever, rel=1e-12)
    assert sizing.total.inertia == pytest.approx(total.inertia, rel=1e-10, abs=1e-15)

    inertia = total.inertia
    product = coupling(inertia)
    impulse = np.array([0.2, 0.8]) * 0.05
    fall = np.sqrt(2.0 * 0.75 / 9.81)
    drop = inertia[1, 1] * 2.0 * np.radians(30.0) / fall
    largest = np.maximum(impulse, [0.0, drop])
    largest = np.maximum(largest, 3.0 * np.diag(inertia)[:2])
    incidence = incidence_by_criterion(inertia, largest)[criterion]
    assert sizing.incidence == pytest.approx(incidence, abs=1e-10)

    sine, cosine = np.sin(incidence), np.cos(incidence)
    turned = by_pinocchio(sizing.rim, sizing.centers, 0.0).inertia
    # Roll, which the wheels do not control, follows pitch and reduces its inertia.
    flip = (turned[1, 1] - coupling(turned) ** 2 / turned[0, 0]) * 2.0 * np.pi
    expected = {
        "push": impulse[0] / sine + impulse[1] / cosine,
        "drop": drop * (1.0 / cosine + product / inertia[1, 1] / sine),
        "back-flip": flip,
        "rate change, roll": 3.0 * (inertia[0, 0] / sine + product / cosine),
        "rate change, pitch": 3.0 * (inertia[1, 1] / cosine + product / sine),
    }
    demands = {demand.source: demand.spin_inertia for demand in sizing.demands}
    assert demands == pytest.approx({k: v / (2.0 * SPEED) for k, v in expected.items()}, rel=1e-9)
    assert sizing.spin_inertia == pytest.approx(max(demands.values()), rel=1e-9)
    assert sizing.rim.spin_inertia == pytest.approx(sizing.spin_inertia, rel=1e-12)
    assert sizing.residual < 1e-9
    assert sizing.iterations < 50


def test_specified_incidence_is_kept():
    sizing = size(require(rate_change=1.0), incidence=0.7)
    assert sizing.incidence == 0.7
    assert {demand.incidence for demand in sizing.demands} == {0.7}


def test_specified_spin_inertia_is_kept():
    sizing = size(require(*MANEUVERS, spin_inertia=1.5e-4))
    assert sizing.spin_inertia == 1.5e-4
    assert max(demand.spin_inertia for demand in sizing.demands) > 1.5e-4


def test_maneuvers_with_modules_turned_by_hand_do_not_affect_the_incidence():
    with_flip = size(require(DROP, PUSH, BACK_FLIP, spin_inertia=1e-4), criterion="weighted")
    without = size(require(DROP, PUSH, spin_inertia=1e-4), criterion="weighted")
    assert with_flip.incidence == without.incidence


def test_a_tiny_requirement_gives_the_smallest_rim():
    sizing = size(require(rate_change=1e-4))
    assert max(demand.spin_inertia for demand in sizing.demands) < sizing.spin_inertia
    assert sizing.rim.height == pytest.approx(ENVELOPE.height_min, rel=1e-6)
    assert sizing.rim.inner_radius == pytest.approx(ENVELOPE.inner_radius_min, rel=1e-6)
    assert sizing.rim.outer_radius - sizing.rim.inner_radius == pytest.approx(
        ENVELOPE.wall_min, rel=1e-6
    )


def test_an_empty_requirement_is_refused():
    with pytest.raises(UsageError, match="nothing is required"):
        size(require())


@pytest.mark.slow
def test_relaxations_of_an_infeasible_problem():
    """Sizing succeeds with each relaxation, and fails with a smaller one."""
    envelope = replace(ENVELOPE, outer_radius_max=0.03, mass_max=0.2)
    requirement = require(*MANEUVERS)
    with pytest.raises(Infeasible) as caught:
        size(requirement, envelope)
    error = caught.value
    assert error.message.startswith("Back-flip requires too much: no rim of steel within")
    assert error.required_spin_inertia > error.largest_spin_inertia > 0.0
    assert "wheel_speed_max" in error.relaxations
    assert "r_max" in error.relaxations
    problem = problem_of(requirement, envelope)
    by_name = {limit.name: limit for limit in (*RIM_LIMITS, TOP_SPEED)}
    for name, value in error.relaxations.items():
        size_device(problem.with_limit(by_name[name], value))
        tighter = by_name[name].loosened(value, 1.0 / (1.0 + 3.0 * PRECISION))
        assert find_fixed_point(problem.with_limit(by_name[name], tighter)).shape is None


def test_wheel_speed_is_no_relaxation_for_a_specified_spin_inertia():
    with pytest.raises(Infeasible) as caught:
        size(require(rate_change=1.0, spin_inertia=1e-2))
    assert "wheel_speed_max" not in caught.value.relaxations
    assert caught.value.required_spin_inertia == 1e-2
    assert caught.value.message.startswith("No rim of steel")


@pytest.mark.parametrize(
    ("criterion", "axis"), [(Criterion.PITCH_ONLY, "roll"), (Criterion.ROLL_ONLY, "pitch")]
)
def test_an_uncontrolled_axis_is_infeasible(criterion, axis):
    with pytest.raises(Infeasible, match=f"{axis} momentum") as caught:
        size(require(rate_change=1.0), criterion=criterion)
    assert caught.value.binding == ("incidence",)
    assert np.isfinite(caught.value.required_spin_inertia)
