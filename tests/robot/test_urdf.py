"""Reading URDF: joints, shapes, colours, merged links, encodings and warnings."""

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from mass_oracles import assert_same_mass_properties, pinocchio_mass_properties
from urdf_text import LIMIT, TWO_LINKS, inertial, joint, link, robot

from ocs_design.common.errors import RobotError
from ocs_design.robot.tree import JointKind, ShapeKind, Tree
from ocs_design.robot.urdf import read_urdf


def read(content: bytes) -> Tree:
    return read_urdf(content, find_mesh=lambda _: None)


INF = np.inf


def joint_with(*inside: str, kind: str = "revolute"):
    content = robot(
        link("trunk", inertial()),
        link("leg", inertial()),
        joint("hip", "trunk", "leg", *inside, kind=kind),
    )
    tree = read(content)
    return tree.joints["hip"], tree


def test_a_joint_is_read_with_all_its_numbers():
    hip, tree = joint_with(
        LIMIT, '<axis xyz="0 3 4"/><dynamics damping="0.5" friction="0.25"/>', kind="prismatic"
    )
    assert hip.kind is JointKind.PRISMATIC
    np.testing.assert_allclose(hip.axis, [0, 0.6, 0.8])
    assert (hip.lower, hip.upper, hip.effort, hip.velocity) == (-1, 2, 3, 4)
    assert (hip.damping, hip.friction) == (0.5, 0.25)
    assert tree.warnings == ()


def chain_of_mimics(*mimics: str) -> Tree:
    names = [f"j{number}" for number in range(len(mimics))]
    return read(
        robot(
            link("trunk", inertial()),
            *(link(f"link_{name}", inertial()) for name in names),
            *(
                joint(name, "trunk", f"link_{name}", mimic, kind="continuous")
                for name, mimic in zip(names, mimics, strict=True)
            ),
        )
    )


def test_mimics_of_mimics_follow_the_leader():
    tree = chain_of_mimics(
        '<mimic joint="j1" multiplier="2" offset="1"/>',
        '<mimic joint="j2" multiplier="-3" offset="0.5"/>',
        "",
    )
    assert tree.joints["j0"].mimic == ("j2", -6.0, 2.0)
    assert tree.complete({"j2": 0.1}) == pytest.approx({"j2": 0.1, "j1": 0.2, "j0": 1.4})


@pytest.mark.parametrize("leader", ["nobody", "j0"])
def test_a_follower_without_leader_is_free_with_a_warning(leader):
    tree = chain_of_mimics(f'<mimic joint="{leader}"/>')
    assert tree.joints["j0"].mimic is None
    (warning,) = tree.warnings
    assert "j0" in warning


WORLD = (link("world"), link("trunk", inertial(2.0)), link("leg", inertial()))
HIP = joint("hip", "trunk", "leg", LIMIT)


def test_a_massless_world_fixed_to_the_base_is_part_of_the_base_as_in_pinocchio():
    content = robot(
        *WORLD, joint("mount", "world", "trunk", '<origin xyz="1 2 3"/>', kind="fixed"), HIP
    )
    tree = read(content)
    model = pin.buildModelFromXML(content.decode(), pin.JointModelFreeFlyer())
    assert tree.bodies[0].links.keys() == {"world", "trunk"}
    np.testing.assert_allclose(tree.bodies[0].mass_properties.com, model.inertias[1].lever)


def test_a_floating_joint_within_the_robot_is_held_with_a_warning():
    free = joint("free", "trunk", "load", kind="floating")
    tree = read(robot(link("trunk", inertial()), link("load", inertial()), free))
    assert len(tree.bodies) == 1
    assert any("free" in warning for warning in tree.warnings)


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_what_floats_under_a_massless_root_is_the_base(kind):
    tree = read(robot(*WORLD, joint("free", "world", "trunk", kind=kind), HIP))
    assert tree.bodies[0].name == "trunk"
    assert "world" not in tree.body_of_link
    assert tree.warnings == ()


ROTATED = (
    link(
        "trunk",
        inertial(2.0, "0.1 0.2 0.25").replace('"0 0 0"', '"0.1 0 0" quat_xyzw="0.2 0.4 0.1 -0.8"'),
    ),
    link("leg", inertial(1.0, "0.1 0.12 0.05")),
    joint("hip", "trunk", "leg", '<origin xyz="0 1 0" quat_xyzw="0.4 0 0 0.6"/>', LIMIT),
)


@pytest.mark.parametrize("version", ["1.0", "1.1"])
def test_quaternions_of_origins_rotate_as_in_pinocchio(version):
    content = robot(*ROTATED).replace(b"<robot", f'<robot version="{version}"'.encode())
    tree, model = read(content), pin.buildModelFromXML(content.decode(), pin.JointModelFreeFlyer())
    assert_same_mass_properties(
        tree.locked_mass_properties({}, "trunk"),
        pinocchio_mass_properties(model, pin.neutral(model)),
    )
    assert bool(tree.warnings) == (version == "1.0")


@pytest.mark.parametrize("attributes", ['quat_xyzw="0 0 0 1" rpy="0 0 0"', 'quat_xyzw="0 0 0 0"'])
def test_a_rotation_given_twice_or_without_axis_is_refused(attributes):
    content = robot(link("trunk", inertial().replace("<origin", f"<origin {attributes}")))
    with pytest.raises(RobotError, match="quat_xyzw"):
        read(content.replace(b"<robot", b'<robot version="1.1"'))


@pytest.mark.parametrize(
    ("limit", "kind", "expected", "warning"),
    [
        ('<limit lower="1" upper="-1"/>', "revolute", (-INF, INF, INF, INF), "hip"),
        (
            '<limit lower="-1" upper="1" effort="0" velocity="0"/>',
            "revolute",
            (-1, 1, INF, INF),
            "",
        ),
        (
            '<limit lower="-inf" upper="1" effort="inf" velocity="Infinity"/>',
            "revolute",
            (-INF, 1, INF, INF),
            "joints with an infinite <limit>, which ROS refuses: hip",
        ),
        ("", "revolute", (-INF, INF, INF, INF), "hip"),
        ("", "continuous", (-INF, INF, INF, INF), ""),
    ],
)
def test_void_limits_are_not_read_and_odd_ones_raise_a_warning(limit, kind, expected, warning):
    hip, tree = joint_with(limit, kind=kind)
    assert (hip.lower, hip.upper, hip.effort, hip.velocity) == expected
    assert [warning in text for text in tree.warnings] == [True] * bool(warning)


GEOMETRIES = {
    '<box size="2 4 6"/>': (ShapeKind.BOX, (1, 2, 3)),
    '<sphere radius="2"/>': (ShapeKind.SPHERE, (2,)),
    '<cylinder radius="2" length="6"/>': (ShapeKind.CYLINDER, (2, 3)),
    '<capsule radius="2" length="6"/>': (ShapeKind.CAPSULE, (2, 3)),
    '<mesh filename="a.stl" scale="1 -1 2"/>': (ShapeKind.MESH, (1, -1, 2)),
    '<mesh filename="a.stl"/>': (ShapeKind.MESH, (1, 1, 1)),
}


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("tag", ["visual", "collision"])
def test_shapes_are_placed_in_the_body(geometry, tag):
    shape_element = f'<{tag}><origin xyz="1 0 0"/><geometry>{geometry}</geometry></{tag}>'
    content = robot(
        link("trunk", inertial()),
        link("shell", shape_element),
        joint(
            "j",
            "trunk",
            "shell",
            '<origin xyz="0 0 5" rpy="0 0 1.5707963267948966"/>',
            kind="fixed",
        ),
    )
    tree = read_urdf(content, find_mesh=lambda name: Path("/meshes") / name)
    (shape,) = tree.bodies[0].shapes
    assert (shape.kind, shape.size) == GEOMETRIES[geometry]
    assert (shape.link, shape.collides) == ("shell", tag == "collision")
    assert shape.mesh == (Path("/meshes/a.stl") if shape.kind is ShapeKind.MESH else None)
    np.testing.assert_allclose(shape.position, [0, 1, 5], atol=1e-15)


def test_a_shape_of_no_extent_is_left_out_with_a_warning():
    box = '<collision><geometry><box size="0 1 1"/></geometry></collision>'
    tree = read(robot(link("trunk", inertial(), box)))
    assert tree.bodies[0].shapes == ()
    assert any("trunk" in warning for warning in tree.warnings)


SHELL = '<visual><geometry><sphere radius="1"/></geometry></visual>'


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((link("shell", SHELL), joint("j", "trunk", "shell", kind="fixed")), ("shell", "inertial")),
        ((link("foot"), joint("ankle", "trunk", "foot", LIMIT)), ("foot", "without mass")),
        (
            (link("arm", inertial(1.0, "0.1 0.1 0.5")), joint("j", "trunk", "arm", LIMIT)),
            ("arm", "triangle"),
        ),
    ],
    ids=["a shape without inertial", "a moving end without mass", "an impossible body"],
)
def test_implausible_links_raise_a_warning(parts, words):
    (warning,) = read(robot(link("trunk", inertial(5.0, "1 1 1")), *parts)).warnings
    assert all(word in warning for word in words)


def test_an_impossible_link_within_a_plausible_body_raises_none():
    content = robot(
        link("trunk", inertial(5.0, "1 1 1")),
        link("dummy", inertial(0.001, "0 0 0.001")),
        joint("j", "trunk", "dummy", kind="fixed"),
    )
    assert read(content).warnings == ()


def test_thousands_of_links_in_a_chain_are_read():
    count = 1_999
    tree = read(
        robot(
            *(link(f"l{i}", inertial(0.001)) for i in range(count)),
            *(joint(f"j{i}", f"l{i}", f"l{i + 1}", LIMIT) for i in range(count - 1)),
        )
    )
    assert len(tree.bodies) == count
    assert tree.locked_mass_properties({}, "l0").mass == pytest.approx(count * 0.001)


LATIN = TWO_LINKS.replace(b'"leg"', '"J\xf6rg"'.encode("latin-1"))


@pytest.mark.parametrize(
    ("content", "warned"),
    [
        (LATIN, True),
        (b'<?xml version="1.0"?>' + LATIN, True),
        (b'<?xml version="1.0" encoding="UTF-8"?>' + LATIN, True),
        (b'<?xml version="1.0" encoding="ISO-8859-1"?>' + LATIN, False),
        (LATIN.decode("latin-1").encode("utf-8-sig"), False),
        (LATIN.decode("latin-1").encode("utf-16"), False),
    ],
    ids=["bare", "undeclared", "wrong", "declared Latin-1", "byte order mark", "UTF-16"],
)
def test_latin_1_is_read_with_a_warning_where_it_is_not_declared(content, warned):
    tree = read(content)
    assert "J\xf6rg" in tree.body_of_link
    assert ["Windows-1252" in warning for warning in tree.warnings] == [True] * warned


def test_a_default_namespace_does_not_matter():
    tree = read(TWO_LINKS.replace(b"<robot ", b'<robot xmlns="http://www.ros.org" '))
    assert set(tree.joints) == {"hip"}


@pytest.mark.parametrize("above", [b"\n\n", b"<!-- a licence -->\n", b"<!-- a -->\n<!-- b -->"])
def test_a_declaration_that_is_not_first_is_ignored_with_a_warning(above):
    declared = b'<?xml version="1.0"?>\n'
    assert read(declared + TWO_LINKS).warnings == read(TWO_LINKS).warnings
    late = read(above + declared + TWO_LINKS)
    assert len(late.bodies) == len(read(TWO_LINKS).bodies)
    (warning,) = set(late.warnings) - set(read(TWO_LINKS).warnings)
    assert "declaration is not the first" in warning


BALL = '<geometry><sphere radius="1"/></geometry>'
STEEL = '<material name="steel"><color rgba="0.5 0.5 0.6 1"/></material>'


@pytest.mark.parametrize(
    ("material", "color"),
    [
        ("", None),
        ('<material name="steel"/>', (0.5, 0.5, 0.6, 1.0)),
        ('<material name="own"><color rgba="1 0 0 0.5"/></material>', (1.0, 0.0, 0.0, 0.5)),
        ('<material name="nowhere"/>', None),
        ('<material name="odd"><color rgba="red"/></material>', None),
        ('<material name="odd"><color rgba="255 0 0 1"/></material>', None),
        ('<material name="odd"><color rgba="nan 0 0 1"/></material>', None),
    ],
)
def test_color_of_a_visual(material, color):
    shapes = f"<visual>{BALL}{material}</visual><collision>{BALL}</collision>"
    visual, collision = read(robot(STEEL, link("base", inertial(), shapes))).bodies[0].shapes
    assert visual.color == color
    assert collision.color is None
