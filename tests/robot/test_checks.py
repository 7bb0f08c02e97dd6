"""Faults planted one by one in a sound robot: each raises a warning that names the link."""

import re
import time
from contextlib import suppress
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from commands import run
from robots import SOLO12
from urdf_text import inertial, joint, link, robot

from ocs_design.common.errors import RobotError
from ocs_design.robot.checks import plausibility_warnings
from ocs_design.robot.reader import read_robot

TRUNK, THIGH, SHANK = (0.4, 0.2, 0.1), (0.03, 0.04, 0.16), (0.02, 0.02, 0.16)


def box(name, mass, sides, centre=(0.0, 0.0, 0.0), shape=""):
    """A link with a homogeneous box: I_x = m (b^2 + c^2) / 12."""
    moments = [mass * (sum(s * s for s in sides) - sides[i] ** 2) / 12 for i in range(3)]
    at = f'<origin xyz="{words(centre)}" rpy="0 0 0"/>'
    filled = f'<collision>{at}<geometry><box size="{words(sides)}"/></geometry></collision>'
    return link(name, inertial(mass, words(moments), words(centre)), filled, shape)


def hinge(name, parent, child, at, axis, limits='lower="-1.5" upper="1.5"'):
    place = f'<origin xyz="{words(at)}" rpy="0 0 0"/><axis xyz="{words(axis)}"/>'
    limit = f'<limit {limits} effort="3" velocity="20"/>'
    return joint(name, parent, child, place, limit, kind="revolute" if limits else "continuous")


def words(numbers):
    return " ".join(map(str, numbers))


def leg(name, x, y):
    foot = '<collision><origin xyz="0 0 -0.16"/><geometry><sphere radius="0.01"/></geometry>'
    foot += "</collision>"
    side = np.sign(y)
    return (
        box(f"{name}_hip", 0.3, (0.06, 0.05, 0.05), (0.0, 0.01 * side, 0.0))
        + box(f"{name}_thigh", 0.3, THIGH, (0.0, 0.0, -0.08))
        + box(f"{name}_shank", 0.1, SHANK, (0.0, 0.0, -0.08), foot)
        + hinge(f"{name}_roll", "trunk", f"{name}_hip", (x, y, 0), (1, 0, 0))
        + hinge(f"{name}_pitch", f"{name}_hip", f"{name}_thigh", (0, 0.05 * side, 0), (0, 1, 0))
        + hinge(f"{name}_knee", f"{name}_thigh", f"{name}_shank", (0, 0, -0.16), (0, 1, 0))
    )


WHEEL = link(
    "lidar",
    inertial(0.2, "5e-5 5e-5 9e-5"),
    '<visual><geometry><cylinder radius="0.03" length="0.02"/></geometry></visual>',
)


def quadruped():
    """A robot without faults, as XML."""
    spin = hinge("spin", "trunk", "lidar", (0, 0, 0.08), (0, 0, 1), "")
    legs = [
        leg(f"{a}{b}", x, y)
        for a, x in (("F", 0.2), ("H", -0.2))
        for b, y in (("L", 0.1), ("R", -0.1))
    ]
    return ET.fromstring(robot(box("trunk", 3.0, TRUNK), *legs, WHEEL, spin))


def scaled(root, tag, factor, of=".*", attributes=None):
    """Multiply the numbers of all elements `tag` in links and joints whose name matches `of`."""
    for part in root:
        for element in part.iter(tag) if re.fullmatch(of, part.get("name")) else ():
            for name in attributes or element.keys():
                numbers = [factor * float(word) for word in element.get(name).split()]
                element.set(name, words(numbers))


def set_in(root, part, tag, **attributes):
    """Set attributes of the first element `tag` of one link or joint."""
    element = next(element for element in root if element.get("name") == part)
    next(element.iter(tag)).attrib.update({name: str(value) for name, value in attributes.items()})


def swap(root, link, one, other):
    """Write one moment of a link in place of another."""
    inertia = next(part for part in root if part.get("name") == link).find("inertial/inertia")
    set_in(root, link, "inertia", **{one: inertia.get(other), other: inertia.get(one)})


def about_origin(root, name):
    """Move a link's inertia to the link's origin: add Steiner's term of its centre of mass."""
    element = next(part for part in root if part.get("name") == name)
    x, y, z = map(float, element.find("inertial/origin").get("xyz").split())
    mass = float(element.find("inertial/mass").get("value"))
    inertia = element.find("inertial/inertia")
    for axis, square in (("xx", y * y + z * z), ("yy", x * x + z * z), ("zz", x * x + y * y)):
        inertia.set(f"i{axis}", str(float(inertia.get(f"i{axis}")) + mass * square))


def in_millimetres(root):
    for tag, names in (("origin", ["xyz"]), ("box", None), ("sphere", None), ("cylinder", None)):
        scaled(root, tag, 1e3, attributes=names)


# Each fault: a change to the robot, words of the warning, and the link or joint that it names.
FAULTS = {
    "a wheel's moments swapped": (
        lambda r: swap(r, "lidar", "ixx", "izz"), "round about their joint", "lidar"),
    "a wheel's inertia turned by 45 degrees": (
        lambda r: set_in(r, "lidar", "inertia", ixx=7e-5, izz=7e-5, ixz=2e-5),
        "round about their joint", "lidar"),
    "a long link's moments swapped": (
        lambda r: swap(r, "FL_shank", "ixx", "izz"), "does not match their shapes", "FL_shank"),
    "a link's inertia turned by its rpy": (
        lambda r: set_in(r, "HR_thigh", "origin", rpy="0 1.5708 0"),
        "does not match their shapes", "HR_thigh"),
    "an inertia in kg mm2": (
        lambda r: scaled(r, "inertia", 1e6, "trunk"), "more inertia than their", "trunk"),
    "an inertia in kg cm2": (
        lambda r: scaled(r, "inertia", 1e4, "HL_hip"), "more inertia than their", "HL_hip"),
    "an inertia in g m2": (
        lambda r: scaled(r, "inertia", 1e3, "FR_thigh"), "more inertia than their", "FR_thigh"),
    "an exporter's placeholder": (
        lambda r: set_in(r, "FL_hip", "inertia", ixx=1, iyy=1, izz=1),
        "more inertia than their", "FL_hip"),
    "an inertia of a density of 1": (
        lambda r: scaled(r, "inertia", 1e-3, "trunk"), "too little inertia", "trunk"),
    "every inertia a hundredth": (
        lambda r: scaled(r, "inertia", 1e-2), "too little inertia", "and 10 more"),
    "an inertia about the link's origin": (
        lambda r: about_origin(r, "FL_thigh"), "about their origin", "FL_thigh"),
    "every mass and inertia in grams": (
        lambda r: (scaled(r, "mass", 1e3), scaled(r, "inertia", 1e3)),
        "the robot weighs .* as dense as solid metal", ""),
    "one mass in grams": (
        lambda r: scaled(r, "mass", 1e3, "FL_shank"), "shapes in steel", "FL_shank"),
    "every mass in tonnes": (
        lambda r: (scaled(r, "mass", 1e-3), scaled(r, "inertia", 1e-3)),
        "the robot weighs .* as light as air", ""),
    "one mass in tonnes": (
        lambda r: scaled(r, "mass", 1e-3, "HL_thigh"), "more inertia than their", "HL_thigh"),
    "every length in millimetres": (in_millimetres, "lighter than the air", "trunk"),
    "a shape without its scale": (
        lambda r: scaled(r, "box", 1e3, "FR_hip"), "lighter than the air", "FR_hip"),
    "joints in millimetres": (
        lambda r: scaled(r, "origin", 1e3, ".*_(roll|pitch|knee)", ["xyz"]),
        "the robot weighs .* as light as air", ""),
    "a centre of mass in millimetres": (
        lambda r: set_in(r, "HL_thigh", "origin", xyz="0 0 -80"), "centre of mass is outside",
        "HL_thigh"),
    "a centre of mass on the wrong side": (
        lambda r: set_in(r, "HL_shank", "origin", xyz="0 0 0.08"), "centre of mass is outside",
        "HL_shank"),
    "a leg heavier than its twin": (
        lambda r: scaled(r, "mass", 1.1, "FL_thigh"), "differ in mass", "FL_thigh, FR_thigh"),
    "a centre of mass copied without mirroring": (
        lambda r: set_in(r, "FR_hip", "origin", xyz="0 0.01 0"),
        "centre of mass does not mirror", "FL_hip, FR_hip"),
    "a product of inertia copied without mirroring": (
        lambda r: [set_in(r, f"F{side}_hip", "inertia", ixy="3e-5") for side in "LR"],
        "inertia does not mirror", "FL_hip, FR_hip"),
    "a leg without inertia": (
        lambda r: scaled(r, "inertia", 0.0, "HR_thigh"), "inertia does not mirror",
        "HL_thigh, HR_thigh"),
    "a hip out of its place": (
        lambda r: set_in(r, "HR_roll", "origin", xyz="-0.21 -0.1 0"),
        "joints that do not mirror", "HL_hip, HR_hip"),
    "a joint range of one side": (
        lambda r: set_in(r, "HR_knee", "limit", upper="1.2"), "range, effort or speed", "HR_shank"),
    "a motor of one side": (
        lambda r: set_in(r, "FL_roll", "limit", effort="30"), "range, effort or speed", "FL_hip"),
    "a placeholder for an effort": (
        lambda r: set_in(r, "HR_knee", "limit", effort="1000"), "efforts over 10", "HR_knee"),
    "limits in degrees": (
        lambda r: [set_in(r, f"{leg}_knee", "limit", lower="-90", upper="90")
                   for leg in ("FL", "FR", "HL", "HR")], "limits in degrees", "FL_knee"),
    "a placement turned by degrees": (
        lambda r: set_in(r, "FL_knee", "origin", rpy="0 0 180"), "angles in degrees", "FL_knee"),
}  # fmt: skip


def read(root, folder, **options):
    path = folder / "robot.urdf"
    path.write_bytes(ET.tostring(root))
    return read_robot(path, **options)


def test_a_sound_robot_raises_no_warning(tmp_path):
    assert read(quadruped(), tmp_path).warnings == ()


@pytest.mark.parametrize(("plant", "words", "where"), FAULTS.values(), ids=FAULTS)
def test_a_planted_fault_raises_a_warning(tmp_path, plant, words, where):
    root = quadruped()
    plant(root)
    warnings = read(root, tmp_path).warnings
    assert any(re.search(f"{words}.*{where}", warning) for warning in warnings), warnings


def test_one_warning_names_all_links_with_the_same_fault(tmp_path):
    root = quadruped()
    scaled(root, "inertia", 1e6, ".*_hip")
    (warning,) = (text for text in read(root, tmp_path).warnings if "more inertia" in text)
    assert all(f"{leg}_hip (" in warning for leg in ("FL", "FR", "HL", "HR"))


def test_a_posture_outside_the_limits_and_a_foot_in_the_air(tmp_path):
    warnings = read(quadruped(), tmp_path, joints={"FL_knee": 2.0}).warnings
    assert "the posture is outside the limits of: FL_knee" in warnings
    assert any(
        re.search("foot 'FL_shank' is .* mm above the ground", warning) for warning in warnings
    )


def test_strict_makes_a_warning_fatal(tmp_path):
    root = quadruped()
    swap(root, "lidar", "ixx", "izz")
    read(root, tmp_path)
    command = ("inspect", tmp_path / "robot.urdf")
    assert run(*command).code == 0
    refused = run(*command, "--strict")
    assert refused.code == 3
    assert "round about their joint" in refused.output


def test_solo12_has_only_implausible_efforts_and_is_checked_quickly():
    robot = read_robot(SOLO12)
    checked = (robot.tree, robot.trunk, robot.legs, robot.posture, robot.mass_properties)
    start = time.process_time()
    (warning,) = plausibility_warnings(*checked)
    assert "efforts over 10 times weight" in warning, "the public file states 1000 N m"
    assert time.process_time() - start < 0.1


@pytest.mark.parametrize("factor", [1e-300, 1e-75, 1e60])
@pytest.mark.parametrize("tag", ["mass", "inertia", "box"])
def test_extreme_numbers_raise_no_arithmetic_warning(tmp_path, tag, factor):
    root = quadruped()
    scaled(root, tag, factor)
    with suppress(RobotError):
        assert read(root, tmp_path).name == "test"


@pytest.mark.parametrize("aside", [0.03, -0.15])
def test_a_trunk_frame_beside_the_middle_is_named_instead_of_its_legs(tmp_path, aside):
    root = quadruped()
    shift = ET.SubElement(root, "joint", name="aside", type="fixed")
    ET.SubElement(root, "link", name="imu")
    ET.SubElement(shift, "parent", link="imu")
    ET.SubElement(shift, "child", link="trunk")
    ET.SubElement(shift, "origin", xyz=f"0 {aside} 0")
    (warning,) = read(root, tmp_path).warnings
    side = "right" if aside > 0.0 else "left"
    assert f"'imu' is {1e3 * abs(aside):.0f} mm {side} of the middle between the legs" in warning
    # The cure that it names.
    assert read(root, tmp_path, trunk="trunk").warnings == ()


def test_inertias_in_another_unit_are_named_for_a_robot_as_light_as_air(tmp_path):
    root = quadruped()
    scaled(root, "inertia", 1e9)
    assert any(
        re.search("as light as air.*inertias in g mm2", warning)
        for warning in read(root, tmp_path).warnings
    )
