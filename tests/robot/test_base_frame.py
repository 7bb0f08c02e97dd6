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
TURNS = {
    "y up": f"{-RIGHT} 0 0",
    "x sideways": f"0 0 {-RIGHT}",
    "x up": f"0 {RIGHT} 0",
}
"""Roll, pitch and yaw of a robot's root in one whose axes lie otherwise."""


def turned(folder, path, first, rpy):
    """The robot of a file, whose root `first` hangs on another one that is turned against it."""
    root = (
        f'<link name="turned_root"/><joint name="turned" type="fixed"><parent link="turned_root"/>'
        f'<child link="{first}"/><origin rpy="{rpy}"/></joint></robot>'
    )
    file = folder / "turned.urdf"
    file.write_text(path.read_text().replace("</robot>", root))
    return read_robot(file, package_paths={"example-robot-data": ROBOTS.parent})


@pytest.mark.parametrize("rpy", TURNS.values(), ids=TURNS)
def test_inertia_does_not_depend_on_the_trunks_frame(rpy, tmp_path):
    robot, found = read_robot(SOLO12), turned(tmp_path, SOLO12, "base_link", rpy)
    assert found.trunk == BASE_FRAME
    assert found.mount.link == "turned_root"
    assert sum(BASE_FRAME in text for text in found.warnings) == 1
    assert found.standing_height == pytest.approx(robot.standing_height, abs=1e-6)
    # Front and back look alike, and are told by the legs' names.
    np.testing.assert_allclose(found.inertia, robot.inertia, atol=1e-8)
    placements = found.tree.placements_from(BASE_FRAME, found.posture)
    ahead = {leg.name: placements[leg.body].position[0] > 0.0 for leg in found.legs}
    assert ahead == {"FL_FOOT": True, "FR_FOOT": True, "HL_FOOT": False, "HR_FOOT": False}


SOLE = '<origin xyz="0 0 -0.14"/>'


def hexapod():
    """Three legs on each side that reach out sideways; x is forward."""

    def hinge(name, parent, child, at, axis):
        limit = '<limit lower="-1.5" upper="1.5" effort="10" velocity="10"/>'
        return joint(name, parent, child, f'<origin xyz="{at}"/>', f'<axis xyz="{axis}"/>', limit)

    parts = [link("trunk", inertial(2.0, "0.01 0.01 0.02"))]
    for number, (x, side) in enumerate(product((0.13, 0.0, -0.13), (1.0, -1.0)), 1):
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
def test_legs_that_sprawl_bend_about_the_way_ahead(tmp_path, options):
    path = tmp_path / "hexapod.urdf"
    path.write_bytes(hexapod())
    found = read_robot(path, **options)
    assert len(found.legs) == 6
    assert found.mount is None
    assert not any("frame" in text for text in found.warnings)
    # The feet are farther apart across the way than along it.
    assert found.inertia[0, 0] > 1.2 * found.inertia[1, 1]


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


def test_an_x_that_points_backwards_is_told(tmp_path):
    text = Path(SOLO12).read_text()
    ends = {"FL_": "HL_", "FR_": "HR_", "HL_": "FL_", "HR_": "FR_"}
    path = tmp_path / "backwards.urdf"
    path.write_text(re.sub("|".join(ends), lambda match: ends[match[0]], text))
    assert any("point backwards" in warning for warning in read_robot(path).warnings)
    assert not any("point backwards" in warning for warning in read_robot(SOLO12).warnings)


def test_a_usual_robot_keeps_its_trunk():
    robot = read_robot(SOLO12)
    assert robot.mount is None
    assert robot.trunk == "base_link"
    assert not any("base" in warning for warning in robot.warnings)


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


@pytest.mark.parametrize("rpy", [TURNS["y up"], TURNS["x up"]], ids="yx")
@pytest.mark.parametrize("name", QUADRUPEDS, ids=lambda name: name.partition("_")[0])
def test_all_legs_are_found_whichever_axis_is_up(name, rpy, tmp_path):
    """With z for up two legs of these hang by chance, which are as long as the other two."""
    robot = read_robot(ROBOTS / name)
    first = next(iter(robot.tree.bodies[0].links))
    again = turned(tmp_path, ROBOTS / name, first, rpy)
    assert [leg.name for leg in again.legs] == [leg.name for leg in robot.legs]
    inertia = np.linalg.eigvalsh(robot.inertia)
    np.testing.assert_allclose(np.linalg.eigvalsh(again.inertia), inertia, rtol=1e-6)
    # Roll, pitch and yaw are what they were, forward or backward.
    np.testing.assert_allclose(np.diag(again.inertia), np.diag(robot.inertia), rtol=1e-4)
