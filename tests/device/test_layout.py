"""The incidence angle against worked examples and brute force."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.device.layout import (
    PAIR,
    Criterion,
    heading_drift,
    incidence_by_criterion,
    module_axes,
)

ANGLE = st.floats(0.0, 0.5 * np.pi)
STANCE = np.diag([0.0300029, 0.0514912, 0.0680453])
ZERO_JOINTS = np.diag([0.0367786, 0.0705134, 0.0802918])
MOMENTUM = st.floats(0.1, 10.0)


def required_wheel_momentum(momenta, incidence):
    """Momentum that each wheel needs, by solving for two wheels directly."""
    axes = PAIR.axes(incidence)[..., :2, :]
    return np.abs(np.linalg.solve(axes, np.asarray(momenta)[:, None])).max(axis=(-2, -1))


def test_solo12_equal_rate():
    assert np.degrees(incidence_by_criterion(STANCE)[Criterion.EQUAL_RATE]) == pytest.approx(
        30.228, abs=1e-3
    )
    at_zero = incidence_by_criterion(ZERO_JOINTS)[Criterion.EQUAL_RATE]
    assert np.degrees(at_zero) == pytest.approx(27.546, abs=1e-3)


def test_solo12_simultaneous():
    for momenta in (None, 2.0 * np.diag(STANCE)[:2]):
        angle = incidence_by_criterion(STANCE, momenta)[Criterion.SIMULTANEOUS]
        assert np.degrees(angle) == pytest.approx(39.87, abs=5e-3)


def test_weighted_includes_the_criterion_of_the_paper():
    incidences = incidence_by_criterion(STANCE, 3.0 * np.diag(STANCE)[:2])
    expected = incidences[Criterion.EQUAL_RATE]
    assert incidences[Criterion.WEIGHTED] == pytest.approx(expected, rel=1e-15)


def test_single_axes():
    incidences = incidence_by_criterion(STANCE, np.array([0.1, 0.2]))
    assert incidences[Criterion.PITCH_ONLY] == 0.0
    assert incidences[Criterion.ROLL_ONLY] == np.pi / 2.0
    for axis, expected in ((0, np.pi / 2.0), (1, 0.0)):
        one_axis = incidence_by_criterion(STANCE, np.eye(2)[axis])
        assert one_axis[Criterion.WEIGHTED] == expected
        assert one_axis[Criterion.SIMULTANEOUS] == expected


def test_zero_momenta_count_as_none():
    assert incidence_by_criterion(STANCE, np.zeros(2)) == incidence_by_criterion(STANCE)


@given(MOMENTUM, MOMENTUM)
def test_equal_rate_and_weighted_treat_both_axes_alike(roll, pitch):
    angle = incidence_by_criterion(STANCE, np.array([roll, pitch]))[Criterion.WEIGHTED]
    assert roll / np.sin(angle) == pytest.approx(pitch / np.cos(angle), rel=1e-12)


@pytest.mark.parametrize("momenta", [(1.0, 1.0), (0.02, 0.9), (5.0, 0.3), (0.06, 0.103)])
def test_simultaneous_is_the_least_over_all_angles(momenta):
    grid = np.linspace(1e-4, np.pi / 2.0 - 1e-4, 5001)
    by_grid = required_wheel_momentum(momenta, grid)
    best = incidence_by_criterion(STANCE, np.array(momenta))[Criterion.SIMULTANEOUS]
    at_best = required_wheel_momentum(momenta, best)
    assert at_best <= by_grid.min() * (1.0 + 1e-12)
    assert at_best == pytest.approx(by_grid.min(), rel=1e-6)
    assert abs(grid[by_grid.argmin()] - best) < 2.0 * (grid[1] - grid[0])
    astroid = (np.abs(momenta) ** (2.0 / 3.0)).sum() ** 1.5 / 2.0
    assert astroid == pytest.approx(at_best, rel=1e-12)


def test_axes_are_unit_and_mirrored():
    axes = module_axes(0.7)
    assert np.linalg.norm(axes, axis=0) == pytest.approx(1.0, rel=1e-15)
    assert axes[:, 0] * [-1.0, 1.0, 1.0] == pytest.approx(axes[:, 1])


def test_heading_drift_keeps_yaw_momentum_zero():
    inertia = np.array([[0.03, 0.001, 0.002], [0.001, 0.05, -0.003], [0.002, -0.003, 0.07]])
    drift = heading_drift(inertia)
    for axis in range(2):
        rate = np.zeros(3)
        rate[axis], rate[2] = 1.0, drift[axis]
        assert (inertia @ rate)[2] == pytest.approx(0.0, abs=1e-17)


@given(ANGLE, st.floats(-0.1, 0.1))
def test_a_pair_turned_on_its_feet_is_one_at_another_incidence(incidence, error):
    axes = PAIR.axes(incidence)
    rotations = Rotation.from_rotvec(error * PAIR.feet(axes).T).as_matrix()
    rotated = np.einsum("kij,jk->ik", rotations, axes)
    np.testing.assert_allclose(rotated, PAIR.axes(incidence + error), atol=1e-12)
