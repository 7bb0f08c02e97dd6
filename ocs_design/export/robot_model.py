"""MuJoCo model of the robot with its device, as exported and rendered."""

from dataclasses import dataclass
from pathlib import PurePath
from weakref import WeakKeyDictionary

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.device.bodies import PREFIX, device_bodies, flywheel_names, require_free
from ocs_design.device.device import Device
from ocs_design.export.attach import add_sensors, attach_device
from ocs_design.export.formats import Subject
from ocs_design.export.physics import (
    add_drives,
    flight_options,
    leg_joints,
    meet_no_link,
    set_gains,
    stand,
    standing_torques,
)
from ocs_design.export.stl import device_meshes
from ocs_design.export.visuals import WHEEL_MESH, still_visuals
from ocs_design.robot.links import unused_name
from ocs_design.robot.mjcf_spec import compiled
from ocs_design.robot.mujoco_bodies import GEOM_TYPES, HIDDEN_GROUP, VISUAL_GROUP, quaternion
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.robot import Robot, RobotFormat

HOME = f"{PREFIX}home"
"""Keyframe in which the robot stands in its nominal posture and its actuators carry its weight."""

FREE_JOINT = "floating_base_joint"
"""Name of the free joint if the robot's file gives none."""

HOLD = f"{PREFIX}hold_"
"""Prefix of the equalities that hold the joints outside the legs."""


@dataclass(frozen=True, eq=False)
class RobotModel:
    """Whole robot, free in space, with its device on its trunk.

    Attributes:
        spec: spec with the bytes of its meshes and textures.
        compiled: model compiled from `spec`.
        warnings: differences of the model from the robot's file, one sentence each.
        driven: whether its legs have the flights' drives; else it has its own actuators.
    """

    spec: mujoco.MjSpec
    compiled: mujoco.MjModel
    warnings: tuple[str, ...]
    driven: bool


_MODELS: WeakKeyDictionary[Subject, RobotModel] = WeakKeyDictionary()


def model_of(subject: Subject) -> RobotModel:
    """Model of the subject's robot and device, cached because several formats use it."""
    if subject not in _MODELS:
        _MODELS[subject] = robot_model(subject.carrier, subject.device)
    return _MODELS[subject]


def robot_model(robot: Robot, device: Device) -> RobotModel:
    """Model of robot, wheels, motors and sensors, with the shapes of the device."""
    built = build_spec(robot)
    spec = built.spec
    flight_options(spec)
    if robot.format is not RobotFormat.MJCF:
        # As in the flights. MJX also lacks contacts of cylinders with boxes and meshes.
        meet_no_link(spec)
        for pair in list(spec.excludes):
            spec.delete(pair)
    names = {joint.name for joint in spec.joints}
    for joint in spec.joints:
        if joint.type == mujoco.mjtJoint.mjJNT_FREE and not joint.name:
            joint.name = unused_name(FREE_JOINT, "", names)
    # A robot with its own actuators keeps them and gets no others.
    driven = not spec.actuators
    if driven:
        add_drives(spec, robot)
        # Every joint outside the legs is held in its posture, as in the flights.
        in_legs = leg_joints(robot)
        for name, held_joint in robot.tree.joints.items():
            if name not in in_legs and held_joint.mimic is None:
                kind = {"type": mujoco.mjtEq.mjEQ_JOINT, "objtype": mujoco.mjtObj.mjOBJ_JOINT}
                offset = robot.posture[name] - float(spec.joint(name).ref)
                spec.add_equality(name=HOLD + name, name1=name, data=[offset, *[0.0] * 11], **kind)
    attach_device(spec, robot, device)
    add_sensors(spec, robot, device)
    # Wheels and carriers get visual geoms without mass and contact.
    for path, content in device_meshes(device).items():
        spec.assets[path.name] = content
        spec.add_mesh(name=path.stem, file=path.name)
    quiet = {"group": VISUAL_GROUP, "contype": 0, "conaffinity": 0, "mass": 0.0}
    for name in flywheel_names(device):
        # The cylinder that represents the rim in contacts is hidden.
        solid = spec.geom(name)
        solid.group = HIDDEN_GROUP
        mesh, kind = PurePath(WHEEL_MESH).stem, mujoco.mjtGeom.mjGEOM_MESH
        spec.body(name).add_geom(type=kind, meshname=mesh, rgba=solid.rgba, **quiet)
    still = [body for body in device_bodies(device) if not body.joint]
    shown = [(body.name, visual) for body in still for visual in still_visuals(device, body.module)]
    for body, visual in shown:
        place = {"pos": visual.place.position, "quat": quaternion(visual.place.rotation)}
        look = {"type": GEOM_TYPES[visual.kind], "rgba": visual.color}
        geom = spec.body(body).add_geom(**place, **look, **quiet)
        if visual.mesh is None:
            geom.size = [*visual.size, 0.0, 0.0][:3]
        else:
            geom.meshname = visual.mesh.stem
    spec.compiler.saveinertial = True
    _add_home(spec, robot, driven=driven)
    return RobotModel(spec, compiled(spec), built.warnings, driven)


def _add_home(spec: mujoco.MjSpec, robot: Robot, *, driven: bool) -> None:
    """Add the keyframe of the standing robot; if `driven`, set the flights' gains."""
    require_free("keyframe", (key.name for key in spec.keys), (HOME,))
    model = compiled(spec)
    data = mujoco.MjData(model)
    height = stand(robot, model, data)
    names = leg_joints(robot)
    if driven:
        set_gains(model, data, robot)
        for name in names:
            spec.actuator(name).gainprm = model.actuator(name).gainprm
            spec.actuator(name).biasprm = model.actuator(name).biasprm
            spec.joint(name).damping[0] = model.joint(name).damping[0]
    torques = dict(zip(names, standing_torques(model, data, robot), strict=True))
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    data.qpos[model.jnt_qposadr[free] + 2] += height
    home = data.qpos.copy(), _holding_controls(model, data, torques)
    for index, key in enumerate(spec.keys if driven else ()):
        # In the file's own keyframes our drives have no commands and would pull all joints to zero.
        data.qpos[:] = model.key_qpos[index]
        key.ctrl = _holding_controls(model, data, {})
    spec.add_key(name=HOME, qpos=home[0], ctrl=home[1])


def _holding_controls(
    model: mujoco.MjModel, data: mujoco.MjData, torques: dict[str, float]
) -> FloatArray:
    """Commands with which actuators on joints give these torques at rest; 0 for the others.

    A servo's force is `gain u + b_0 + b_1 l` with the length `l = gear q`, an MjModel's
    `actuator_gainprm` and `actuator_biasprm`.
    """
    controls = np.zeros(model.nu)
    for index in np.flatnonzero(model.actuator_trntype == int(mujoco.mjtTrn.mjTRN_JOINT)):
        gain, bias = model.actuator_gainprm[index, 0], model.actuator_biasprm[index]
        gear, joint = model.actuator_gear[index, 0], model.joint(model.actuator_trnid[index, 0])
        simple = model.actuator_gaintype[index] == int(mujoco.mjtGain.mjGAIN_FIXED)
        if not simple or gain * gear == 0.0 or joint.type[0] == mujoco.mjtJoint.mjJNT_FREE:
            continue
        force = torques.get(joint.name, 0.0) / gear
        length = gear * float(data.qpos[joint.qposadr[0]])
        command = (force - bias[0] - bias[1] * length) / gain
        if model.actuator_ctrllimited[index]:
            command = np.clip(command, *model.actuator_ctrlrange[index])
        controls[index] = command
    return controls
