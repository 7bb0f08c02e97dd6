"""Device on a robot's MuJoCo model: wheels with joints and motors, their carriers, and sensors.

It is attached to the robot's compiled spec, not pasted into its XML; simulations and files share
it.
"""

import mujoco

from ocs_design.device import bodies
from ocs_design.device.device import Device
from ocs_design.robot.mujoco_bodies import inertial, quaternion
from ocs_design.robot.mujoco_model import trunk_body
from ocs_design.robot.robot import Robot

_JOINT, _SITE = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_SITE
_TO_JOINT = mujoco.mjtTrn.mjTRN_JOINT


def attach_device(spec: mujoco.MjSpec, robot: Robot, device: Device) -> None:
    """Attach flywheels with their joints and motors, their carriers and the plate to the trunk.

    Args:
        spec: from `build_spec(robot)`; changed in place. Its keyframes keep the robot's values.
        robot: robot that the spec was built from.
        device: its wheels turn about the z axis of their own frames.
    """
    device_bodies, joints = list(bodies.device_bodies(device)), bodies.joint_names(device)
    bodies.require_free(
        "body", (body.name for body in spec.bodies), (body.name for body in device_bodies)
    )
    bodies.require_free("joint", (joint.name for joint in spec.joints), joints)
    bodies.require_free("actuator", (actuator.name for actuator in spec.actuators), joints)
    bodies.require_free("geom", (geom.name for geom in spec.geoms), bodies.flywheel_names(device))
    trunk, base = trunk_body(spec, robot)
    attached = mujoco.MjSpec()
    frame = attached.worldbody.add_frame()
    limit = bodies.largest_torque(device.motor)
    for device_body in device_bodies:
        mass_properties, _ = inertial(device_body.mass_properties)
        place = base @ device_body.place
        frames = {"pos": place.position, "quat": quaternion(place.rotation)}
        # Attaching prepends the prefix to the names.
        name = device_body.name.removeprefix(bodies.PREFIX)
        added = attached.worldbody.add_body(name=name, **frames, **mass_properties)
        added.set_frame(frame)
        if not device_body.joint:
            continue
        joint, kind = device_body.joint.removeprefix(bodies.PREFIX), mujoco.mjtJoint.mjJNT_HINGE
        turning = {"axis": (0.0, 0.0, 1.0), "armature": device.motor.armature}
        added.add_joint(name=joint, type=kind, **turning)
        size = device.flywheel.outer_radius, device.flywheel.height / 2.0, 0.0
        meets = {"contype": 0, "conaffinity": bodies.WHEEL_CONTACT_BIT}
        cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
        added.add_geom(name=name, type=cylinder, size=size, rgba=bodies.STEEL, **meets)
        actuator = attached.add_actuator(name=joint, target=joint, trntype=_TO_JOINT)
        actuator.set_to_motor()
        if limit is not None:
            actuator.ctrllimited = True
            actuator.ctrlrange = (-limit, limit)
    # Bodies added in any other way would shift the values of keyframes to wrong joints.
    trunk.attach_frame(frame, bodies.PREFIX, "")


def add_sensors(spec: mujoco.MjSpec, robot: Robot, device: Device) -> None:
    """Add sensors of the wheels and of the trunk's attitude to a spec that has the device.

    They come after the robot's own sensors, which keep their places in `sensordata`.
    """
    attitude, rate = bodies.IMU_SENSORS
    kinds = mujoco.mjtSensor.mjSENS_JOINTVEL, mujoco.mjtSensor.mjSENS_JOINTACTFRC
    sensors = {
        name: (kind, _JOINT, bodies.joint_name(module))
        for module in device.modules
        for name, kind in zip(bodies.wheel_sensors(module), kinds, strict=True)
    }
    sensors[attitude] = (mujoco.mjtSensor.mjSENS_FRAMEQUAT, _SITE, bodies.IMU)
    sensors[rate] = (mujoco.mjtSensor.mjSENS_GYRO, _SITE, bodies.IMU)
    bodies.require_free("sensor", (sensor.name for sensor in spec.sensors), sensors)
    # A site at the base frame B, where rates and attitude are those of the paper's law.
    bodies.require_free("site", (site.name for site in spec.sites), (bodies.IMU,))
    trunk, base = trunk_body(spec, robot)
    trunk.add_site(name=bodies.IMU, pos=base.position, quat=quaternion(base.rotation))
    for name, (kind, objtype, objname) in sensors.items():
        spec.add_sensor(name=name, type=kind, objtype=objtype, objname=objname)
