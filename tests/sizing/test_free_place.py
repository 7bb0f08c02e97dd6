"""Places of modules: on synthetic robots and on all legged ones."""

import numpy as np
import pytest
from anatomy import LEGGED
from robots import ROBOTS
from subsets import slow_subset
from urdf_text import inertial, solid, topped

from ocs_design.parts.foot import Foot
from ocs_design.parts.housing import Housing
from ocs_design.parts.motor_mount import Behind
from ocs_design.requirement.froude import default_envelope
from ocs_design.robot.clearance import landing_ranges, sampled_postures
from ocs_design.robot.collision import collision_model
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.probe import Ball
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.free_place import Sizes, place_free, place_on_top, specified_place
from ocs_design.sizing.place import SPACING, Place, Size, module_size, place_at, wheel_size

ON_TOP = {
    "a1", "anymal", "anymal-kinova", "b1", "bolt", "go1", "go2", "hyq_no_sensors", "laikago",
    "quadruped", "simple_humanoid", "simple_humanoid_classical", "solo", "solo12",
}  # fmt: skip
"""Robots without obstacles above the trunk."""

BOX = inertial(10, "0.1 0.4 0.4") + solid('<box size="0.6 0.3 0.1"/>')
MAST = inertial(0.01, "1e-5 1e-5 1e-5") + solid('<cylinder radius="0.02" length="0.2"/>', "0 0 0.1")


@pytest.fixture
def robot_with_mast(tmp_path):
    def read(x):
        path = tmp_path / "robot_with_mast.urdf"
        path.write_bytes(topped(BOX, MAST, f"{x} 0 0.05"))
        return read_robot(path, trunk="base")

    return read


def test_a_distant_mast_does_not_matter(robot_with_mast):
    robot = robot_with_mast(0.28)
    free_place = place_free(robot, default_envelope(robot))
    assert (free_place.place, free_place.free) == (place_on_top(robot), True)


def test_a_mast_in_the_middle_is_between_the_modules(robot_with_mast):
    robot = robot_with_mast(0.0)
    envelope = default_envelope(robot)
    free_place = place_free(robot, envelope)
    assert (free_place.face, free_place.free) == ("on top of", True)
    # Spheres of 1.1 times the module's radius clear the mast, for every size.
    sizes = Sizes.of(envelope)
    for share in np.linspace(0.0, 1.0, 30):
        reach, standing = (1.0 - share) * np.array(sizes.smallest) + share * np.array(sizes.largest)
        x, y, _ = free_place.place.centers(Size(reach, standing))[0]
        assert np.hypot(x, y) - 0.02 >= SPACING * reach - 1e-5


def test_a_place_is_refined_between_grid_points(robot_with_mast):
    """In front of the mast or behind it: x^2 + (1.1 s)^2 = (1.1 s + r)^2 for the largest s."""
    robot = robot_with_mast(0.0)
    largest = Sizes.of(default_envelope(robot)).largest
    free_place = place_free(robot, default_envelope(robot))
    x, y, _ = free_place.place.origins[0]
    nearest = np.sqrt(2.0 * SPACING * largest.reach * 0.02 + 0.02**2)
    assert y == 0.0
    assert nearest - 1e-5 <= abs(x) <= nearest + 0.5 * largest.reach / 16.0


def test_a_specified_position_is_kept(robot_with_mast):
    robot = robot_with_mast(0.0)
    envelope = default_envelope(robot)
    assert specified_place((0.1, 0.2, 0.3), robot, envelope) == place_at((0.1, 0.2, 0.3))
    assert specified_place(None, robot, envelope) == place_free(robot, envelope).place


@pytest.mark.parametrize("name", slow_subset(20, LEGGED))
def test_every_legged_robot_has_a_free_place(name):
    robot = read_robot(ROBOTS / f"{name}.urdf")
    envelope = default_envelope(robot)
    free_place = place_free(robot, envelope)
    assert free_place.free
    assert (free_place.place == place_on_top(robot)) == (name.rpartition("/")[2] in ON_TOP)
    collision, size = collision_model(robot), Sizes.of(envelope).largest
    others = collision.limbs
    x, y, z = free_place.place.centers(size)[0]
    poses = collision.poses([{}, *sampled_postures(landing_ranges(robot), 1500)[512:]])
    for side in (y, -y):
        # Postures outside of the search do not reach the module itself either.
        ball = Ball(np.array([x, side, z]), size.reach)
        assert collision.nearest(ball, poses, others, within=0.0) is None


PLACE = Place(
    origins=((0.01, 0.02, 0.1), (0.01, -0.02, 0.1)),
    outward=((0.0, 1.1, 0.5), (0.0, -1.1, 0.5)),
    upright=True,
)


def test_on_top_the_modules_touch_neither_the_trunk_nor_each_other():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    centers = place_on_top(robot)(0.05, 0.02)
    reach = np.hypot(0.05, 0.01)
    assert np.linalg.norm(centers[0] - centers[1]) == pytest.approx(2.0 * SPACING * reach)
    assert centers[0, 0] == pytest.approx(robot.com[0], abs=1e-6)
    low = place_on_top(robot)(0.0, 0.0)[0, 2]
    assert centers[0, 2] - low == pytest.approx(SPACING * reach)


def test_a_specified_position_does_not_depend_on_the_size():
    np.testing.assert_array_equal(place_at((1, 2, 3))(0.05, 0.02), [[1, 2, 3], [1, -2, 3]])


def test_arrays_and_numbers_agree():
    outer, height = np.array([0.03, 0.05]), np.array([0.01, 0.02])
    arrays = PLACE.centers(wheel_size(outer, height))
    np.testing.assert_allclose(arrays, [PLACE(*size) for size in zip(outer, height, strict=True)])


def test_the_swept_sphere_encloses_housing_and_motor():
    """Shell 3.6 mm outside of the rim, motor behind the 5 mm plate of the foot."""
    flat = module_size(0.04, 0.004, Behind(0.0, 0.0), 0.0)
    assert flat.reach == pytest.approx(np.hypot(0.0436, 0.0052))
    long = module_size(0.04, 0.004, Behind(0.05, 0.02), 0.0)
    assert long.reach == pytest.approx(np.hypot(0.0052 + 0.005 + 0.05, 0.02))
    wide = module_size(0.01, 0.03, Behind(0.0, 0.0), 0.0)
    assert wide.reach == Foot(Housing(0.01, 0.03)).base_radius > 0.04
    # Rim, shell, 2 mm of clearance, and the foot's base of 3 mm.
    assert (flat.wheel_height, long.wheel_height) == pytest.approx((0.0486, 0.0486))


def test_on_top_a_module_stands_on_its_foot():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    place = place_on_top(robot)
    size = module_size(0.04, 0.004, Behind(0.03, 0.02), 0.0)
    assert place.centers(size)[0, 2] - place.origins[0][2] == pytest.approx(size.wheel_height)
