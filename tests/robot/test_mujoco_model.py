"""Robots in MuJoCo: the masses, joints and names of the file, with a free base and contacts."""

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from anatomy import tree_of
from mass_oracles import assert_same_mass_properties, mujoco_mass_properties
from robots import ALL_URDFS, ROBOTS, SOLO12, one_per_folder
from urdf_text import inertial, link
from urdf_text import robot as urdf

from ocs_design.common.errors import RobotError
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mujoco_bodies import VISUAL_BYTES, oversized_visuals
from ocs_design.robot.mujoco_model import (
    build_spec,
    foot_geom_name,
    posture_qpos,
    reduce_to_hulls,
    trunk_body,
)
from ocs_design.robot.reader import load, read_robot
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import JointKind
from ocs_design.simulation.scene import robot_scene

READABLE = [path for path in ALL_URDFS if path.name != "ur3.urdf"]
CORRECTED = {"romeo_small", "romeo_laas_small", "romeo", "human"}

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


def any_robot(path: Path) -> Robot:
    """A robot, legged or not, at a random posture within its limits."""
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
        **{name: getattr(loaded, name) for name in ("source", "format", "content", "tree")},
        trunk=base,
        floating_base=base,
        posture=posture,
        mass_properties=tree.locked_mass_properties(posture, base),
    )


def model_and_data(robot, built=None):
    """Model without visuals and its data in the robot's posture."""
    model = (built or build_spec(robot, visuals=False)).spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_forward(model, data)
    return model, data


def write(folder: Path, text: str) -> Path:
    path = folder / "robot.xml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("path", one_per_folder(READABLE))
def test_mass_and_inertia_are_the_trees(path):
    robot = any_robot(path)
    built = build_spec(robot, visuals=False)
    model, data = model_and_data(robot, built)
    weighed = mujoco_mass_properties(model, data, 1)
    if path.stem in CORRECTED:
        assert built.warnings
        assert weighed.mass == pytest.approx(robot.mass, rel=1e-7)
        return
    assert built.warnings == ()
    assert_same_mass_properties(weighed, robot.mass_properties, 1e-9)
    assert weighed.mass == pytest.approx(robot.mass, rel=1e-12)
    np.testing.assert_allclose(weighed.com, robot.com, atol=1e-12)


def test_joints_are_those_of_the_file():
    robot = read_robot(SOLO12)
    model, _ = model_and_data(robot)
    assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    assert [model.joint(i).name for i in range(1, model.njnt)] == list(robot.tree.joints)
    for name, joint in robot.tree.joints.items():
        kind = "HINGE" if joint.kind is JointKind.REVOLUTE else "SLIDE"
        assert model.joint(name).type == getattr(mujoco.mjtJoint, f"mjJNT_{kind}")
        np.testing.assert_allclose(model.joint(name).axis, joint.axis, atol=1e-15)
        np.testing.assert_array_equal(model.joint(name).range, [joint.lower, joint.upper])


def test_a_void_limit_is_no_limit():
    robot = read_robot(ROBOTS / "anymal_c_simple_description/urdf/anymal.urdf", posture="zero")
    model, _ = model_and_data(robot)
    for name, joint in robot.tree.joints.items():
        assert bool(model.joint(name).limited[0]) == np.isfinite([joint.lower, joint.upper]).any()


def test_a_mimic_joint_follows_its_leader():
    robot = any_robot(ROBOTS / "panda_description/urdf/panda.urdf")
    leaders = {name: j.mimic for name, j in robot.tree.joints.items() if j.mimic is not None}
    assert leaders
    _, data = model_and_data(robot)
    assert data.ne == len(leaders)
    np.testing.assert_allclose(data.efc_pos[: data.ne], 0.0, atol=1e-12)


def test_a_root_link_called_world_gets_another_name():
    robot = any_robot(ROBOTS / "ur_description/urdf/ur5_robot.urdf")
    assert robot.tree.bodies[0].name == "world"
    spec = build_spec(robot, visuals=False).spec
    body, base = trunk_body(spec, robot)
    assert body.name == "world_link"
    np.testing.assert_array_equal(base.position, np.zeros(3))


def test_nothing_touches_in_the_nominal_posture():
    robot = read_robot(SOLO12)
    built = build_spec(robot, visuals=False)
    assert built.spec.excludes
    _, data = model_and_data(robot, built)
    assert data.ncon == 0


def test_visuals_are_shown_but_do_not_collide():
    robot = read_robot(SOLO12)
    with_visuals = build_spec(robot).spec.compile()
    without = build_spec(robot, visuals=False).spec.compile()
    visual = with_visuals.geom_group == 2
    assert visual.any()
    assert not with_visuals.geom_contype[visual].any()
    assert not with_visuals.geom_conaffinity[visual].any()
    assert without.ngeom == np.count_nonzero(~visual)


@pytest.mark.slow
def test_dae_meshes_are_converted():
    robot = any_robot(ROBOTS / "panda_description/urdf/panda.urdf")
    spec = build_spec(robot).spec
    assert any(shape.mesh and shape.mesh.suffix == ".dae" for shape in robot.tree.bodies[1].shapes)
    assert {Path(name).suffix for name in spec.assets} <= {".stl", ".obj"}
    assert spec.compile().nmesh > 0


def test_feet_collide_where_the_file_turns_contacts_off_by_default(tmp_path):
    text = MJCF.format(**FREE).replace('contype="4"', 'contype="0" conaffinity="0"')
    robot = read_robot(write(tmp_path, text))
    model = build_spec(robot).spec.compile()
    assert len(robot.legs) == 2
    for leg in robot.legs:
        assert model.geom(foot_geom_name(leg)).contype == 1


def test_a_foot_without_shape_gets_a_sphere():
    robot = read_robot(ROBOTS / "simple_humanoid_description/urdf/simple_humanoid.urdf")
    assert robot.legs
    model = build_spec(robot, visuals=False).spec.compile()
    for leg in robot.legs:
        geom = model.geom(foot_geom_name(leg))
        np.testing.assert_allclose(geom.pos, leg.foot, atol=1e-15)
        assert geom.size[0] == pytest.approx(leg.foot_radius or 0.02 * leg.length)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("empty.stl", b""),
        ("nothing.stl", b"solid nothing\nendsolid nothing\n"),
        ("cut.stl", b"\0" * 84 + b"x"),
        ("flat.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"),
    ],
)
def test_broken_and_flat_meshes_are_left_out_with_a_warning(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    mesh = f'<collision><geometry><mesh filename="{name}"/></geometry></collision>'
    (tmp_path / "robot.urdf").write_bytes(urdf(link("trunk", inertial(), mesh)))
    built = build_spec(any_robot(tmp_path / "robot.urdf"))
    assert any(name in warning for warning in built.warnings)
    assert built.spec.compile().ngeom == 0


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


TIED = """<mujoco><worldbody><site name="hook" pos="0 0 2"/>
  <body name="post"><site name="peg"/><geom size="0.1"/></body>
  <body name="trunk"><freejoint/><geom size="0.1"/><site name="eye"/>
    <body name="a"><joint name="ja"/><geom size="0.02" pos="0 0 -0.2"/></body>
    <body name="b"><joint name="jb"/><geom size="0.02" pos="0 0 -0.2"/></body></body></worldbody>
  <equality><weld body1="trunk"/><connect body1="trunk" body2="post" anchor="0 0 0"/>
    <connect site1="eye" site2="hook"/><connect name="rod" body1="a" body2="b" anchor="0 0 0"/>
    <joint name="hold" joint1="ja" polycoef="0.3 0 0 0 0"/>
  </equality>
  <tendon><spatial name="rope"><site site="eye"/><site site="hook"/></spatial>
    <spatial name="line"><site site="eye"/><site site="peg"/></spatial></tendon>
  <actuator><motor tendon="rope"/><motor tendon="line"/><motor joint="ja"/></actuator>
  <sensor><tendonpos tendon="rope"/></sensor></mujoco>"""


KEYFRAME = '<keyframe><key name="home" ctrl="{}" qpos="0 0 1 1 0 0 0 0.1 0.2"/></keyframe></mujoco>'


@pytest.mark.parametrize("alone", [False, True])
def test_constraints_between_an_mjcf_robot_and_its_world_are_removed(tmp_path, alone):
    text = TIED
    if alone:
        for part in (
            r'<body name="post">.*?</body>',
            r"<connect body1.*?/>",
            r"<spatial name=.line.*?l>",
        ):
            text = re.sub(part, "", text)
        text = text.replace('<motor tendon="line"/>', "")
    text = text.replace("</mujoco>", KEYFRAME.format("1 2" if alone else "1 2 3"))
    robot = read_robot(write(tmp_path, text), trunk="trunk", legs=())
    model = build_spec(robot).spec.compile()
    assert [model.eq(index).name for index in range(model.neq)] == ["rod", "hold"]
    assert (model.ntendon, model.nu, model.nsensor) == (0, 1, 0)
    assert model.key("home").ctrl == (2 if alone else 3)
    assert not robot_scene(robot).compile().neq


def test_an_mjcf_robot_keeps_its_includes(tmp_path):
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


PLAYER = """<mujoco model="player"><worldbody>
  <light name="lamp" mode="targetbody" target="ball" pos="0 0 3"/>
  <body name="dog" pos="0 0 0.5"><freejoint/><geom size="0.1" mass="3"/>
    <camera name="eye" mode="targetbody" target="ball"/>
    <camera name="self" mode="targetbody" target="tail"/>
    <body name="tail" pos="-0.2 0 0"><joint name="wag"/><geom size="0.02" mass="0.1"/></body></body>
  <body name="ball" pos="1 0 0.1"><freejoint/><geom size="0.1" mass="0.3"/></body>
</worldbody></mujoco>"""


def test_cameras_and_lights_do_not_target_removed_bodies(tmp_path):
    (tmp_path / "player.xml").write_text(PLAYER)
    built = build_spec(read_robot(tmp_path / "player.xml"))
    model = built.spec.compile()
    fixed = mujoco.mjtCamLight.mjCAMLIGHT_FIXED
    assert [model.body(i).name for i in range(1, model.nbody)] == ["dog", "tail"]
    assert model.cam_mode[model.camera("eye").id] == model.light_mode[0] == fixed
    assert model.cam_targetbodyid[model.camera("self").id] == model.body("tail").id
    assert any("ball" in warning for warning in built.warnings)


DIRECTIONS = np.random.default_rng(0).normal(size=(500, 3))


def support(model):
    """Support function of each mesh geom that collides, in each direction [m], by geom.

    Two convex bodies are the same if their support functions are.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    supports = {}
    for geom in range(model.ngeom):
        mesh = model.geom_dataid[geom]
        if mesh < 0 or model.geom_contype[geom] == 0:
            continue
        first = model.mesh_vertadr[mesh]
        vertices = model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(np.float64)
        placed = vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        supports[geom] = (placed @ DIRECTIONS.T).max(axis=0)
    return supports


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("g1_description/urdf/g1_29dof_rev_1_0", marks=pytest.mark.exhaustive),
        "bolt_description/robots/bolt",
    ],
)
def test_hulls_reach_as_far_as_the_meshes(name):
    robot = read_robot(ROBOTS / f"{name}.urdf")
    meshes, hulls = (build_spec(robot, visuals=shown).spec for shown in (True, False))
    for geom in [geom for geom in meshes.geoms if geom.contype == 0]:
        meshes.delete(geom)
    before, after = meshes.compile(), hulls.compile()
    expected, actual = support(before), support(after)
    assert expected.keys() == actual.keys() != set()
    for geom, distance in expected.items():
        np.testing.assert_allclose(actual[geom], distance, rtol=0.0, atol=1e-6)
    assert after.nmeshvert < before.nmeshvert / 3
    assert after.body_inertia.tolist() == before.body_inertia.tolist()
    assert not hulls.assets


def test_a_box_fitted_to_a_mesh_keeps_its_size():
    """Its size comes from the inertia of the mesh, which is not that of the hull."""
    ring = trimesh.creation.annulus(0.05, 0.1, 0.02)
    spec = mujoco.MjSpec()
    spec.assets["ring.stl"] = ring.export(file_type="stl")
    spec.add_mesh(name="ring", file="ring.stl")
    for kind in (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH):
        spec.worldbody.add_geom(type=kind, meshname="ring")
    before = spec.compile()
    reduce_to_hulls(spec, before)
    after = spec.compile()
    assert after.geom_size.tolist() == before.geom_size.tolist()
    assert after.nmeshvert == before.nmeshvert


@pytest.mark.parametrize(
    ("name", "left_out"),
    [
        ("go1_description/urdf/go1", {"trunk.dae"}),
        ("b1_description/urdf/b1", {"trunk.dae"}),
        ("anymal_b_simple_description/robots/anymal", {"anymal_base.dae"}),
        ("go2_description/urdf/go2", set()),
        ("solo_description/robots/solo12", set()),
    ],
)
def test_the_largest_visuals_are_left_out_first(name, left_out):
    tree = tree_of(name)
    oversized = oversized_visuals(tree)
    assert {path.name for path in oversized} == left_out
    shown = {
        shape.mesh
        for body in tree.bodies
        for shape in body.shapes
        if shape.mesh is not None and not shape.collides
    }
    assert sum(path.stat().st_size for path in shown - oversized) <= VISUAL_BYTES


def test_visuals_left_out_raise_a_warning_and_collision_shapes_are_shown():
    built = build_spec(read_robot(ROBOTS / "go1_description/urdf/go1.urdf"))
    (warning,) = built.warnings
    assert warning == "meshes too large to show in the MuJoCo model, left out: trunk.dae"
    trunk = built.spec.body("base")
    visible = [geom for geom in trunk.geoms if geom.group == 0]
    assert visible
    assert np.all([geom.contype == 1 for geom in visible])
