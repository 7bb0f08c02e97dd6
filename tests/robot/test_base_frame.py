"""A robot is the same robot, whichever way its trunk's frame points."""

import re
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from robots import ROBOTS, SOLO12
from urdf_text import inertial, joint, link
from urdf_text import robot as urdf_of

from ocs_design.robot.leg_geometry import BASE_FRAME, named_front
from ocs_design.robot.reader import read_robot

RIGHT = np.pi / 2.0
ROTATIONS = {"y up": f"{-RIGHT} 0 0", "x sideways": f"0 0 {-RIGHT}", "x up": f"0 {RIGHT} 0"}
"""Roll, pitch and yaw of the original root link in a root link with other axes."""


def rotated(folder, path, first, rpy):
    """The robot of a file below a new root link, in which its root `first` is rotated by `rpy`."""
    root = (
        f'<link name="new_root"/><joint name="rotated" type="fixed"><parent link="new_root"/>'
        f'<child link="{first}"/><origin rpy="{rpy}"/></joint></robot>'
    )
    file = folder / "rotated.urdf"
    file.write_text(path.read_text().replace("</robot>", root))
    return read_robot(file, package_paths={"example-robot-data": ROBOTS.parent})


@pytest.mark.parametrize("rpy", ROTATIONS.values(), ids=ROTATIONS)
def test_inertia_does_not_depend_on_the_trunks_frame(rpy, tmp_path):
    robot, rotated_robot = read_robot(SOLO12), rotated(tmp_path, SOLO12, "base_link", rpy)
    assert rotated_robot.trunk == BASE_FRAME
    assert rotated_robot.mount.link == "new_root"
    assert sum(BASE_FRAME in warning for warning in rotated_robot.warnings) == 1
    assert rotated_robot.standing_height == pytest.approx(robot.standing_height, abs=1e-6)
    # Front and back look alike; the names of the legs tell which is which.
    np.testing.assert_allclose(rotated_robot.inertia, robot.inertia, atol=1e-8)
    placements = rotated_robot.tree.placements_from(BASE_FRAME, rotated_robot.posture)
    ahead = {leg.name: placements[leg.body].position[0] > 0.0 for leg in rotated_robot.legs}
    assert ahead == {"FL_FOOT": True, "FR_FOOT": True, "HL_FOOT": False, "HR_FOOT": False}


SOLE = '<origin xyz="0 0 -0.14"/>'


SIDES = tuple(f"{side}{row}" for row in ("front", "middle", "rear") for side in "lr")
NUMBERS = tuple(map(str, range(1, 7)))


def hexapod(names=NUMBERS):
    """URDF of a hexapod: three legs on each side that reach out sideways; x is forward."""

    def hinge(name, parent, child, at, axis):
        limit = '<limit lower="-1.5" upper="1.5" effort="10" velocity="10"/>'
        return joint(name, parent, child, f'<origin xyz="{at}"/>', f'<axis xyz="{axis}"/>', limit)

    parts = [link("trunk", inertial(2.0, "0.01 0.01 0.02"))]
    for number, (x, side) in zip(names, product((0.13, 0.0, -0.13), (1.0, -1.0)), strict=True):
        coxa, femur, tibia = (f"leg{number}_{part}" for part in ("coxa", "femur", "tibia"))
        parts += [
            link(coxa, inertial(0.1, "2e-5 2e-5 2e-5")),
            link(femur, inertial(0.1, "9e-5 9e-5 9e-5", f"0 {0.05 * side} 0")),
            link(tibia, inertial(0.1, "9e-5 9e-5 9e-5", "0 0 -0.07")),
            link(f"leg{number}_foot"),
            hinge(f"swing{number}", "trunk", coxa, f"{x} {0.1 * side} 0", "0 0 1"),
            hinge(f"lift{number}", coxa, femur, f"0 {0.04 * side} 0", "1 0 0"),
            hinge(f"knee{number}", femur, tibia, f"0 {0.1 * side} 0", "1 0 0"),
            joint(f"sole{number}", tibia, f"leg{number}_foot", SOLE, kind="fixed"),
        ]
    return urdf_of(*parts)


@pytest.mark.parametrize("options", [{}, {"trunk": "trunk"}])
def test_sprawling_legs_leave_the_trunk_frame_as_it_is(tmp_path, options):
    path = tmp_path / "hexapod.urdf"
    path.write_bytes(hexapod())
    robot = read_robot(path, **options)
    assert len(robot.legs) == 6
    assert robot.mount is None
    assert not any("frame" in warning for warning in robot.warnings)
    # The feet are farther apart sideways than lengthways.
    assert robot.inertia[0, 0] > 1.2 * robot.inertia[1, 1]


@pytest.mark.parametrize("rpy", ROTATIONS.values(), ids=ROTATIONS)
def test_names_tell_which_way_sprawling_legs_walk(rpy, tmp_path):
    path = tmp_path / "hexapod.urdf"
    path.write_bytes(hexapod(SIDES))
    robot, rotated_robot = read_robot(path), rotated(tmp_path, path, "trunk", rpy)
    assert robot.mount is None
    assert rotated_robot.trunk == BASE_FRAME
    np.testing.assert_allclose(rotated_robot.inertia, robot.inertia, atol=1e-8)
    if rpy == ROTATIONS["x sideways"]:
        named = read_robot(tmp_path / "rotated.urdf", trunk="new_root")
        assert any("x of the trunk frame 'new_root'" in warning for warning in named.warnings)


@pytest.mark.parametrize(
    ("names", "front"),
    [
        (("A:FR12", "A:FL22", "A:BL32", "A:BR42"), 1.0),
        (("LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"), 1.0),
        (("hind_left", "hind_right", "front_left", "front_right"), -1.0),
        (("leg1", "leg2", "leg3", "leg4"), 0.0),
        (("left_forearm", "right_forearm", "flap", "brick"), 0.0),
    ],
)
def test_names_tell_front_from_back(names, front):
    solo12 = read_robot(SOLO12)
    legs = [replace(leg, name=name) for leg, name in zip(solo12.legs, names, strict=True)]
    hips = [np.array([x, y, 0.0]) for x in (0.2, -0.2) for y in (0.1, -0.1)]
    np.testing.assert_allclose(named_front(legs, hips), [0.4 * front, 0.0, 0.0], atol=1e-12)


def test_a_backward_x_axis_raises_a_warning(tmp_path):
    text = Path(SOLO12).read_text()
    swapped = {"FL_": "HL_", "FR_": "HR_", "HL_": "FL_", "HR_": "FR_"}
    path = tmp_path / "backwards.urdf"
    path.write_text(re.sub("|".join(swapped), lambda match: swapped[match[0]], text))
    assert any("point backwards" in warning for warning in read_robot(path).warnings)
    assert not any("point backwards" in warning for warning in read_robot(SOLO12).warnings)


def test_a_robot_with_y_up_stands_upright():
    robot = read_robot(next(ROBOTS.rglob("human.urdf")))
    assert robot.trunk == BASE_FRAME
    assert robot.mount.link == "middle_pelvis"
    np.testing.assert_array_equal(robot.mount.placement.rotation[:, 2], [0.0, 1.0, 0.0])
    # A standing human is slender: it turns most easily about the vertical.
    assert np.argmin(np.diag(robot.inertia)) == 2


def test_a_named_trunk_is_taken_as_it_is():
    robot = read_robot(next(ROBOTS.rglob("human.urdf")), trunk="middle_pelvis")
    assert robot.trunk == "middle_pelvis"
    assert robot.mount is None
    assert any("roll and pitch" in warning for warning in robot.warnings)


QUADRUPEDS = (
    "a1_description/urdf/a1.urdf",
    "anymal_b_simple_description/robots/anymal.urdf",
    "laikago_description/urdf/laikago.urdf",
)


@pytest.mark.parametrize("rpy", [ROTATIONS["y up"], ROTATIONS["x up"]], ids="yx")
@pytest.mark.parametrize("name", QUADRUPEDS, ids=lambda name: name.partition("_")[0])
def test_all_legs_are_found_whichever_axis_is_up(name, rpy, tmp_path):
    """Were z taken as up, two of the legs would seem to hang, by chance as long as the others."""
    robot = read_robot(ROBOTS / name)
    root = next(iter(robot.tree.bodies[0].links))
    rotated_robot = rotated(tmp_path, ROBOTS / name, root, rpy)
    assert [leg.name for leg in rotated_robot.legs] == [leg.name for leg in robot.legs]
    inertia = np.linalg.eigvalsh(robot.inertia)
    np.testing.assert_allclose(np.linalg.eigvalsh(rotated_robot.inertia), inertia, rtol=1e-6)
    # Roll, pitch and yaw axes are the same, with x forward or backward.
    np.testing.assert_allclose(np.diag(rotated_robot.inertia), np.diag(robot.inertia), rtol=1e-4)


def fixed(child, rpy, parent="new_root", xyz="0 0 0"):
    """A link fixed to another."""
    return (
        f'<link name="{child}"/><joint name="fix_{child}" type="fixed"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/></joint></robot>'
    )


DOWNWARDS = {
    "z down": f"{np.pi} 0 0",
    "y down": f"{RIGHT} 0 0",
    "camera": f"{RIGHT} {-RIGHT} 0",
    "x down": f"0 {-RIGHT} 0",
}


@pytest.mark.parametrize(
    "rpy", [*ROTATIONS.values(), *DOWNWARDS.values()], ids=[*ROTATIONS, *DOWNWARDS]
)
def test_a_named_link_with_z_up_settles_which_way_is_up(rpy, tmp_path):
    """This is the cure that the warnings about the trunk's frame name."""
    robot = read_robot(SOLO12)
    rotated(tmp_path, SOLO12, "base_link", rpy)
    file = tmp_path / "rotated.urdf"
    file.write_text(file.read_text().replace("</robot>", fixed("upright", rpy)))
    named = read_robot(file, trunk="upright", package_paths={"example-robot-data": ROBOTS.parent})
    assert [leg.name for leg in named.legs] == [leg.name for leg in robot.legs]
    assert named.recognition.sure
    assert named.standing_height == pytest.approx(robot.standing_height, abs=1e-6)
    np.testing.assert_allclose(named.inertia, robot.inertia, atol=1e-8)
    assert not any("--trunk" in warning for warning in named.warnings)


@pytest.mark.parametrize("rpy", [*DOWNWARDS.values()][1:], ids=[*DOWNWARDS][1:])
@pytest.mark.parametrize(
    "name",
    [*QUADRUPEDS, "simple_humanoid_description/urdf/simple_humanoid.urdf"],
    ids=lambda name: name.partition("_")[0],
)
def test_an_axis_along_which_all_legs_hang_is_down(rpy, name, tmp_path):
    """Two of four legs can stretch along the trunk, and would pass for those of a biped."""
    robot = read_robot(ROBOTS / name)
    root = next(iter(robot.tree.bodies[0].links))
    rotated_robot = rotated(tmp_path, ROBOTS / name, root, rpy)
    assert [leg.name for leg in rotated_robot.legs] == [leg.name for leg in robot.legs]
    assert rotated_robot.recognition.sure
    np.testing.assert_allclose(np.diag(rotated_robot.inertia), np.diag(robot.inertia), rtol=1e-4)


def test_legs_that_point_up_at_zero_raise_a_warning(tmp_path):
    robot = rotated(tmp_path, SOLO12, "base_link", DOWNWARDS["z down"])
    (warning,) = (warning for warning in robot.warnings if "if that is down" in warning)
    assert "at zero the legs point along +z" in warning
    assert "--trunk" in warning
    assert not any("if that is down" in warning for warning in read_robot(SOLO12).warnings)


@pytest.mark.parametrize("below", [0.2, 0.25, 0.3])
def test_a_root_on_the_ground_does_not_represent_the_trunk(below, tmp_path):
    file = tmp_path / "footprint.urdf"
    text = Path(SOLO12).read_text()
    root = (
        '<link name="base_footprint"/><joint name="up" type="fixed"><parent link="base_footprint"/>'
        f'<child link="base_link"/><origin xyz="0 0 {below}"/></joint></robot>'
    )
    file.write_text(text.replace("</robot>", root))
    paths = {"example-robot-data": ROBOTS.parent}
    robot, grounded = read_robot(SOLO12), read_robot(file, package_paths=paths)
    assert grounded.trunk == "base_link"
    assert grounded.floating_base == "base_footprint"
    assert grounded.standing_height == robot.standing_height
    np.testing.assert_allclose(grounded.com, robot.com, atol=1e-12)
    # What the user names is taken as it is.
    assert read_robot(file, trunk="base_footprint", package_paths=paths).trunk == "base_footprint"
