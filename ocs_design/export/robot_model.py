"""The robot with its device in MuJoCo, as it is written and drawn."""

from dataclasses import dataclass
from pathlib import PurePath

import mujoco

from ocs_design.design import Device
from ocs_design.export.attach import attach_device
from ocs_design.export.naming import flywheel_names
from ocs_design.export.sensors import add_sensors
from ocs_design.export.stl import METRES, stl_bytes
from ocs_design.export.urdf import WHEEL_MESH
from ocs_design.robot.mjcf.spec import compiled
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.bodies import HIDDEN_GROUP, VISUAL_GROUP
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
    """Robot, wheels with their motors and sensors, and the rims to look at."""
    built = build_spec(robot)
    spec = built.spec
    attach_device(spec, robot, device)
    add_sensors(spec, robot, device)
    _draw_rims(spec, device)
    spec.compiler.saveinertial = True
    return RobotModel(spec, compiled(spec), built.warnings)


def _draw_rims(spec: mujoco.MjSpec, device: Device) -> None:
    """Show the rim as it is; the cylinder that stands for it in contacts is hidden."""
    mesh = PurePath(WHEEL_MESH)
    spec.assets[mesh.name] = stl_bytes(device.flywheel, units_per_metre=METRES)
    spec.add_mesh(name=mesh.stem, file=mesh.name)
    for name in flywheel_names(device):
        solid = spec.geom(name)
        solid.group = HIDDEN_GROUP
        rim = spec.body(name).add_geom(
            type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.stem, rgba=solid.rgba
        )
        rim.group, rim.contype, rim.conaffinity = VISUAL_GROUP, 0, 0
