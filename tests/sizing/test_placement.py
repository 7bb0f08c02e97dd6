"""Where modules stand: as numbers, as arrays, as symbols."""

import casadi
import numpy as np
import pytest

from ocs_design.robot.manual import robot_by_hand
from ocs_design.sizing.placement import CLEARANCE, Place, place_at, place_on_top

PLACE = Place(origin=(0.01, 0.02, 0.1), outward=(0.0, 1.1, 0.5))


def test_on_top_the_modules_touch_neither_the_trunk_nor_each_other():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    centers = place_on_top(robot)(0.05, 0.02)
    reach = np.hypot(0.05, 0.01)
    assert np.linalg.norm(centers[0] - centers[1]) == pytest.approx(2.0 * CLEARANCE * reach)
    assert centers[0, 0] == pytest.approx(robot.com[0], abs=1e-6)
    low = place_on_top(robot)(0.0, 0.0)[0, 2]
    assert centers[0, 2] - low == pytest.approx(CLEARANCE * reach)


def test_at_a_stated_position_nothing_moves():
    np.testing.assert_array_equal(place_at((1, 2, 3))(0.05, 0.02), [[1, 2, 3], [1, -2, 3]])


def test_arrays_and_symbols_as_numbers():
    outer, height = np.array([0.03, 0.05]), np.array([0.01, 0.02])
    arrays = np.stack(np.broadcast_arrays(*PLACE.left(outer, height)), axis=-1)
    np.testing.assert_allclose(
        arrays, [PLACE(*size)[0] for size in zip(outer, height, strict=True)]
    )
    R, h = casadi.SX.sym("R"), casadi.SX.sym("h")
    symbols = casadi.Function("left", [R, h], [casadi.vertcat(*PLACE.left(R, h))])
    np.testing.assert_allclose(symbols(0.03, 0.01).full()[:, 0], PLACE(0.03, 0.01)[0])
