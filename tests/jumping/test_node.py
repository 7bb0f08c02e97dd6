import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from ocs_design.jumping.node import NODES, SHARES, STEPS, WEIGHTS, spline_slopes


def test_the_spline_is_scipys():
    values = np.random.default_rng(0).normal(size=(3, NODES))
    ends = ((1, np.zeros(3)), (2, np.zeros(3)))
    spline = CubicSpline(SHARES, values, axis=1, bc_type=ends)
    first, second = spline_slopes(values)
    np.testing.assert_allclose(first, spline(SHARES, 1), atol=1e-9)
    np.testing.assert_allclose(second, spline(SHARES, 2), atol=1e-8)


def test_the_nodes_fill_the_push_off_and_weigh_as_trapezoids():
    assert SHARES[-1] == pytest.approx(1.0)
    assert (np.diff(STEPS) < 0.0).all()
    assert pytest.approx(np.trapezoid(SHARES, SHARES)) == WEIGHTS @ SHARES
