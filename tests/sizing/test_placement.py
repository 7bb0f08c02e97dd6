"""Where modules stand: as numbers, as arrays, as symbols."""

import numpy as np
import pytest

from ocs_design.parts.foot import base_radius
from ocs_design.parts.motor_mount import Behind
from ocs_design.robot.manual import robot_by_hand
from ocs_design.sizing.free_place import place_on_top
from ocs_design.sizing.place import CLEARANCE, Place, module_size, place_at, wheel_size

PLACE = Place(
    origins=((0.01, 0.02, 0.1), (0.01, -0.02, 0.1)),
    outward=((0.0, 1.1, 0.5), (0.0, -1.1, 0.5)),
    upright=True,
)


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


def test_arrays_as_numbers():
    outer, height = np.array([0.03, 0.05]), np.array([0.01, 0.02])
    arrays = PLACE.centers(wheel_size(outer, height))
    np.testing.assert_allclose(arrays, [PLACE(*size) for size in zip(outer, height, strict=True)])


def test_the_sphere_that_is_swept_holds_housing_and_motor():
    """Shell 3.6 mm outside the rim, the motor behind the foot's 5 mm."""
    flat = module_size(0.04, 0.004, Behind(0.0, 0.0), 0.0)
    assert flat.reach == pytest.approx(np.hypot(0.0436, 0.0052))
    long = module_size(0.04, 0.004, Behind(0.05, 0.02), 0.0)
    assert long.reach == pytest.approx(np.hypot(0.0052 + 0.005 + 0.05, 0.02))
    wide = module_size(0.01, 0.03, Behind(0.0, 0.0), 0.0)
    assert wide.reach == base_radius(0.01, 0.03, 0.0) > 0.04
    # Rim, shell, 2 mm of air, and the foot's base of 3 mm.
    assert (flat.standing, long.standing) == pytest.approx((0.0486, 0.0486))


def test_on_top_a_module_stands_on_its_foot():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    place = place_on_top(robot)
    size = module_size(0.04, 0.004, Behind(0.03, 0.02), 0.0)
    assert place.centers(size)[0, 2] - place.origins[0][2] == pytest.approx(size.standing)
