"""Small programmes with known optima: vertices, bends, bounds, and what cannot be met."""

import numpy as np
import pytest

from ocs_design.sizing.sequential_programming import minimise

WIDE = np.full(2, np.inf)


def solve(value, limits, start, low=-WIDE, high=WIDE, trust=None):
    """Function and limits are of columns."""

    def evaluate(points):
        return value(*points.T), np.column_stack(limits(*points.T))

    start = np.asarray(start, dtype=float)
    return minimise(
        evaluate, start, low, high, np.full(start.size, 0.1) if trust is None else trust
    )


def test_two_limits_meet():
    found = solve(lambda x, y: x + 0.5 * y, lambda x, y: (x * y - 2.0, x - y * y), [3.0, 3.0])
    # x y = 2 and x = y^2: y^3 = 2.
    assert found.point == pytest.approx([2.0 ** (2.0 / 3.0), 2.0 ** (1.0 / 3.0)], rel=1e-12)
    assert found.violation <= 1e-12


def test_one_limit_bends():
    """Nearest to a line on a circle: nothing but the bend tells where to stop."""
    found = solve(lambda x, y: -(x + y), lambda x, y: (1.0 - x * x - y * y,), [0.9, -0.1])
    assert found.value == pytest.approx(-np.sqrt(2.0), rel=1e-10)
    assert found.violation <= 1e-10


def test_a_valley_without_limits():
    found = solve(
        lambda x, y: (x - 1.0) ** 2 + 3.0 * (y + 0.5) ** 2, lambda x, _: (x + 9.0,), [0, 0]
    )
    assert found.point == pytest.approx([1.0, -0.5], abs=1e-5)
    assert found.value == pytest.approx(0.0, abs=1e-10)


def test_bounds_and_held_variables_are_kept():
    low, high = np.array([0.0, -np.inf]), np.array([np.inf, np.inf])
    trust = np.array([0.1, 0.0])
    found = solve(
        lambda x, y: np.sqrt(x) + y, lambda x, _: (x + 1.0,), [2.0, 0.3], low, high, trust
    )
    assert found.point.tolist() == [0.0, 0.3]


def test_what_cannot_be_met_is_missed_by_the_least():
    found = solve(lambda x, y: y * y, lambda x, _: (x - 1.0, -x - 1.0), [5.0, 5.0])
    assert found.point[0] == pytest.approx(0.0, abs=1e-9)
    assert found.violation == pytest.approx(1.0, rel=1e-9)


def test_a_start_far_outside_the_limits_comes_back():
    found = solve(lambda x, y: x * x + y, lambda x, y: (y - np.exp(x), x - 0.2), [-3.0, -3.0])
    assert found.point == pytest.approx([0.2, np.exp(0.2)], rel=1e-10)
