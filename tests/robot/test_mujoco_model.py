"""Robots in MuJoCo: the same masses, joints and names as in the file, free and ready to touch."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from robots import ALL_URDFS, ROBOTS, SOLO12, one_of_each

from ocs_design.common.errors import RobotError
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mujoco_model import build_spec, foot_geom_name, posture_qpos, trunk_body
from ocs_design.robot.reader import load, read_robot
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import JointKind

READABLE = [path for path in ALL_URDFS if path.name != "ur3.urdf"]
MENDED = {"romeo_small", "romeo_laas_small", "romeo", "human"}

MJCF = """<mujoco model="walker">
  <compiler angle="degree" meshdir="parts"/>
  <default><joint damping="0.2" armature="0.01"/><geom contype="4"/></default>
  <asset><mesh name="gone" file="gone.stl"/></asset>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    {stranger}
    <body name="trunk" pos="0 0 0.5">
      {root_joint}
      <inertial pos="0 0 0" mass="3" diaginertia="0.02 0.03 0.04"/>
      <geom name="chest" type="box" size="0.2 0.1 0.05"/><geom type="mesh" mesh="gone"/>
      <body name="left" pos="0 0.1 0"><joint name="left_hip" axis="0 1 0" range="-50 60"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.3"/></body>
      <body name="right" pos="0 -0.1 0"><joint name="right_hip" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.3"/></body>
    </body>
  </worldbody>
  <contact><pair geom1="floor" geom2="chest"/></contact>
  <sensor><distance geom1="floor" geom2="chest" cutoff="1"/></sensor>
  <actuator><position name="left_hip" joint="left_hip" kp="20"/>
    <position name="right_hip" joint="right_hip" kp="20"/></actuator>
  <keyframe><key name="home" qpos="{root_qpos} 0.123456789012 0.2" ctrl="0.3 0.4"/>
  </keyframe>
</mujoco>"""
FREE = {"stranger": "", "root_joint": "<freejoint/>", "root_qpos": "0 0 0.6 1 0 0 0"}
FIXED = {"stranger": "", "root_joint": "", "root_qpos": ""}
SLIDING = FIXED | {
    "root_joint": '<joint name="rail" type="slide" axis="1 0 0"/>',
    "root_qpos": "0.7",
}
WITH_A_BALL = FREE | {
    "stranger": '<body name="ball" pos="2 0 1"><freejoint/><geom size="0.1" mass="1"/></body>',
    "root_qpos": "2 0 1 1 0 0 0 " + FREE["root_qpos"],
}


def unposed_robot(path: Path) -> Robot:
    """Any robot, legged or not, at a posture within its limits."""
    loaded = load(path)
    tree = loaded.tree
    base = tree.bodies[0].name
    rng = np.random.default_rng(0)
    posture = {
        name: rng.uniform(max(joint.lower, -1.0), min(joint.upper, 1.0))
        if joint.lower < 1.0 and joint.upper > -1.0
        else joint.lower
        for name, joint in tree.joints.items()
    }
    posture = tree.complete(posture)
    return replace(
        robot_by_hand(1.0, (1e-2, 1e-2, 1e-2), name=tree.name),
        source=loaded.source,
        format=loaded.format,
        content=loaded.content,
        tree=tree,
        trunk=base,
        floating_base=base,
        posture=posture,
        mass_properties=tree.locked_mass_properties(posture, base),
    )


def locked_in_mujoco(model, robot):
    """Mass, centre of mass and locked inertia about it in the root's frame, as MuJoCo has them."""
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    rotation = data.xmat[1].reshape(3, 3)
    mass = model.body_subtreemass[1]
    com = rotation.T @ (data.subtree_com[1] - data.xpos[1])
    offset = com @ com * np.eye(3) - np.outer(com, com)
    return mass, com, full[3:6, 3:6] - mass * offset


def write(folder: Path, text: str) -> Path:
    path = folder / "robot.xml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("path", one_of_each(READABLE))
def test_mass_and_inertia_are_the_trees(path):
    robot = unposed_robot(path)
    built = build_spec(robot, visuals=False)
    mass, com, inertia = locked_in_mujoco(built.spec.compile(), robot)
    if path.stem in MENDED:
        assert built.warnings
        assert mass == pytest.approx(robot.mass, rel=1e-7)
        return
    assert built.warnings == ()
    assert mass == pytest.approx(robot.mass, rel=1e-12)
    np.testing.assert_allclose(com, robot.com, atol=1e-12)
    scale = np.abs(robot.inertia).max()
    np.testing.assert_allclose(inertia, robot.inertia, rtol=0.0, atol=1e-9 * scale)


def test_joints_are_those_of_the_file():
    robot = read_robot(SOLO12)
    model = build_spec(robot, visuals=False).spec.compile()
    assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    assert [model.joint(i).name for i in range(1, model.njnt)] == list(robot.tree.joints)
    for name, joint in robot.tree.joints.items():
        kind = "HINGE" if joint.kind is JointKind.REVOLUTE else "SLIDE"
        assert model.joint(name).type == getattr(mujoco.mjtJoint, f"mjJNT_{kind}")
        np.testing.assert_allclose(model.joint(name).axis, joint.axis, atol=1e-15)
        np.testing.assert_array_equal(model.joint(name).range, [joint.lower, joint.upper])


def test_a_void_limit_is_no_limit():
    robot = read_robot(ROBOTS / "anymal_c_simple_description/urdf/anymal.urdf", posture="zero")
    model = build_spec(robot, visuals=False).spec.compile()
    for name, joint in robot.tree.joints.items():
        assert bool(model.joint(name).limited[0]) == np.isfinite([joint.lower, joint.upper]).any()


def test_a_mimic_joint_follows_its_leader():
    robot = unposed_robot(ROBOTS / "panda_description/urdf/panda.urdf")
    leaders = {name: j.mimic for name, j in robot.tree.joints.items() if j.mimic is not None}
    assert leaders
    model = build_spec(robot, visuals=False).spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_forward(model, data)
    assert data.ne == len(leaders)
    np.testing.assert_allclose(data.efc_pos[: data.ne], 0.0, atol=1e-12)


def test_a_root_link_called_world_gets_another_name():
    robot = unposed_robot(ROBOTS / "ur_description/urdf/ur5_robot.urdf")
    assert robot.tree.bodies[0].name == "world"
    spec = build_spec(robot, visuals=False).spec
    body, base = trunk_body(spec, robot)
    assert body.name == "world_link"
    np.testing.assert_array_equal(base.position, np.zeros(3))


def test_nothing_touches_in_the_nominal_posture():
    robot = read_robot(SOLO12)
    spec = build_spec(robot, visuals=False).spec
    assert spec.excludes
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_forward(model, data)
    assert data.ncon == 0


def test_visuals_are_seen_but_never_touched():
    robot = read_robot(SOLO12)
    with_visuals = build_spec(robot).spec.compile()
    without = build_spec(robot, visuals=False).spec.compile()
    seen = with_visuals.geom_group == 2
    assert seen.any()
    assert not with_visuals.geom_contype[seen].any()
    assert not with_visuals.geom_conaffinity[seen].any()
    assert without.ngeom == np.count_nonzero(~seen)


def test_dae_meshes_are_converted():
    robot = unposed_robot(ROBOTS / "panda_description/urdf/panda.urdf")
    spec = build_spec(robot).spec
    assert any(shape.mesh and shape.mesh.suffix == ".dae" for shape in robot.tree.bodies[1].shapes)
    assert {Path(name).suffix for name in spec.assets} <= {".stl", ".obj"}
    assert spec.compile().nmesh > 0


def test_a_foot_of_nothing_gets_something_to_stand_on():
    robot = read_robot(ROBOTS / "simple_humanoid_description/urdf/simple_humanoid.urdf")
    assert robot.legs
    model = build_spec(robot, visuals=False).spec.compile()
    for leg in robot.legs:
        geom = model.geom(foot_geom_name(leg))
        np.testing.assert_allclose(geom.pos, leg.foot, atol=1e-15)
        assert geom.size[0] == pytest.approx(leg.foot_radius or 0.02 * leg.length)


@pytest.mark.parametrize("content", [b"", b"solid nothing\nendsolid nothing\n", b"\0" * 84 + b"x"])
def test_broken_meshes_never_stop_a_robot(tmp_path, content):
    (tmp_path / "broken.stl").write_bytes(content)
    path = tmp_path / "robot.urdf"
    path.write_text(
        '<robot name="r"><link name="trunk"><inertial><mass value="1"/><inertia ixx="1" iyy="1"'
        ' izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>'
        '<mesh filename="broken.stl"/></geometry></collision></link></robot>'
    )
    built = build_spec(unposed_robot(path))
    assert any("broken.stl" in warning for warning in built.warnings)
    assert built.spec.compile().ngeom == 0


def test_a_flat_mesh_is_left_out_with_a_warning(tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n")
    path = tmp_path / "robot.urdf"
    path.write_text(
        '<robot name="r"><link name="trunk"><inertial><mass value="1"/><inertia ixx="1" iyy="1"'
        ' izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>'
        '<mesh filename="flat.obj"/></geometry></collision></link></robot>'
    )
    built = build_spec(unposed_robot(path))
    built.spec.compile()
    assert any("flat.obj" in warning for warning in built.warnings)


def test_a_robot_by_hand_is_one_free_box():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07, 0.001, 0.002, -0.003), com=(0.01, 0.0, -0.02))
    model = build_spec(robot).spec.compile()
    assert (model.nbody, model.nq, model.ngeom) == (2, 7, 1)
    mass, com, inertia = locked_in_mujoco(model, robot)
    assert mass == robot.mass
    np.testing.assert_allclose(com, robot.com, atol=1e-15)
    np.testing.assert_allclose(inertia, robot.inertia, atol=1e-15)


@pytest.mark.parametrize("root", [FREE, FIXED, SLIDING, WITH_A_BALL])
def test_an_mjcf_robot_stands_alone_and_free_with_its_keyframe(tmp_path, root):
    robot = read_robot(write(tmp_path, MJCF.format(**root)), posture="zero")
    built = build_spec(robot)
    model = built.spec.compile()
    names = [model.body(i).name for i in range(model.nbody)]
    assert names == ["world", "trunk", "left", "right"]
    assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    assert model.nq == 9
    assert model.body_subtreemass[1] == pytest.approx(robot.mass, rel=1e-12)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    assert data.joint("left_hip").qpos[0] == 0.123456789012
    assert data.joint("right_hip").qpos[0] == 0.2
    assert data.actuator("left_hip").ctrl[0] == 0.3
    assert data.actuator("right_hip").ctrl[0] == 0.4
    assert data.qpos[2] == (0.6 if "freejoint" in root["root_joint"] else 0.5)
    assert any("floor" in warning for warning in built.warnings)
    assert any("ball" in warning for warning in built.warnings) == bool(root["stranger"])


def test_an_mjcf_robot_brings_its_includes(tmp_path):
    (tmp_path / "legs").mkdir()
    (tmp_path / "legs" / "leg.xml").write_text(
        '<mujocoinclude><body name="leg"><joint name="hip" axis="0 1 0"/>'
        '<geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.3"/></body>'
        "</mujocoinclude>"
    )
    text = (
        '<mujoco><worldbody><body name="trunk"><freejoint/><geom size="0.1" mass="2"/>'
        '<include file="legs/leg.xml"/></body></worldbody></mujoco>'
    )
    robot = read_robot(write(tmp_path, text), posture="zero")
    model = build_spec(robot).spec.compile()
    assert model.joint("hip").id == 1
    (tmp_path / "legs" / "leg.xml").unlink()
    with pytest.raises(RobotError, match=r"leg\.xml"):
        build_spec(robot)


def test_the_solver_is_dense():
    assert build_spec(robot_by_hand(1.0, (1.0, 1.0, 1.0))).spec.option.jacobian == 0
