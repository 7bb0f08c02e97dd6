"""The MJCF reader against MuJoCo itself, and against the URDF reader on the same robot."""

import os
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from mass_oracles import assert_same_mass_properties, mujoco_mass_properties

from ocs_design.common.errors import RobotError
from ocs_design.robot import mjcf_spec
from ocs_design.robot.mjcf import read_mjcf
from ocs_design.robot.tree import JointKind, ShapeKind, Tree

# Everything that makes a joint's frame differ from its body's: anchors, references, several joints
# on one body, welded bodies, degrees, default classes.
ZOO = """<mujoco model="zoo">
<compiler angle="degree"/>
<default><joint damping="0.5" armature="0.01" frictionloss="0.25"/></default>
<worldbody>
  <geom type="plane" size="1 1 .1"/>
  <body name="table" pos="1 0 0"><geom type="box" size="1 1 1" density="5000"/></body>
  <body name="trunk" pos="0 0 1" euler="10 20 30">
    <freejoint/>
    <geom type="box" size=".2 .1 .05" pos="0.01 0 0.02"/>
    <body name="leg" pos=".2 0 0" euler="5 0 0">
      <joint name="a" axis="1 0 0" pos="0.01 .02 .03" ref="10" range="-50 60"/>
      <joint name="b" axis="0 1 0" pos="0 0 .05"/>
      <joint name="s" type="slide" axis="0 0 1" ref=".02" range="-.1 .2"/>
      <geom type="capsule" size=".02" fromto="0 0 0 0 0 -.2"/>
      <body name="shoe" pos="0 0 -.2" euler="0 7 0">
        <geom type="sphere" size=".03"/>
        <body name="toe" pos=".03 0 0">
          <joint name="t" axis="0 1 1" pos=".1 0 0"/>
          <geom type="ellipsoid" size=".03 .02 .01" contype="0" conaffinity="0"/>
        </body>
        <body name="tail">
          <joint name="swivel" type="ball"/><geom type="cylinder" size=".01 .02" pos=".1 0 0"/>
        </body>
      </body>
    </body>
  </body>
  <body name="crate" pos="0 5 0"><freejoint/><geom type="box" size=".3 .3 .3"/></body>
</worldbody>
<actuator>
  <motor joint="a" gear="3" ctrlrange="-2 2"/>
  <position joint="b" kp="10" forcerange="-4 4"/>
  <motor joint="t"/>
</actuator>
<keyframe>
  <key name="home" qpos="0 0 1 1 0 0 0  .1 .2 .03 .4  1 0 0 0  0 0 0 1 0 0 0"/>
  <key qpos="0 0 1 1 0 0 0  .5 .2 .03 .4  1 0 0 0  0 0 0 1 0 0 0"/>
</keyframe>
</mujoco>"""


def read(text: str, folder: Path | None = None) -> Tree:
    return read_mjcf(text.encode(), folder)


def with_equality(inside: str) -> str:
    return ZOO.replace("<actuator>", f"<equality>{inside}</equality><actuator>")


@pytest.mark.parametrize("seed", range(3))
def test_mass_com_and_inertia_are_those_of_mujoco(seed):
    rng = np.random.default_rng(seed)
    tree = read(ZOO)
    posture = {name: rng.uniform(-1, 1) for name in tree.joints}
    model = mujoco.MjModel.from_xml_string(ZOO)
    data = mujoco.MjData(model)
    data.qpos[:7] = rng.normal(size=7)
    for name, value in posture.items():
        data.joint(name).qpos = value
    mujoco.mj_kinematics(model, data)
    bodies = np.flatnonzero(model.body_rootid == model.body("trunk").id)
    theirs = mujoco_mass_properties(model, data, "trunk", bodies)
    assert_same_mass_properties(tree.locked_mass_properties(posture, "trunk"), theirs)


def test_bodies_and_joints_of_the_zoo():
    tree = read(ZOO)
    assert tree.name == "zoo"
    assert [body.name for body in tree.bodies] == ["trunk", "leg:a", "leg:b", "leg", "toe"]
    assert set(tree.bodies[3].links) == {"leg", "shoe", "tail"}
    a, slide = tree.joints["a"], tree.joints["s"]
    assert (a.lower, a.upper) == pytest.approx((np.radians(-50), np.radians(60)))
    assert (a.damping, a.armature, a.friction) == (0.5, 0.01, 0.25)
    assert (slide.kind, slide.lower, slide.upper) == (JointKind.PRISMATIC, -0.1, 0.2)
    assert np.isinf(tree.joints["b"].upper)


def test_efforts_are_those_of_the_actuators():
    efforts = {name: joint.effort for name, joint in read(ZOO).joints.items()}
    assert efforts == {"a": 6.0, "b": 4.0, "s": np.inf, "t": np.inf}


def test_a_joints_own_force_range_limits_its_actuators():
    text = ZOO.replace('name="a"', 'name="a" actuatorfrcrange="-5 5"')
    assert read(text).joints["a"].effort == 5.0


def test_keyframes_become_named_postures():
    postures = read(ZOO).named_postures
    assert postures["home"] == {"a": 0.1, "b": 0.2, "s": 0.03, "t": 0.4}
    assert postures["keyframe_1"]["a"] == 0.5


def test_shapes_stand_where_the_geoms_do():
    shapes = {shape.link: shape for body in read(ZOO).bodies for shape in body.shapes}
    trunk, leg, toe = shapes["trunk"], shapes["leg"], shapes["toe"]
    assert (trunk.kind, trunk.size, trunk.collides) == (ShapeKind.BOX, (0.2, 0.1, 0.05), True)
    np.testing.assert_allclose(trunk.position, [0.01, 0, 0.02])
    assert (leg.kind, leg.size) == (ShapeKind.CAPSULE, (0.02, 0.1))
    assert (toe.kind, toe.size, toe.collides) == (ShapeKind.BOX, (0.03, 0.02, 0.01), False)


@pytest.mark.parametrize(("slope", "constant"), [(0.5, 0.1), (-2.0, 0.0)])
def test_a_linear_joint_equality_is_a_mimic_as_mujoco_holds_it(slope, constant):
    text = with_equality(f'<joint joint1="a" joint2="s" polycoef="{constant} {slope} 0 0 0"/>')
    tree = read(text)
    posture = tree.complete({"s": 0.07, "b": 0.3})
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for name, value in posture.items():
        data.qpos[model.jnt_qposadr[model.joint(name).id]] = value
    mujoco.mj_forward(model, data)
    assert tree.joints["a"].mimic is not None
    assert abs(data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]).max() < 1e-15


@pytest.mark.parametrize(
    ("equality", "pattern"),
    [
        ("", r"not part of the robot, left out: .*crate"),
        ("", r"swivel"),
        ('<joint joint1="a" polycoef="0.3 0 0 0 0"/>', r"held by an equality.*: a$"),
        ('<joint joint1="a" joint2="s" polycoef="0 1 2 0 0"/>', r": a$"),
        ('<connect name="rod" body1="toe" body2="trunk" anchor="0 0 0"/>', r"^closed.*: rod$"),
        ('<connect body1="toe" body2="trunk" anchor="0 0 0"/>', r"^closed.*: toe to trunk"),
        ('<weld body1="trunk"/>', r"left out: trunk to world$"),
    ],
)
def test_what_is_left_out_or_held_raises_a_warning(equality, pattern):
    tree = read(with_equality(equality).replace('name="shoe"', 'name="shoe" gravcomp="1"'))
    assert any(re.search(pattern, warning) for warning in tree.warnings), tree.warnings
    assert any("gravcomp" in warning and warning.endswith(": shoe") for warning in tree.warnings)
    assert tree.joints["a"].mimic is None
    assert tree.loops == ((("toe", "trunk"),) if "connect" in equality else ())


FIXED = """<mujoco><worldbody>
  <body name="bench"><geom type="box" size="9 9 9"/></body>
  <body name="arm"><geom type="box" size=".1 .1 .1"/>
    <body name="hand" pos="0 0 1"><joint name="wrist"/><geom size=".1"/></body></body>
</worldbody></mujoco>"""


def test_without_a_free_body_the_one_with_joints_is_freed_with_a_warning():
    tree = read(FIXED)
    assert [body.name for body in tree.bodies] == ["arm", "hand"]
    assert any("free joint" in warning for warning in tree.warnings)


MESH_MODEL = """<mujoco><compiler meshdir="meshes"/><asset><mesh name="m" file="m.stl"/></asset>
<worldbody>
  <body name="trunk"><freejoint/>{inside}<geom type="mesh" mesh="m" {attributes}/></body>
</worldbody>
</mujoco>"""
INERTIAL = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
SPHERE = '<geom size=".1"/>'


@pytest.mark.parametrize(
    ("inside", "attributes"), [(INERTIAL, ""), (SPHERE, 'mass="0"'), (SPHERE, 'density="0"')]
)
def test_a_missing_mesh_that_weighs_nothing_is_only_warned_of(tmp_path, inside, attributes):
    tree = read(MESH_MODEL.format(inside=inside, attributes=attributes), tmp_path)
    assert any("m.stl" in warning for warning in tree.warnings)


@pytest.mark.parametrize(("inside", "attributes"), [("", ""), (SPHERE, ""), (SPHERE, 'mass="2"')])
def test_a_missing_mesh_that_weighs_is_refused(tmp_path, inside, attributes):
    with pytest.raises(RobotError, match=r"trunk.*m\.stl") as caught:
        read(MESH_MODEL.format(inside=inside, attributes=attributes), tmp_path)
    assert "<inertial>" in caught.value.hint


def test_a_mesh_weighs_and_its_box_is_the_shape(tmp_path: Path):
    (tmp_path / "meshes").mkdir()
    box = trimesh.creation.box(extents=(1, 2, 3))
    box.apply_translation((4, 0, 0))
    box.export(tmp_path / "meshes" / "m.stl")
    (body,) = read(MESH_MODEL.format(inside="", attributes=""), tmp_path).bodies
    assert body.mass_properties.mass == pytest.approx(6000.0)
    np.testing.assert_allclose(body.mass_properties.com, [4, 0, 0], atol=1e-6)
    (shape,) = body.shapes
    extents = np.abs(shape.rotation) @ np.array(shape.size)
    np.testing.assert_allclose(extents, [0.5, 1, 1.5], atol=1e-6)
    np.testing.assert_allclose(shape.position, [4, 0, 0], atol=1e-6)


def test_utf_16_is_read():
    assert read_mjcf(ZOO.encode("utf-16"), None).name == "zoo"


def test_warnings_of_mujoco_are_passed_on_and_leave_no_log_file(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tree = read(ZOO.replace("<compiler", '<compiler settotalmass="5"'))
    assert any(warning.startswith("MuJoCo: ") for warning in tree.warnings)
    assert list(tmp_path.iterdir()) == []


def test_a_body_without_a_name_is_located_by_its_parent(tmp_path: Path):
    nameless = '<body><joint/><geom type="mesh" mesh="m"/></body>'
    with pytest.raises(RobotError, match="without a name below body 'trunk'"):
        read(MESH_MODEL.format(inside=SPHERE + nameless, attributes='mass="0"'), tmp_path)


LOOSE = '<body name="crate"><freejoint/><geom size=".3"/></body>'
INSIDE = '<geom size=".1"/><body><joint/><geom size=".1"/></body></body>'
DOOR = '<body name="door"><joint name="{0}"/>' + INSIDE
ARM = DOOR.replace("door", "{0}")
DRIVEN = "<actuator>{}</actuator>"
DRONE = '<body name="drone"><freejoint/><geom size=".1"/><site name="{0}"/></body>'
FREE = '<body name="{0}"><freejoint/>' + INSIDE
"""Bodies of a scene; `{0}` names what an actuator may act on."""


@pytest.mark.parametrize(
    ("bodies", "actuators", "robot"),
    [
        (LOOSE + ARM.format("arm"), '<motor joint="arm"/>', "arm"),
        (DOOR.format("hinge") + LOOSE + ARM.format("arm"), '<position joint="arm"/>', "arm"),
        (LOOSE + DRONE.format("rotor"), '<motor site="rotor" gear="0 0 1 0 0 0"/>', "drone"),
        (LOOSE + ARM.format("arm"), "", "arm"),
        (DOOR.format("hinge") + FREE.format("quadruped"), "", "quadruped"),
        (
            ARM.format("left") + ARM.format("right"),
            '<motor joint="left"/><motor joint="right"/>',
            "",
        ),
        (FREE.format("quadruped") + ARM.format("belt"), '<motor joint="belt"/>', ""),
        (LOOSE + LOOSE.replace("crate", "ball"), "", ""),
        ('<body name="a"><geom size="1"/></body><body name="b"><geom size="1"/></body>', "", ""),
    ],
)
def test_the_robot_is_the_body_that_is_driven_or_free_with_joints(bodies, actuators, robot):
    text = f"<mujoco><worldbody>{bodies}</worldbody>{DRIVEN.format(actuators)}</mujoco>".encode()
    if robot:
        tree = read_mjcf(text, None)
        assert tree.bodies[0].name == robot
        assert ("not part of the robot, left out" in " ".join(tree.warnings)) == (
            bodies.count("name") > 1
        )
        return
    with pytest.raises(RobotError, match="not clear") as caught:
        read_mjcf(text, None)
    for part in str(caught.value.hint).split("--trunk ")[1:]:
        name = re.split(r"[;.]", part)[0]
        assert read_mjcf(text, None, [name]).bodies[0].name == name


BODY = '<body name="trunk"><freejoint/><geom size="0.1"/></body>'
MODEL = '<mujoco><include file="{}"/><worldbody>' + BODY + "</worldbody></mujoco>"
INCLUDED = "<mujoco><option timestep='0.01'/></mujoco>"
WITH_MESH = (
    '<mujoco><asset><mesh name="m" file="m.stl"/></asset><worldbody><body name="trunk"><freejoint/>'
    '<geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "out.xml").write_text(INCLUDED)
    return tmp_path / "robot"


def read_with(folder, include):
    return read_mjcf(MODEL.format(include).encode(), folder)


def test_an_include_may_not_leave_the_folder(folder):
    (folder / "link.xml").symlink_to(folder / "../out.xml")
    for file in ("../out.xml", folder.parent / "out.xml", "link.xml"):
        with pytest.raises(RobotError, match="outside the model's folder"):
            read_with(folder, file)


def test_an_include_may_leave_the_folder_within_a_repository(folder):
    (folder.parent / ".git").mkdir()
    assert read_with(folder, "../out.xml").bodies[0].name == "trunk"


@pytest.mark.parametrize("folders", [["parts"], ["parts", "."]])
def test_nested_includes_are_searched_for_as_in_mujoco(folder, folders):
    (folder / "parts").mkdir()
    (folder / "parts" / "a.xml").write_text('<mujoco><include file="b.xml"/></mujoco>')
    for place in folders:
        text = f'<mujoco><default><geom density="{900 + 100 * len(place)}"/></default></mujoco>'
        (folder / place / "b.xml").write_text(text)
    (folder / "robot.xml").write_text(MODEL.format("parts/a.xml"))
    model = mujoco.MjModel.from_xml_path(str(folder / "robot.xml"))
    tree = read_with(folder, "parts/a.xml")
    assert tree.bodies[0].mass_properties.mass == pytest.approx(model.body_mass[1], rel=1e-12)


def test_pipes_and_huge_files_are_refused(folder, monkeypatch):
    os.mkfifo(folder / "pipe.xml")
    with pytest.raises(RobotError, match="not a plain file"):
        read_with(folder, "pipe.xml")
    monkeypatch.setattr(mjcf_spec, "LARGEST_ASSET", 10)
    (folder / "m.stl").write_bytes(bytes(11))
    with pytest.raises(RobotError, match=r"m\.stl cannot be read: it is larger"):
        read_mjcf(WITH_MESH.encode(), folder)


@pytest.mark.parametrize("number", ["1e300", "-1e80", "inf", "1e999"])
def test_huge_numbers_are_refused(number):
    text = (
        f'<mujoco><worldbody><body name="a" pos="{number} 0 0">{BODY}</body></worldbody></mujoco>'
    )
    with pytest.raises(RobotError):
        read_mjcf(text.encode(), None)


ATTACHED = """<mujoco><compiler angle="degree" meshdir="meshes"/>
  <include file="rules.xml"/><asset><mesh name="m" file="m.stl"/></asset>
  <worldbody><body name="leg" euler="0 10 0"><joint name="hip" axis="0 1 0" range="-90 90"/>
    <geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""
ATTACHING = """<mujoco><compiler angle="radian"/><asset><model name="leg" file="{file}"/></asset>
  <worldbody><body name="trunk"><freejoint/><geom size="0.1"/>
    <frame pos="0 0.2 0" euler="0.3 0 0"><attach model="leg" body="leg" prefix="left_"/></frame>
    <frame pos="0 -0.2 0"><attach model="leg" body="leg" prefix="right_"/></frame>
  </body></worldbody></mujoco>"""


def attaching(folder, file="parts/leg.xml"):
    (parts := folder / "parts").mkdir()
    (parts / "meshes").mkdir()
    (parts / "leg.xml").write_text(ATTACHED)
    (parts / "rules.xml").write_text('<mujoco><default><geom density="300"/></default></mujoco>')
    box = trimesh.creation.box(
        (0.1, 0.2, 0.3), trimesh.transformations.translation_matrix((0, 1, 0))
    )
    box.export(parts / "meshes" / "m.stl")
    (folder / "robot.xml").write_text(text := ATTACHING.format(file=file))
    return text


def test_attached_models_keep_their_own_compiler_settings(folder):
    tree = read(attaching(folder), folder)
    model = mujoco.MjModel.from_xml_path(str(folder / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    weighed = tree.locked_mass_properties({}, "trunk")
    assert weighed.mass == pytest.approx(model.body_subtreemass[1], rel=1e-12)
    np.testing.assert_allclose(weighed.com, data.subtree_com[1], atol=1e-12)
    assert tree.joints["left_hip"].upper == pytest.approx(np.pi / 2.0)


def test_a_model_that_attaches_itself_or_lies_elsewhere_is_refused(folder):
    text = attaching(folder, "robot.xml")
    with pytest.raises(RobotError, match="contain itself"):
        read(text, folder)
    with pytest.raises(RobotError, match="outside the model's folder"):
        read(text.replace("robot.xml", "../out.xml"), folder)
