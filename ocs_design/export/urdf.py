"""The whole robot with its device as a URDF."""

from collections.abc import Mapping
from pathlib import Path, PurePath

from ocs_design.design import Device
from ocs_design.export.device_urdf import device_urdf, mount_urdf
from ocs_design.export.insertion import insert_before_end
from ocs_design.export.naming import carrier_names, flywheel_names, joint_names, require_free
from ocs_design.export.standing import standing_meshes
from ocs_design.export.stl import METRES, stl_bytes
from ocs_design.export.templates import in_comment
from ocs_design.export.tree_urdf import tree_urdf
from ocs_design.parts.stl import mesh_stl
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot.stance.base_frame import BASE_FRAME
from ocs_design.robot.urdf.xml import parse_xml

WHEEL_MESH = "meshes/ocs_flywheel.stl"
"""Beside every exported robot file."""


def export_robot_urdf(robot: Robot, device: Device, path: Path) -> Path:
    """Write the robot with both flywheels on its trunk, and its meshes beside it.

    A URDF robot stays as it is byte for byte, its references to meshes too: those relative to the
    file hold only where the file stood. Other robots are written from what was read.

    Args:
        robot: that carries the device.
        device: to add.
        path: of the URDF.
    """
    content = robot.content if robot.format is Format.URDF else tree_urdf(robot.tree).encode()
    root = parse_xml(content, Remarks())
    base = () if robot.mount is None or robot.format is not Format.URDF else (BASE_FRAME,)
    carriers = carrier_names(device)
    links, joints = flywheel_names(device) + carriers, joint_names(device) + carriers
    for kind, names in (("link", links), ("joint", joints)):
        require_free(kind, (each.get("name", "") for each in root.iter(kind)), (*names, *base))
    heading = (
        f"  <!-- Orientation control system on {in_comment(robot.trunk)}, by ocs-design. -->\n"
    )
    elements = device_urdf(device, robot.trunk, mesh=WHEEL_MESH)
    # What is written from the tree has the base frame already.
    if robot.mount is not None and robot.format is Format.URDF:
        elements = mount_urdf(robot.mount) + elements
    path.write_bytes(insert_before_end(content, heading + elements))
    _export_meshes(device, path.parent)
    return path


def urdf_remarks(robot: Robot) -> tuple[str, ...]:
    """What somebody must know who opens the written URDF, one sentence each."""
    if robot.format is not Format.URDF:
        return ()
    meshes = {mesh.get("filename", "") for mesh in parse_xml(robot.content, Remarks()).iter("mesh")}
    relative = [name for name in meshes if "://" not in name and not PurePath(name).is_absolute()]
    if not relative:
        return ()
    return (
        f"the URDF with the device names {len(relative)} of its meshes relative to the robot's own "
        "file, as that does: to see them, copy it and its meshes folder beside that file",
    )


def device_meshes(device: Device) -> Mapping[Path, bytes]:
    """The wheel, and what stands still, in metres, where the robot files look for them."""
    wheel = {Path(WHEEL_MESH): stl_bytes(device.flywheel, units_per_metre=METRES)}
    standing = {
        path: mesh_stl(mesh, path.stem, units_per_metre=METRES)
        for path, mesh in standing_meshes(device).items()
    }
    return {**wheel, **standing}


def _export_meshes(device: Device, folder: Path) -> None:
    for place, content in device_meshes(device).items():
        path = folder / place
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
