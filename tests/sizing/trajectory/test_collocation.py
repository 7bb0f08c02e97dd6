"""Radau collocation and Bernstein polynomials against exact integrals and derivatives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial
from scipy.integrate import quad

from ocs_design.sizing.trajectory import collocation as table
from ocs_design.sizing.trajectory.collocation import (
    DEGREE,
    bernstein_basis,
    bernstein_product,
    radau_points,
)
from ocs_design.sizing.trajectory.motion import Motion

CUBIC = Polynomial([0.3, -1.2, 2.5, -0.7])
PARABOLA = Polynomial([0.4, -2.0, 1.1])
S = np.linspace(0.0, 1.0, 41)


def test_three_radau_points_are_those_of_the_literature():
    """Hairer and Wanner, Solving Ordinary Differential Equations II, table IV.5.6."""
    root = np.sqrt(6.0)
    np.testing.assert_allclose(
        radau_points(3), [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0], rtol=1e-14
    )


def test_derivative_and_bernstein_form_of_a_cubic_are_exact():
    values = CUBIC(table.NODES)
    np.testing.assert_allclose(
        table.DERIVATIVE @ values, CUBIC.deriv()(table.NODES[1:]), rtol=1e-12
    )
    np.testing.assert_allclose(
        bernstein_basis(S, DEGREE) @ (table.BERNSTEIN @ values), CUBIC(S), rtol=1e-12
    )


def test_radau_quadrature_is_exact_to_the_fourth_power():
    for power in range(2 * DEGREE - 1):
        assert table.WEIGHTS @ table.NODES[1:] ** power == pytest.approx(1.0 / (power + 1))


def test_torques_at_nodes_elevated_and_squared_are_exact():
    middle = 2.0 * PARABOLA(0.5) - (PARABOLA(0.0) + PARABOLA(1.0)) / 2.0
    coefficients = np.array([PARABOLA(0.0), middle, PARABOLA(1.0)])
    np.testing.assert_allclose(table.TORQUE @ coefficients, PARABOLA(table.NODES[1:]), rtol=1e-12)
    elevated = bernstein_basis(S, DEGREE) @ (table.ELEVATION @ coefficients)
    np.testing.assert_allclose(elevated, PARABOLA(S), rtol=1e-12)
    square = quad(lambda s: PARABOLA(s) ** 2, 0.0, 1.0)[0]
    assert coefficients @ table.SQUARE @ coefficients == pytest.approx(square)


@given(arrays(np.float64, DEGREE + 1, elements=st.floats(-10.0, 10.0)))
def test_a_polynomial_lies_between_its_bernstein_coefficients(values):
    coefficients = table.BERNSTEIN @ values
    polynomial = bernstein_basis(S, DEGREE) @ coefficients
    assert polynomial.min() >= coefficients.min() - 1e-9
    assert polynomial.max() <= coefficients.max() + 1e-9


def _motion(torque, intervals):
    """A motion whose torques are a parabola over 2 s; its states are cubics."""
    lengths = np.full(intervals, 2.0 / intervals)
    starts = np.append(0.0, np.cumsum(lengths)[:-1])[:, None]
    nodes = np.append(0.0, (starts + lengths[:, None] * table.NODES[1:]).ravel())
    first, middle, last = (torque(starts + part * lengths[:, None]) for part in (0.0, 0.5, 1.0))
    torques = np.hstack([first, 2.0 * middle - (first + last) / 2.0, last]).ravel()
    return Motion(lengths, np.tile(CUBIC(nodes), (6, 1)), np.tile(torques, (2, 1)))


def test_a_polynomial_motion_is_kept_on_other_intervals():
    motion = _motion(PARABOLA, 5)
    lengths = np.array([0.3, 0.5, 0.1, 1.1])
    moved = motion.on_intervals(lengths)
    times = np.linspace(0.0, 2.0, 57)
    np.testing.assert_allclose(moved.state_at(times)[3], CUBIC(times), rtol=1e-10)
    np.testing.assert_allclose(moved.torque_at(times)[1], PARABOLA(times), rtol=0, atol=1e-5)
    within = moved.torque_within(np.array([0.0, 0.5]))
    middles = moved.starts + np.array([0.0, 0.5])[:, None] * lengths
    np.testing.assert_allclose(within[:, 0], PARABOLA(middles.T.ravel()), rtol=0, atol=1e-5)


def test_refinement_shortens_intervals_where_torques_switch():
    motion = _motion(lambda time: np.where(time < 1.21, 1.0, -1.0), 10)
    lengths = motion.refined(20).lengths
    middles = np.cumsum(lengths) - lengths / 2.0
    assert lengths.sum() == pytest.approx(2.0)
    assert lengths[np.argmin(np.abs(middles - 1.25))] < 0.3 * lengths.mean()
    # Where nothing changes only the uniform share of the intervals remains.
    assert lengths.max() < 2.0 / 20 / 0.39


@given(*2 * [arrays(float, DEGREE + 1, elements=st.floats(-10.0, 10.0))])
def test_a_product_in_bernstein_form_is_the_product(one, other):
    coefficients = [
        sum(share * one[i] * other[k - i] for i, share in row)
        for k, row in enumerate(bernstein_product(DEGREE))
    ]
    basis = bernstein_basis(S, DEGREE)
    np.testing.assert_allclose(
        bernstein_basis(S, 2 * DEGREE) @ coefficients, basis @ one * (basis @ other), atol=1e-10
    )
