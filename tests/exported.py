"""Robots of every kind for tests of exports, and checks of them by MuJoCo and Pinocchio."""

from functools import cache

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from mass_oracles import (
    assert_same_mass_properties,
    mujoco_mass_properties,
    pinocchio_mass_properties,
)
from pinocchio_robots import configuration
from robots import ROBOTS
from wheels import braked_inertia

from ocs_design.export.mjcf import export_robot_mjcf
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.reader import read_robot

LEGGED = [
    "solo_description/robots/solo12",
    "a1_description/urdf/a1",
    "anymal_c_simple_description/urdf/anymal",
    "go2_description/urdf/go2",
    "hyq_description/robots/hyq_no_sensors",
    "bolt_description/robots/bolt",
    "talos_data/robots/talos_reduced",
    "romeo_description/urdf/romeo",
]
LEGGED_PATHS = [ROBOTS / f"{name}.urdf" for name in LEGGED]

MJCF = """<mujoco model="walker">
  <compiler angle="degree"/>
  <default><joint damping="0.2" armature="0.01"/></default>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="trunk" pos="0 0 0.512345678901">
      <freejoint/>
      <geom type="box" size="0.2123456789 0.1 0.05" density="512.3456789"/>
      <frame pos="0.1111111111 0 0" euler="10 0 0">
        <body name="front" pos="0.01 0.1234567891 0" euler="0 12.3456789 0">
          <joint name="abduct" axis="1 0 0" range="-50.123456789 60"/>
          <joint name="swing" axis="0 1 1" pos="0 0 0.0123456789" range="-33.3333333 44"/>
          <geom type="capsule" fromto="0 0 0 0 0 -0.3123456789" size="0.02"/>
          <site name="tip" pos="0 0 -0.3123456789"/>
        </body>
      </frame>
      <body name="rear" pos="-0.2 0 0">
        <inertial pos="0.0123456789 0 0" mass="0.3123456789"
          fullinertia="0.00212345678 0.0031234567 0.0041234567 1.234567e-4 2e-4 -3e-4"/>
        <joint name="slide" type="slide" axis="0 0 1" range="-0.0123456789 0.1"/>
        <geom type="sphere" size="0.03"/>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="slide" joint2="swing" polycoef="0.0123456789 0.2 0 0 0" active="false"/>
  </equality>
  <actuator><position name="swing" joint="swing" kp="12.3456789" ctrlrange="-30 30"/></actuator>
  <keyframe><key name="home" qpos="0 0 0.6123456789 1 0 0 0 0.1123456789 0.2123456789 0.012"
    ctrl="0.3123456789"/></keyframe>
</mujoco>"""


@cache
def robot_at(path, posture=None):
    """A real robot, read once per process."""
    return read_robot(path, posture=posture)


def mujoco_model(robot, device, folder):
    """Robot with its device, written as MJCF and read back by MuJoCo."""
    path = export_robot_mjcf(robot_model(robot, device), folder / "robot.xml")
    return mujoco.MjModel.from_xml_path(str(path))


def pinocchio_model(text):
    """Pinocchio model of a URDF, with a free base."""
    return pin.buildModelFromXML(text, pin.JointModelFreeFlyer())


def check_wheels_in_pinocchio(model, device, trunk, prefix=""):
    """Check mass, inertia, axis and position of each wheel in the trunk link's frame, to 1e-9."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    base = data.oMf[model.getFrameId(trunk, pin.FrameType.BODY)]
    for module in device.modules:
        index = model.getJointId(f"{prefix}ocs_{module.name}")
        assert model.joints[index].shortname() == "JointModelRUBZ"
        placement = base.actInv(data.oMi[index])
        np.testing.assert_allclose(placement.rotation[:, 2], module.axis, rtol=0.0, atol=1e-9)
        wheel = model.inertias[index]
        centre = placement.act(wheel.lever)
        np.testing.assert_allclose(centre, module.position, rtol=0.0, atol=1e-9)
        check_moments(wheel.inertia, device)
        assert abs(wheel.mass / device.flywheel.mass - 1.0) < 1e-12


def check_moments(inertia, device):
    """Check a wheel's inertia in its own frame, z along the spin axis, its rotor a flat disc."""
    wheel = device.flywheel
    across = wheel.transverse_inertia + device.motor.rotor_inertia / 2.0
    expected = np.diag([across, across, wheel.spin_inertia])
    np.testing.assert_allclose(inertia, expected, rtol=0.0, atol=1e-12 * wheel.spin_inertia)


def check_wheels_in_mujoco(model, device, trunk):
    """Check mass, inertia, axis and position of each wheel in the trunk body's frame, to 1e-12."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    rotation = data.body(trunk).xmat.reshape(3, 3)
    for module in device.modules:
        name = f"ocs_{module.name}_flywheel"
        check_moments(np.diag(model.body(name).inertia), device)
        assert model.body(name).mass[0] == device.flywheel.mass
        axis = rotation.T @ data.joint(f"ocs_{module.name}").xaxis
        np.testing.assert_allclose(axis, module.axis, rtol=0.0, atol=1e-12)
        position = rotation.T @ (data.body(name).xipos - data.body(trunk).xpos)
        np.testing.assert_allclose(position, module.position, rtol=0.0, atol=1e-12)


def data_in_posture(model, posture):
    """MuJoCo's data with the joints in this posture."""
    data = mujoco.MjData(model)
    for name, value in posture.items():
        data.joint(name).qpos = value
    mujoco.mj_forward(model, data)
    return data


def total_by_mujoco(model, robot):
    """Mass properties of the whole model in the robot's posture, in the trunk's frame."""
    return mujoco_mass_properties(model, data_in_posture(model, robot.posture), robot.trunk)


def total_by_pinocchio(text, robot):
    """Mass properties of a URDF in the robot's posture, its wheels at rest."""
    model = pinocchio_model(text)
    return pinocchio_mass_properties(model, configuration(model, robot.posture), robot.trunk)


def check_total(total, robot, device):
    """Check that mass properties are those of the robot with the braked device."""
    expected = braked_inertia(robot, device)
    assert expected.mass == pytest.approx(robot.mass + device.mass, rel=1e-12)
    assert_same_mass_properties(total, expected, 1e-9)
