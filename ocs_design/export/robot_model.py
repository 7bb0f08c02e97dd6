"""The robot with its device in MuJoCo, as it is written and drawn."""

from dataclasses import dataclass
from pathlib import PurePath

import mujoco

from ocs_design.design import Device
from ocs_design.export.attach import attach_device
from ocs_design.export.naming import carrier_name, flywheel_names
from ocs_design.export.sensors import add_sensors
from ocs_design.export.standing import standing_visuals
from ocs_design.export.urdf import WHEEL_MESH, device_meshes
from ocs_design.robot.mjcf.spec import compiled
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.bodies import GEOM_TYPES, HIDDEN_GROUP, VISUAL_GROUP
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.spec.model import build_spec


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The whole robot, free in space, its device on its trunk.

    Attributes:
        spec: with the bytes of its meshes and textures.
        compiled: from `spec`.
        warnings: what the model has otherwise than the robot's file, one sentence each.
    """

    spec: mujoco.MjSpec
    compiled: mujoco.MjModel
    warnings: tuple[str, ...]


def robot_model(robot: Robot, device: Device) -> RobotModel:
    """Robot, wheels with their motors and sensors, and what the device looks like."""
    built = build_spec(robot)
    spec = built.spec
    attach_device(spec, robot, device)
    add_sensors(spec, robot, device)
    _add_meshes(spec, device)
    _draw_rims(spec, device)
    _draw_standing(spec, device)
    spec.compiler.saveinertial = True
    return RobotModel(spec, compiled(spec), built.warnings)


def _add_meshes(spec: mujoco.MjSpec, device: Device) -> None:
    for path, content in device_meshes(device).items():
        spec.assets[path.name] = content
        spec.add_mesh(name=path.stem, file=path.name)


def _draw_rims(spec: mujoco.MjSpec, device: Device) -> None:
    """Show the rim as it is; the cylinder that stands for it in contacts is hidden."""
    for name in flywheel_names(device):
        solid = spec.geom(name)
        solid.group = HIDDEN_GROUP
        _show(
            spec.body(name),
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=PurePath(WHEEL_MESH).stem,
            rgba=solid.rgba,
        )


def _draw_standing(spec: mujoco.MjSpec, device: Device) -> None:
    for module in device.modules:
        for visual in standing_visuals(device, module):
            geom = _show(
                spec.body(carrier_name(module)),
                type=GEOM_TYPES[visual.kind],
                pos=visual.place.position,
                quat=quaternion(visual.place.rotation),
                rgba=visual.color,
            )
            if visual.mesh is None:
                geom.size = [*visual.size, 0.0, 0.0][:3]
            else:
                geom.meshname = visual.mesh.stem


def _show(body: mujoco.MjsBody, **look: object) -> mujoco.MjsGeom:
    """Without mass and contact."""
    return body.add_geom(group=VISUAL_GROUP, contype=0, conaffinity=0, mass=0.0, **look)
