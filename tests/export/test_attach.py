"""The device on a MuJoCo model: where it is asked to be, and nothing else changed."""

import mujoco
import numpy as np
import pytest
from robots import ROBOTS, SOLO12
from wheels import motor, paper_device

from ocs_design.common.errors import RobotError
from ocs_design.device.bodies import WHEEL_CONTACT_BIT
from ocs_design.export.attach import attach_device
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


def check_wheels(model, robot, device):
    """Axes and positions against the trunk link's frame, with the robot's joints at zero."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    trunk = data.body("trunk" if robot.name != "solo" else robot.trunk)
    rotation = trunk.xmat.reshape(3, 3)
    for module in device.modules:
        wheel, joint = data.body(f"ocs_{module.name}_flywheel"), data.joint(f"ocs_{module.name}")
        np.testing.assert_allclose(rotation.T @ joint.xaxis, module.axis, atol=1e-14)
        position = rotation.T @ (wheel.xipos - trunk.xpos)
        np.testing.assert_allclose(position, module.position, atol=1e-14)
        moments = (device.flywheel.transverse_inertia,) * 2 + (device.flywheel.spin_inertia,)
        assert tuple(model.body(f"ocs_{module.name}_flywheel").inertia) == moments


@pytest.mark.parametrize("incidence", [0.0, 0.7, np.pi / 2])
def test_wheels_stand_where_the_device_has_them(incidence):
    robot = read_robot(SOLO12, posture="zero")
    device = paper_device(incidence)
    model = with_device(robot, device)
    check_wheels(model, robot, device)
    assert model.body_subtreemass[1] == pytest.approx(robot.mass + 2.0 * device.flywheel.mass)


def test_a_trunk_link_may_stand_off_its_moving_body():
    """B is the frame of the link that carries the device, not of what it is fixed to."""
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


def test_the_users_defaults_and_compiler_do_not_reach_the_wheels(tmp_path):
    robot, device = read_mjcf(tmp_path), paper_device()
    model = with_device(robot, device)
    check_wheels(model, robot, device)
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
def test_motors_give_newton_metres_up_to_their_limit(drive, limit):
    model = with_device(robot_by_hand(2.5, (0.03, 0.05, 0.07)), paper_device(drive=drive))
    actuator = model.actuator("ocs_left")
    assert bool(actuator.ctrllimited[0]) == (limit is not None)
    if limit is not None:
        np.testing.assert_array_equal(actuator.ctrlrange, [-limit, limit])
    data = mujoco.MjData(model)
    data.ctrl[:] = [0.5, -0.25]
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_actuator[-2:], [0.5, -0.25])


def test_wheels_meet_a_floor_that_has_their_bit_but_no_link():
    model = with_device(read_robot(SOLO12), paper_device())
    wheel = model.geom("ocs_left_flywheel")
    assert wheel.conaffinity[0] == WHEEL_CONTACT_BIT
    assert wheel.contype[0] == 0
    links = [i for i in range(model.ngeom) if "flywheel" not in model.geom(i).name]
    assert not np.any(model.geom_contype[links] & WHEEL_CONTACT_BIT)


@pytest.mark.parametrize(
    "text",
    [
        MJCF.replace('body name="first"', 'body name="ocs_left_flywheel"'),
        MJCF.replace('joint name="first"', 'joint name="ocs_right"').replace(
            'joint="first"', 'joint="ocs_right"'
        ),
        MJCF.replace('motor name="first"', 'motor name="ocs_left"'),
        MJCF.replace('name="chest"', 'name="ocs_left_flywheel"'),
    ],
    ids=["body", "joint", "actuator", "geom"],
)
def test_a_clash_of_names_is_an_error_that_says_so(tmp_path, text, request):
    with pytest.raises(RobotError, match=r"'ocs_(left|right)") as error:
        with_device(read_mjcf(tmp_path, text), paper_device())
    assert request.node.callspec.id in error.value.message
    assert "rename" in error.value.hint
