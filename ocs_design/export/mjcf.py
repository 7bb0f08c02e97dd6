"""The whole robot with its device as a MJCF model."""

from pathlib import Path, PurePath

import mujoco

from ocs_design.design import Device
from ocs_design.export.attach import attach_device
from ocs_design.export.mjcf_precision import precise_xml
from ocs_design.export.naming import flywheel_names
from ocs_design.export.stl import METRES, stl_bytes
from ocs_design.export.urdf import WHEEL_MESH
from ocs_design.robot.mjcf.spec import compiled
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.bodies import HIDDEN_GROUP, VISUAL_GROUP
from ocs_design.robot.spec.model import build_spec

_MESHES = PurePath(WHEEL_MESH).parent


def export_robot_mjcf(
    robot: Robot, device: Device, path: Path, remarks: Remarks | None = None
) -> Path:
    """Write the robot with both flywheels on its trunk, its meshes and textures beside it.

    The model refers to nothing outside its folder, which can be moved. It has no floor.

    Args:
        robot: that carries the device.
        device: to add.
        path: of the model.
        remarks: takes what the model has otherwise than the robot's file.
    """
    spec = robot_with_device(robot, device, remarks)
    spec.compiler.saveinertial = True
    text = precise_xml(spec, compiled(spec), assets=str(_MESHES))
    path.write_bytes(text.encode("utf-8"))
    _write_assets(spec, path.parent / _MESHES)
    return path


def robot_with_device(
    robot: Robot, device: Device, remarks: Remarks | None = None
) -> mujoco.MjSpec:
    """The model that is written: robot, wheels with their motors, and the rims to look at."""
    built = build_spec(robot)
    if remarks is not None:
        for sentence in built.warnings:
            remarks.add(sentence)
    attach_device(built.spec, robot, device)
    _draw_rims(built.spec, device)
    return built.spec


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


def _write_assets(spec: mujoco.MjSpec, folder: Path) -> None:
    for name, content in spec.assets.items():
        folder.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
