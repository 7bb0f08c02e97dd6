"""Both wheels on their robot: the fixed point from scratch, scaling laws, and failures."""

from dataclasses import replace

import gyrostats
import numpy as np
import pinocchio
import pytest
from gyrostats import PUSH
from rims import STEEL, envelope_with

from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.device.layout import Criterion, incidence_by_criterion, module_axes
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.turns import Drop
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.bound.device_problem import DeviceProblem, find_fixed_point
from ocs_design.sizing.bound.device_sizing import size_device
from ocs_design.sizing.bound.infeasible import DEVICE_PRECISION
from ocs_design.sizing.limits import RIM_LIMITS, TOP_SPEED

SOLO12 = MassProperties(
    2.5,
    [0.002, 0.0, -0.024],
    [[0.0300, 0.0001, 0.0004], [0.0001, 0.0515, -0.0002], [0.0004, -0.0002, 0.0680]],
)
ROOM = envelope_with(
    0.05, 0.01, inner_radius_min=0.005, height_min=0.002, wall_min=0.002, mass_max=0.25,
    stress_safety=2.0,
)  # fmt: skip
SPEED = 754.0
DROP = Drop(name="drop", height=1.0, pitch=np.radians(30.0))
BACK_FLIP = replace(gyrostats.BACK_FLIP, incidence=0.0)
MANEUVERS = (PUSH, DROP, BACK_FLIP)


def place(outer_radius, height):
    return np.array([[0.01, 0.07, 0.1 + outer_radius], [0.01, -0.07, 0.1 + outer_radius]])


def asks(*maneuvers, rate_change=None, wheel_speed_max=SPEED, spin_inertia=None):
    return Requirement(maneuvers, rate_change, wheel_speed_max, spin_inertia, 0.25)


def problem_of(requirement, envelope=ROOM, *, incidence=None, criterion=Criterion.EQUAL_RATE):
    return DeviceProblem(SOLO12, requirement, envelope, STEEL, place, incidence, criterion)


def size(*asked, **options):
    return size_device(problem_of(*asked, **options))


def by_pinocchio(rim, centers, incidence):
    """Robot and wheels, each wheel a full cylinder less its bore, joined by Pinocchio."""
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


def coupled(inertia):
    """Roll momentum of a unit rate of pitch with no momentum of yaw."""
    rate = np.array([0.0, 1.0, -inertia[2, 1] / inertia[2, 2]])
    return (inertia @ rate)[0]


@pytest.mark.parametrize("criterion", [Criterion.EQUAL_RATE, Criterion.SIMULTANEOUS])
def test_fixed_point_from_scratch(criterion):
    """Recompute total inertia, incidence and every demand from the sized wheels alone."""
    requirement = asks(*MANEUVERS, rate_change=3.0)
    found = size(requirement, criterion=criterion)
    total = by_pinocchio(found.rim, found.centers, found.incidence)
    assert found.total.mass == pytest.approx(total.mass, rel=1e-12)
    assert found.total.com == pytest.approx(total.lever, rel=1e-12)
    assert found.total.inertia == pytest.approx(total.inertia, rel=1e-10, abs=1e-15)

    inertia = total.inertia
    product = abs(coupled(inertia))
    impulse = np.array([0.2, 0.8]) * 0.05
    fall = np.sqrt(2.0 * 0.75 / 9.81)
    drop = inertia[1, 1] * 2.0 * np.radians(30.0) / fall
    largest = np.maximum(impulse, [0.0, drop])
    largest = np.maximum(largest, 3.0 * np.diag(inertia)[:2])
    incidence = incidence_by_criterion(inertia, largest)[criterion]
    assert found.incidence == pytest.approx(incidence, abs=1e-10)

    sine, cosine = np.sin(incidence), np.cos(incidence)
    turned = by_pinocchio(found.rim, found.centers, 0.0).inertia
    # Roll, out of the wheels' reach, follows pitch and takes some of it.
    flip = (turned[1, 1] - coupled(turned) ** 2 / turned[0, 0]) * 2.0 * np.pi
    expected = {
        "push": impulse[0] / sine + impulse[1] / cosine,
        "drop": drop * (1.0 / cosine + product / inertia[1, 1] / sine),
        "back-flip": flip,
        "rate change, roll": 3.0 * (inertia[0, 0] / sine + product / cosine),
        "rate change, pitch": 3.0 * (inertia[1, 1] / cosine + product / sine),
    }
    demands = {demand.source: demand.spin_inertia for demand in found.demands}
    assert demands == pytest.approx({k: v / (2.0 * SPEED) for k, v in expected.items()}, rel=1e-9)
    assert found.spin_inertia == pytest.approx(max(demands.values()), rel=1e-9)
    assert found.rim.spin_inertia == pytest.approx(found.spin_inertia, rel=1e-12)
    assert found.residual < 1e-9
    assert found.iterations < 50


def test_given_incidence_is_kept():
    found = size(asks(rate_change=1.0), incidence=0.7)
    assert found.incidence == 0.7
    assert {demand.incidence for demand in found.demands} == {0.7}


def test_given_spin_inertia_is_kept():
    found = size(asks(*MANEUVERS, spin_inertia=1.5e-4))
    assert found.spin_inertia == 1.5e-4
    assert max(demand.spin_inertia for demand in found.demands) > 1.5e-4


def test_a_maneuver_turned_by_hand_has_no_say_in_the_incidence():
    with_flip = size(asks(DROP, PUSH, BACK_FLIP, spin_inertia=1e-4), criterion="weighted")
    without = size(asks(DROP, PUSH, spin_inertia=1e-4), criterion="weighted")
    assert with_flip.incidence == without.incidence


def test_less_than_the_smallest_rim_gives_the_smallest_rim():
    found = size(asks(rate_change=1e-4))
    assert max(demand.spin_inertia for demand in found.demands) < found.spin_inertia
    assert found.rim.height == pytest.approx(ROOM.height_min, rel=1e-6)
    assert found.rim.inner_radius == pytest.approx(ROOM.inner_radius_min, rel=1e-6)
    assert found.rim.outer_radius - found.rim.inner_radius == pytest.approx(ROOM.wall_min, rel=1e-6)


def test_nothing_asked():
    with pytest.raises(UsageError, match="nothing is required"):
        size(asks())


@pytest.mark.slow
def test_infeasible_by_its_robot():
    """Each relaxation is verified by sizing anew, and none smaller would do."""
    envelope = replace(ROOM, outer_radius_max=0.03, mass_max=0.2)
    requirement = asks(*MANEUVERS)
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
        mended = problem.with_limit(by_name[name], value)
        size_device(mended)
        tighter = by_name[name].loosened(value, 1.0 / (1.0 + 3.0 * DEVICE_PRECISION))
        assert find_fixed_point(problem.with_limit(by_name[name], tighter)).shape is None


def test_a_given_spin_inertia_is_not_mended_by_wheel_speed():
    with pytest.raises(Infeasible) as caught:
        size(asks(rate_change=1.0, spin_inertia=1e-2))
    assert "wheel_speed_max" not in caught.value.relaxations
    assert caught.value.required_spin_inertia == 1e-2
    assert caught.value.message.startswith("No rim of steel")


@pytest.mark.parametrize(
    ("criterion", "axis"), [(Criterion.PITCH_ONLY, "roll"), (Criterion.ROLL_ONLY, "pitch")]
)
def test_axis_out_of_reach(criterion, axis):
    with pytest.raises(Infeasible, match=f"{axis} momentum") as caught:
        size(asks(rate_change=1.0), criterion=criterion)
    assert caught.value.binding == ("incidence",)
    assert np.isfinite(caught.value.required_spin_inertia)
