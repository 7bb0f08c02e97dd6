"""Each kind of bad robot file raises an error that names the place and the cure."""

import gzip
from pathlib import Path

import pytest
from urdf_text import LIMIT, TWO_LINKS, inertial, joint, link, robot

from ocs_design.common.errors import RobotError
from ocs_design.robot.links import Warnings
from ocs_design.robot.reader import load
from ocs_design.robot.xml import parse_xml

HIP = joint("hip", "trunk", "leg", LIMIT)
TRUNK, LEG = link("trunk", inertial()), link("leg", inertial())
BOMB = (
    b'<!DOCTYPE r [<!ENTITY a0 "ha">'
    + b"".join(b'<!ENTITY a%d "%s">' % (i, b"&a%d;" % (i - 1) * 10) for i in range(1, 12))
    + b']><robot name="&a11;"/>'
)


def on_leg(*figures, **named) -> bytes:
    """A trunk with this <inertial> on one leg."""
    return robot(link("trunk", inertial(*figures, **named)), LEG, HIP)


BAD = {
    "empty": (b"  \n", "empty"),
    "not XML": (b"solid cube\nfacet normal 0 0 1\n", "not XML"),
    "binary": (bytes(range(256)) * 4, "XML"),
    "cut off": (TWO_LINKS[:-20], "line 1"),
    "XML but no robot": (b"<html><body/></html>", "<html>"),
    "SDF": (b'<sdf version="1.7"><model name="m"/></sdf>', "SDF"),
    "included MJCF": (b"<mujocoinclude/>", "MJCF"),
    "no links": (b'<robot name="r"/>', "no <link>"),
    "trunk without inertial": (robot(link("trunk"), LEG, HIP), "'trunk'"),
    "trunk of zero mass": (on_leg(0.0), "'trunk'"),
    "no inertial at all": (robot(link("trunk"), link("leg"), HIP), "'trunk'"),
    "point mass": (robot(link("trunk", inertial(1.0, "0 0 0"))), "no inertia"),
    "negative mass": (on_leg(-2.0), "'trunk'"),
    "negative moment": (on_leg(2.0, "-1 1 1"), "'trunk'"),
    "impossible inertia": (on_leg(2.0, "0.1 0.1 9"), "triangle"),
    "NaN": (on_leg("nan"), "'trunk'"),
    "infinite": (on_leg(1.0, xyz="0 inf 0"), "'trunk'"),
    "decimal comma": (on_leg("0,5"), "0,5"),
    "two numbers": (on_leg(1.0, xyz="0 1"), "2 numbers"),
    "mass without inertia": (
        robot(link("trunk", '<inertial><mass value="1"/></inertial>')),
        "<inertia>",
    ),
    "link without name": (robot("<link/>"), "no name"),
    "two links of one name": (robot(link("a", inertial()), link("a")), "'a'"),
    "two joints of one name": (
        robot(TRUNK, LEG, link("x"), HIP, joint("hip", "trunk", "x")),
        "'hip'",
    ),
    "unknown parent": (robot(TRUNK, LEG, joint("hip", "trnk", "leg")), "'trnk'"),
    "unknown child": (robot(TRUNK, LEG, joint("hip", "trunk", "leq")), "'leq'"),
    "unknown joint type": (robot(TRUNK, LEG, joint("hip", "trunk", "leg", kind="ball")), "'ball'"),
    "zero axis": (robot(TRUNK, LEG, joint("hip", "trunk", "leg", '<axis xyz="0 0 0"/>')), "'hip'"),
    "two roots": (robot(TRUNK, LEG), "'trunk', 'leg'"),
    "loop by two parents": (
        robot(TRUNK, LEG, link("rod"), HIP, joint("a", "trunk", "rod"), joint("b", "leg", "rod")),
        "'rod'",
    ),
    "loop beside the tree": (
        robot(TRUNK, link("a"), link("b"), joint("ab", "a", "b"), joint("ba", "b", "a")),
        "loop",
    ),
    "nothing but a loop": (
        robot(link("a", inertial()), link("b"), joint("ab", "a", "b"), joint("ba", "b", "a")),
        "loop",
    ),
    "link on itself": (robot(link("a", inertial()), joint("aa", "a", "a")), "loop"),
    "entity bomb": (BOMB, "without bound"),
    "unknown encoding": (b'<?xml version="1.0" encoding="klingon"?><robot/>', "encoding"),
    "truncated gzip": (gzip.compress(TWO_LINKS)[:-12], "too early"),
    "corrupt gzip": (gzip.compress(TWO_LINKS)[:12] + b"\0" * 40, "gzip"),
    "gzip of nothing": (gzip.compress(b""), "empty"),
    "MJCF that MuJoCo refuses": (b"<mujoco><wordbody/></mujoco>", "wordbody"),
    "MJCF without bodies": (b"<mujoco/>", "no bodies"),
    "MJCF without mass": (
        b'<mujoco><worldbody><body name="b"><freejoint/></body></worldbody></mujoco>',
        "'b'",
    ),
    "MJCF with NaN": (
        b'<mujoco><worldbody><body name="b" pos="0 0 0"><freejoint/><geom size="1"/>'
        b'<body pos="nan 0 0"><joint/><geom size="1"/></body></body></worldbody></mujoco>',
        "not finite",
    ),
    "MJCF with a mass of NaN": (
        b'<mujoco><worldbody><body name="b"><freejoint/>'
        b'<inertial mass="nan" pos="0 0 0" diaginertia="1 1 1"/></body></worldbody></mujoco>',
        "MuJoCo refuses",
    ),
    "MJCF nested too deeply": (
        b"<mujoco><worldbody>" + b"<body>" * 3000 + b"</body>" * 3000 + b"</worldbody></mujoco>",
        "nested",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_refused_with_its_cure(case: str, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    content, expected = BAD[case]
    path = tmp_path / "robot.urdf"
    path.write_bytes(content)
    with pytest.raises(RobotError) as caught:
        load(path)
    assert caught.value.exit_code == 3
    assert expected in caught.value.message
    assert caught.value.hint
    assert "\n" not in caught.value.message
    assert list(tmp_path.iterdir()) == [path], "MuJoCo's log file"


def test_a_missing_mesh_only_warns_once_with_the_count(tmp_path: Path):
    shapes = "".join(
        f'<visual><geometry><mesh filename="package://gone/{name}.stl"/></geometry></visual>'
        for name in "aab"
    )
    path = tmp_path / "robot.urdf"
    path.write_bytes(robot(link("trunk", inertial(), shapes)))
    (warning,) = load(path).tree.warnings
    assert warning.startswith("2 meshes")
    assert "package://gone/a.stl" in warning


ENTITIES = (
    '<!DOCTYPE r [<!ENTITY a "'
    + "<x/>" * 10
    + '">'
    + f'<!ENTITY b "{"&a;" * 10}">]><robot>{"&b;" * 6}</robot>'
)


@pytest.mark.parametrize(
    "content",
    [b"<robot>" + b"<x/>" * 1001 + b"</robot>", ENTITIES.encode(), ENTITIES.encode("utf-16")],
    ids=["in the file", "of entities", "of entities in UTF-16"],
)
def test_too_many_xml_elements_are_refused(content, monkeypatch):
    monkeypatch.setattr("ocs_design.robot.xml.MOST_ELEMENTS", 500)
    with pytest.raises(RobotError, match="more than 500 elements"):
        parse_xml(content, Warnings())


def test_too_many_links_are_refused(tmp_path):
    (tmp_path / "robot.urdf").write_bytes(robot(*(link(f"l{i}") for i in range(2001))))
    with pytest.raises(RobotError, match="2001 links, more than 2000"):
        load(tmp_path / "robot.urdf")
