"""Sensors of the device in MuJoCo; the robot's own sensors and keyframes stay."""

import mujoco
import numpy as np
import pytest
from exported import LEGGED, LEGGED_PATHS, mujoco_model, robot_at
from robots import SOLO12
from wheels import driven_device

from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot

DEVICE = driven_device()
BRANCHED = """<mujoco model="branched">
  <worldbody>
    <body name="trunk" pos="0 0 0.5"><freejoint name="float"/><geom size="0.1"/>
      <site name="nose" pos="0.1 0 0"/>
      <body name="neck" pos="0.2 0 0"><joint name="neck" type="ball"/><geom size="0.05"/>
        <body name="head" pos="0.1 0 0"><joint name="nod" axis="0 1 0"/><geom size="0.05"/></body>
      </body>
      <body name="leg" pos="0 0.1 0"><geom size="0.05"/>
        <joint name="hip" axis="1 0 0"/><joint name="lift" axis="0 1 0"/>
        <body name="shank" pos="0 0 -0.2"><joint name="knee" type="slide" axis="0 0 1"/>
          <geom size="0.03"/></body>
      </body>
      <body name="tail" pos="-0.2 0 0"><joint name="wag" axis="0 0 1"/><geom size="0.02"/></body>
    </body>
  </worldbody>
  <actuator><motor name="wag" joint="wag"/>
    <general name="slow" joint="knee" dyntype="filter" dynprm="0.1"/></actuator>
  <sensor><jointpos name="a" joint="nod"/><accelerometer name="b" site="nose"/>
    <jointvel name="c" joint="knee"/></sensor>
</mujoco>"""


def with_keyframes(spec):
    """The model with two keyframes of random states."""
    model = spec.compile()
    random = np.random.default_rng(1)
    for name in ("home", "jump"):
        qpos = random.uniform(-0.5, 0.5, model.nq)
        mujoco.mj_normalizeQuat(model, qpos)
        spec.add_key(
            name=name,
            time=random.uniform(),
            qpos=qpos,
            qvel=random.uniform(-1.0, 1.0, model.nv),
            ctrl=random.uniform(-1.0, 1.0, model.nu),
            act=random.uniform(-1.0, 1.0, model.na),
        )
    return spec


def states(model, key):
    """Coordinates and rates of each joint, controls and activations, by name."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    joints = [data.joint(i) for i in range(model.njnt)]
    drives = [data.actuator(i) for i in range(model.nu)]
    values = {f"q {joint.name}": joint.qpos.copy() for joint in joints}
    values |= {f"v {joint.name}": joint.qvel.copy() for joint in joints}
    values |= {f"u {drive.name}": drive.ctrl.copy() for drive in drives}
    return values | {"act": data.act.copy(), "time": np.array([data.time])}


def check_keyframes_kept(before, after):
    assert [after.key(i).name for i in range(after.nkey)] == ["home", "jump", "ocs_home"]
    for key in ("home", "jump"):
        ours, theirs = states(after, key), states(before, key)
        for name, values in theirs.items():
            np.testing.assert_allclose(ours[name], values, rtol=1e-12, atol=1e-15, err_msg=name)
        # Drives added to a robot without any hold the posture of the keyframe.
        added = range(0 if before.nu else after.nu)
        drives = {f"u {after.actuator(i).name}" for i in added}
        assert {name for name in ours if name not in theirs} == drives | {
            f"{kind} ocs_{side}" for kind in "qvu" for side in ("left", "right")
        }
        for name in drives - {"u ocs_left", "u ocs_right"}:
            np.testing.assert_allclose(ours[name], theirs[f"q{name[1:]}"], atol=1e-15)


def exported_model(path, trunk, folder):
    robot = read_robot(path, trunk=trunk, posture="zero")
    folder.mkdir()
    return mujoco_model(robot, DEVICE, folder)


@pytest.fixture
def branched(tmp_path):
    spec = with_keyframes(mujoco.MjSpec.from_string(BRANCHED))
    (tmp_path / "in.xml").write_text(spec.to_xml())
    # Numbers that `to_xml` rounds count as those of the user's file.
    return tmp_path / "in.xml"


@pytest.mark.parametrize("trunk", ["trunk", "leg", "head", "tail"])
def test_keyframes_of_a_branched_robot_stay(branched, tmp_path, trunk):
    before = mujoco.MjModel.from_xml_path(str(branched))
    check_keyframes_kept(before, exported_model(branched, trunk, tmp_path / "out"))


@pytest.mark.slow
@pytest.mark.parametrize("path", LEGGED_PATHS[::3], ids=LEGGED[::3])
def test_keyframes_of_real_robots_stay(path, tmp_path):
    """Written as MJCF without a device first, since example-robot-data has no MJCF."""
    spec = build_spec(robot_at(path), visuals=False).spec
    # The reader names what has no name.
    spec.joints[0].name = "float"
    spec = with_keyframes(spec)
    for name, content in spec.assets.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "in.xml").write_text(spec.to_xml())
    trunk = robot_at(path).trunk
    before = mujoco.MjModel.from_xml_path(str(tmp_path / "in.xml"))
    check_keyframes_kept(before, exported_model(tmp_path / "in.xml", trunk, tmp_path / "out"))


def test_the_robots_own_sensors_keep_their_places(branched, tmp_path):
    before = mujoco.MjModel.from_xml_path(str(branched))
    after = exported_model(branched, "trunk", tmp_path / "out")
    for i in range(before.nsensor):
        assert after.sensor(i).name == before.sensor(i).name
        assert after.sensor_adr[i] == before.sensor_adr[i]
    added = [after.sensor(i).name for i in range(before.nsensor, after.nsensor)]
    assert added == [
        "ocs_left_velocity",
        "ocs_left_torque",
        "ocs_right_velocity",
        "ocs_right_torque",
        "ocs_imu_attitude",
        "ocs_imu_rate",
    ]


def test_sensors_measure_what_their_names_say(tmp_path):
    model = exported_model(SOLO12, None, tmp_path / "out")
    data = mujoco.MjData(model)
    data.joint("ocs_left").qvel[:] = 12.0
    data.joint("ocs_right").qvel[:] = -7.0
    data.qpos[3:7] = [0.8, 0.0, 0.6, 0.0]
    data.qvel[3:6] = [0.1, 0.2, 0.3]
    data.actuator("ocs_left").ctrl[:] = 0.25
    mujoco.mj_forward(model, data)
    measured = {model.sensor(i).name: data.sensor(i).data.copy() for i in range(model.nsensor)}
    assert measured["ocs_left_velocity"] == 12.0
    assert measured["ocs_right_velocity"] == -7.0
    assert (measured["ocs_left_torque"], measured["ocs_right_torque"]) == (0.25, 0.0)
    np.testing.assert_allclose(measured["ocs_imu_attitude"], [0.8, 0.0, 0.6, 0.0], atol=1e-15)
    np.testing.assert_allclose(measured["ocs_imu_rate"], [0.1, 0.2, 0.3], atol=1e-15)
