"""Robot, device, joint drives and floor as one compiled MuJoCo model."""

from enum import StrEnum

import mujoco
import numpy as np

from ocs_design.device.bodies import device_bodies, flywheel_names, joint_names
from ocs_design.device.device import Device
from ocs_design.export.attach import attach_device
from ocs_design.export.physics import (
    HELD_ARMATURE,
    add_drives,
    flight_options,
    hold_other_joints,
    meet_no_link,
)
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.mujoco_model import TIES, build_spec, trunk_body
from ocs_design.robot.robot import Robot
from ocs_design.simulation.world import ANCHOR

FLOOR = "ocs_floor"


def add_floor(spec: mujoco.MjSpec) -> None:
    """Add a plane at z = 0 that collides with every geom of the robot; no others collide."""
    meet_no_link(spec)
    spec.worldbody.add_geom(
        name=FLOOR,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 1],
        contype=1,
        conaffinity=0,
        margin=0.0,
        gap=0.0,
    )


JUMP_STEP = 5e-4
"""Time step of runs in which legs push off [s]. As they brake after lift-off they turn at 10 to
30 rad/s, and Runge-Kutta at 1 ms loses up to 4e-6 of the angular momentum; at half of that step,
twenty times less."""


class Wheels(StrEnum):
    """State of the wheels; in all of them models have the same sizes, and can run as one batch."""

    ACTIVE = "active"
    BRAKED = "braked"
    ABSENT = "absent"


class Sensor(StrEnum):
    """Sensors of the model, read at the start of each step."""

    CONTACT = "ocs_contact"
    COM = "ocs_com"
    MOMENTUM = "ocs_momentum"
    TRUNK = "ocs_trunk"


def robot_scene(robot: Robot) -> mujoco.MjSpec:
    """The bare robot over a floor, free to fall, with drives on its legs and sensors."""
    spec = build_spec(robot, visuals=False).spec
    # The robot's own controllers are not simulated.
    for element in [*spec.actuators, *spec.sensors, *spec.keys]:
        spec.delete(element)
    # Nor is the gravity compensation that stands in for them: only the floor bears its weight.
    for body in spec.bodies[1:]:
        body.gravcomp = 0.0
    # Posture and drives follow the tree, in which closed chains are cut open and joints are free
    # that an equality would hold still or couple nonlinearly.
    followers = {name for name, joint in robot.tree.joints.items() if joint.mimic is not None}
    for tie in list(spec.equalities):
        if tie.type in TIES or (tie.type == mujoco.mjtEq.mjEQ_JOINT and tie.name1 not in followers):
            spec.delete(tie)
    add_floor(spec)
    add_drives(spec, robot)
    hold_other_joints(spec, robot)
    kind, object_kind = mujoco.mjtSensor, mujoco.mjtObj
    # Heights are those of B's origin, which may be far from that of the trunk's body.
    trunk, base = trunk_body(spec, robot)
    trunk.add_site(name=Sensor.TRUNK.value, pos=base.position)
    root, site = robot.tree.bodies[0].name, Sensor.TRUNK.value
    # Data "found", no reduction, one slot: the sensor counts contacts with the floor.
    count_contacts = [1, 0, 1]
    for name, measured, of, target, parameters in (
        (Sensor.CONTACT, kind.mjSENS_CONTACT, object_kind.mjOBJ_GEOM, FLOOR, count_contacts),
        (Sensor.COM, kind.mjSENS_SUBTREECOM, object_kind.mjOBJ_BODY, root, [0, 0, 0]),
        (Sensor.MOMENTUM, kind.mjSENS_SUBTREEANGMOM, object_kind.mjOBJ_BODY, root, [0, 0, 0]),
        (Sensor.TRUNK, kind.mjSENS_FRAMEPOS, object_kind.mjOBJ_SITE, site, [0, 0, 0]),
    ):
        spec.add_sensor(name=name, type=measured, objtype=of, objname=target, intprm=parameters)
    flight_options(spec)
    # A state that is not finite must stay so and be reported, not be reset to the start.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    return spec


ANCHORED, _FREE_INERTIA = 1e7, 1e-10
"""Mass of an anchor, and its inertia about held axes, over the robot's, which set how little the
pivot yields; its inertia about free axes."""


def _anchor(spec: mujoco.MjSpec, robot: Robot, maneuver: Pivoted) -> None:
    """Hold a point or an edge of the trunk in place by a body without weight.

    The free joint stays, and with it the layout of the state. The body is so heavy that the centre
    of mass of the whole is at the pivot; for an edge its inertia across the edge is so large that
    the robot turns about the edge only. All joints of the robot are held, and nothing touches the
    floor.
    """
    trunk, base = trunk_body(spec, robot)
    mass = ANCHORED * robot.mass
    frame, inertia = np.eye(3), np.full(3, _FREE_INERTIA * np.trace(robot.inertia))
    if maneuver.axis is not None:
        up = np.array([0.0, 0.0, 1.0])
        frame = np.column_stack([up, np.cross(maneuver.axis, up), maneuver.axis])
        inertia[:2] *= ANCHORED / _FREE_INERTIA
    trunk.add_body(
        name=ANCHOR,
        pos=base.point(maneuver.pivot),
        quat=quaternion(base.rotation @ frame),
        mass=mass,
        inertia=inertia,
        ipos=np.zeros(3),
        iquat=[1.0, 0.0, 0.0, 0.0],
        explicitinertial=True,
        gravcomp=1.0,
    )
    for name in robot.tree.joints:
        joint = spec.joint(name)
        joint.armature, joint.frictionloss = HELD_ARMATURE, 0.0
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0


def compile_scene(
    scene: mujoco.MjSpec,
    robot: Robot,
    device: Device,
    wheels: Wheels,
    gravity: float,
    *,
    pivoted: Pivoted | None = None,
) -> mujoco.MjModel:
    """The scene with the device, and a pivot if given; `scene` itself is not changed."""
    spec = scene.copy()
    attach_device(spec, robot, device)
    if wheels is Wheels.ABSENT:
        # Massless, but still there: all worlds of a batch have the same sizes.
        for device_body in device_bodies(device):
            body = spec.body(device_body.name)
            body.mass, body.inertia = 1e-9, np.full(3, 1e-12)
    for name in flywheel_names(device):
        for geom in spec.body(name).geoms:
            geom.contype, geom.conaffinity = 0, 1
    spec.option.gravity = [0.0, 0.0, -gravity]
    if pivoted is not None:
        _anchor(spec, robot, pivoted)
    if wheels is not Wheels.ACTIVE:
        for name in joint_names(device):
            spec.joint(name).armature = HELD_ARMATURE
    model = spec.compile()
    if wheels is Wheels.ABSENT:
        # Only after compiling: a geom that collides with nothing would change the compiled sizes,
        # and the worlds of a batch share their working memory.
        flywheels = [model.body(name).id for name in flywheel_names(device)]
        model.geom_conaffinity[np.isin(model.geom_bodyid, flywheels)] = 0
    return model
