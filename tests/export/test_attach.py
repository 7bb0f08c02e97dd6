"""The device on a MuJoCo model: in its place, with nothing else changed."""

import mujoco
import numpy as np
import pytest
from exported import check_wheels_in_mujoco
from robots import ROBOTS
from wheels import driven_device, motor, paper_device

from ocs_design.common.errors import RobotError
from ocs_design.export.attach import attach_device
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot

MJCF = """<mujoco>
  <compiler angle="degree" inertiafromgeom="true" settotalmass="7"/>
  <default><joint damping="2" armature="0.5" frictionloss="1" range="-10 10" limited="true"/>
    <geom contype="65536"/></default>
  <worldbody><body name="trunk"><freejoint/><geom name="chest" type="box" size="0.2 0.1 0.1"/>
    <body name="first"><joint name="first" axis="0 1 0"/><geom size="0.1"/></body>
    <body name="second"><joint name="second" axis="0 1 0"/><geom size="0.1"/></body>
  </body></worldbody>
  <actuator><motor name="first" joint="first"/><motor name="second" joint="second"/></actuator>
  <keyframe><key name="home" qpos="0 0 1 1 0 0 0 0.11 0.12" qvel="0 0 0 0 0 0 0.21 0.22"
    ctrl="0.31 0.32"/></keyframe>
</mujoco>"""


def with_device(robot, device):
    spec = build_spec(robot, visuals=False).spec
    attach_device(spec, robot, device)
    return spec.compile()


def read_mjcf(folder, text=MJCF):
    path = folder / "robot.xml"
    path.write_text(text)
    return read_robot(path, trunk="trunk", posture="zero")


def test_a_trunk_link_may_be_offset_from_its_body():
    """B is the frame of the link that carries the device, not of its moving body."""
    path = ROBOTS / "anymal_c_simple_description/urdf/anymal.urdf"
    body = read_robot(path).tree.bodies[0]
    name, place = next((n, p) for n, p in body.links.items() if np.abs(p.rotation).trace() < 2.9)
    robot, device = read_robot(path, trunk=name, posture="zero"), paper_device()
    data = mujoco.MjData(model := with_device(robot, device))
    mujoco.mj_forward(model, data)
    left = device.modules[0]
    expected = place.rotation @ left.position + place.position
    np.testing.assert_allclose(data.body("ocs_left_flywheel").xpos, expected, atol=1e-14)
    axis = place.rotation @ left.axis
    np.testing.assert_allclose(data.joint("ocs_left").xaxis, axis, atol=1e-14)


def test_defaults_and_compiler_of_the_user_do_not_affect_the_wheels(tmp_path):
    robot, device = read_mjcf(tmp_path), paper_device()
    model = with_device(robot, device)
    check_wheels_in_mujoco(model, device, robot.trunk)
    for name in ("ocs_left", "ocs_right"):
        joint = model.joint(name)
        assert joint.damping[0] == joint.armature[0] == joint.frictionloss[0] == 0.0
        assert not joint.limited[0]
    assert model.body("ocs_left_flywheel").mass[0] == device.flywheel.mass
    assert robot.mass == pytest.approx(7.0, rel=1e-12)
    assert model.body_subtreemass[1] == pytest.approx(7.0 + 2.0 * device.flywheel.mass, rel=1e-12)


@pytest.mark.parametrize(
    ("drive", "limit"),
    [
        (motor(), None),
        (motor(torque_limit=1.0), 1.0),
        (motor(stall_torque=2.0), 2.0),
        (motor(stall_torque=2.0, torque_limit=3.0), 2.0),
    ],
)
def test_motors_give_the_commanded_torque_up_to_their_limit(drive, limit):
    model = with_device(robot_by_hand(2.5, (0.03, 0.05, 0.07)), paper_device(drive=drive))
    actuator = model.actuator("ocs_left")
    assert bool(actuator.ctrllimited[0]) == (limit is not None)
    if limit is not None:
        np.testing.assert_array_equal(actuator.ctrlrange, [-limit, limit])
    data = mujoco.MjData(model)
    data.ctrl[:] = [0.5, -0.25]
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_actuator[-2:], [0.5, -0.25])


SENSOR = '<sensor><jointvel name="{}" joint="first"/></sensor>'
CLASHES = {
    "body": {'body name="first"': 'body name="ocs_left_flywheel"'},
    "body 'ocs_left_motor": {'body name="first"': 'body name="ocs_left_motor"'},
    "joint": {'joint name="first"': 'joint name="ocs_right"', 'joint="first"': 'joint="ocs_right"'},
    "actuator": {'motor name="first"': 'motor name="ocs_left"'},
    "geom": {'name="chest"': 'name="ocs_left_flywheel"'},
    "site": {"<freejoint/>": '<freejoint/><site name="ocs_imu"/>'},
    "sensor": {"<keyframe>": SENSOR.format("ocs_left_velocity") + "<keyframe>"},
    "sensor 'ocs_imu_rate": {"<keyframe>": SENSOR.format("ocs_imu_rate") + "<keyframe>"},
}
"""Elements of the robot renamed to those of the device, as replacements in `MJCF`."""


@pytest.mark.parametrize("kind", CLASHES)
def test_a_clash_of_names_is_an_error(tmp_path, kind):
    text = MJCF
    for original, clashing in CLASHES[kind].items():
        text = text.replace(original, clashing)
    element, _, name = kind.partition(" '")
    with pytest.raises(RobotError, match=f"{element} named '{name or 'ocs_'}") as error:
        robot_model(read_mjcf(tmp_path, text), driven_device())
    assert "rename" in error.value.hint
