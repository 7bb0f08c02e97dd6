"""Robot with its device as a ROS 2 description package: URDF, xacro, ros2_control, launch file.

Names follow REP 144 (ROS package naming), the manifest REP 149 (package format 3).
"""

import json
import re
import shutil
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from urllib.parse import unquote
from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.common.files import safe_name
from ocs_design.device.bodies import joint_names
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.snippets import snippet_xacro
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.urdf import (
    MOCK_PLUGIN,
    control_joint,
    control_wheels,
    robot_urdf,
    write_meshes,
)
from ocs_design.robot.links import unused_name
from ocs_design.robot.robot import Robot
from ocs_design.robot.xml import parse_xml

_FOLDERS = ("config", "launch", "meshes", "rviz", "urdf")


def write(subject: Subject, folder: Path) -> Notes:
    """Write the package `<name>_ocs_description`."""
    robot, device, file = subject.carrier, subject.device, f"{subject.name}_ocs"
    package = package_name(subject.name)
    root = folder / package
    for folder_name in _FOLDERS:
        (root / folder_name).mkdir(parents=True)
    write_meshes(device, root)
    urdf = parse_xml(robot_urdf(robot, device))
    lost = _take_meshes(urdf, robot, root / "meshes", package)
    ET.indent(urdf)
    declared = '<?xml version="1.0" encoding="utf-8"?>\n'
    described = declared + ET.tostring(urdf, encoding="unicode") + "\n"
    # A robot may already use ros2_control, where a joint in two systems is an error.
    driven = {joint.get("name") for joint in urdf.findall(".//ros2_control//joint")}
    children = {child.get("link") for child in urdf.findall("joint/child")}
    links = (link.get("name", "") for link in urdf.findall("link"))
    values = {
        "package": package,
        "file": file,
        "name": subject.name,
        "robot": in_comment(subject.name),
        "count": str(len(device.modules)),
        "macro": f"{package.removesuffix('_description')}_ros2_control",
        "plugin": MOCK_PLUGIN,
        "root": json.dumps(next((link for link in links if link not in children), "")),
        "distance": numbers(5.2 * robot.mass_properties.gyration_radius + 1.0),
        **_controllers(robot, joint_names(device)),
    }
    controls = []
    for name, joint in robot.tree.joints.items():
        if name not in driven:
            limits = {"min": joint.lower, "max": joint.upper}
            bounds = {end: float(limit) for end, limit in limits.items() if np.isfinite(limit)}
            # A mimic joint takes no commands.
            command = "position" if joint.mimic is None else ""
            controls.append(control_joint(quoted(name), command, bounds, robot.posture[name]))
    controls += control_wheels(device, joint_names(device))
    system = {"name": "${name}", "plugin": "${hardware_plugin}", "joints": "".join(controls)}
    values["system"] = fill("ros2_control.urdf", system)
    texts = {
        "package.xml": fill("ros2/package.xml", values),
        "CMakeLists.txt": fill("ros2/CMakeLists.txt", values),
        "launch/display.launch.py": fill("ros2/display_launch", values),
        "rviz/display.rviz": fill("ros2/display.rviz", values),
        "config/controllers.yaml": fill("ros2/controllers.yaml", values),
        f"urdf/{file}.urdf": described,
        f"urdf/{file}.urdf.xacro": fill("ros2/robot.urdf.xacro", values),
        "urdf/ocs.urdf.xacro": snippet_xacro(device, subject.base),
        f"urdf/{file}.ros2_control.xacro": fill("ros2/ros2_control.xacro", values),
    }
    for place, text in texts.items():
        (root / place).write_text(text, encoding="utf-8", newline="\n")
    note = "package.xml has no maintainer and no license yet: add yours"
    remark = f"{len(lost)} meshes that were not found: {', '.join(lost)}"
    return (note, f"the ROS 2 package lacks {remark}") if lost else (note,)


def package_name(robot: str) -> str:
    """Package name of a robot: lower case, digits and single underscores, first a letter."""
    plain = re.sub(r"[^a-z0-9]+", "_", robot.lower()).strip("_")
    return f"{'' if plain[:1].isalpha() else 'robot_'}{plain}_ocs_description".replace("__", "_")


def _take_meshes(urdf: ET.Element, robot: Robot, folder: Path, package: str) -> list[str]:
    """Copy all meshes of a URDF and let it refer to the copies; returns those not found."""
    meshes = [shape.mesh for body in robot.tree.bodies for shape in body.shapes if shape.mesh]
    places = {path.name: path.name for path in folder.iterdir()}
    copies: dict[Path, str] = {}
    lost: dict[str, None] = {}

    def common_parts(path: Path) -> int:
        """Number of path components, counted from the end, that match the mesh's address."""
        pairs = zip(reversed(path.parts), reversed(name.parts), strict=False)
        return next((k for k, (a, b) in enumerate(pairs) if a != b), len(name.parts))

    for mesh in urdf.iter("mesh"):
        address = mesh.get("filename", "")
        name = PurePosixPath(unquote(address.strip()).rpartition("://")[2])
        # The device's own meshes are there already.
        place = places.get(name.name) if address == f"meshes/{name.name}" else None
        if place is None:
            # The file whose path matches the most components at the end of the address.
            path = max(meshes, key=common_parts, default=None)
            if path is None or not common_parts(path):
                lost[address] = None
                continue
            if path not in copies:
                stem = safe_name(path.stem)
                copies[path] = unused_name(stem, path.suffix, {*copies.values(), *places})
                shutil.copyfile(path, folder / copies[path])
            place = copies[path]
        mesh.set("filename", f"package://{package}/meshes/{place}")
    return list(lost)


def _controllers(robot: Robot, wheels: Iterable[str]) -> dict[str, str]:
    """Values for the template `controllers.yaml`."""
    moved = [name for name, joint in robot.tree.joints.items() if joint.mimic is None]
    manager, joints = "", ""
    if moved:
        kind = "joint_trajectory_controller/JointTrajectoryController"
        manager = f"    joint_controller:\n      type: {kind}\n"
        joints = (
            f"\njoint_controller:\n  ros__parameters:\n    joints:\n{_listed(moved)}    "
            "command_interfaces: [position]\n    state_interfaces: [position, velocity]"
        )
    return {"manager": manager, "wheels": _listed(wheels), "joints": joints}


def _listed(names: Iterable[str]) -> str:
    """YAML list items in double quotes, because some names would be read as numbers."""
    return "".join(f"      - {json.dumps(name)}\n" for name in names)
