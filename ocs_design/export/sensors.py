"""What a controller of the device measures, in MuJoCo: both wheels, and the trunk's attitude."""

import mujoco

from ocs_design.design import Device
from ocs_design.export.naming import (
    IMU,
    imu_sensors,
    joint_name,
    require_free,
    torque_sensor,
    velocity_sensor,
)
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.spec.model import trunk_body

_JOINT, _SITE = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_SITE


def add_sensors(spec: mujoco.MjSpec, robot: Robot, device: Device) -> None:
    """Add them behind the robot's own, which keep their places in `sensordata`.

    Args:
        spec: after `attach_device`; changed in place.
        robot: that the spec was built from.
        device: that was attached.
    """
    attitude, rate = imu_sensors()
    wanted = {
        name(module): (kind, _JOINT, joint_name(module))
        for module in device.modules
        for name, kind in (
            (velocity_sensor, mujoco.mjtSensor.mjSENS_JOINTVEL),
            (torque_sensor, mujoco.mjtSensor.mjSENS_JOINTACTFRC),
        )
    }
    wanted[attitude] = (mujoco.mjtSensor.mjSENS_FRAMEQUAT, _SITE, IMU)
    wanted[rate] = (mujoco.mjtSensor.mjSENS_GYRO, _SITE, IMU)
    require_free("sensor", (sensor.name for sensor in spec.sensors), wanted)
    _add_imu(spec, robot)
    for name, (kind, objtype, objname) in wanted.items():
        spec.add_sensor(name=name, type=kind, objtype=objtype, objname=objname)


def _add_imu(spec: mujoco.MjSpec, robot: Robot) -> None:
    """A site at the base frame B, where rates and attitude are those of the paper's law."""
    require_free("site", (site.name for site in spec.sites), (IMU,))
    trunk, base = trunk_body(spec, robot)
    trunk.add_site(name=IMU, pos=base.position, quat=quaternion(base.rotation))
