"""Reads a URDF into a tree of moving bodies, with the file's raw numbers.

MuJoCo's own URDF reader is no substitute: it fuses the root link to the world and loses its mass.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from xml.etree import ElementTree as ET

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.links import Connection, Link, check_number_of_links
from ocs_design.robot.files.lumping import lump
from ocs_design.robot.files.mimics import resolve_mimics
from ocs_design.robot.files.plausibility import check_plausible
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.tree import Tree
from ocs_design.robot.urdf.angles import remark_on_degrees
from ocs_design.robot.urdf.colors import read_palette
from ocs_design.robot.urdf.graph import children_by_parent, find_root, free_base, unique
from ocs_design.robot.urdf.joints import read_connection
from ocs_design.robot.urdf.links import FindMesh, read_link
from ocs_design.robot.urdf.xml import parse_xml, unexpanded_xacro


def read_urdf(content: bytes, *, find_mesh: FindMesh) -> Tree:
    """The robot of a URDF.

    Args:
        content: the file, unzipped.
        find_mesh: from a mesh's `filename` to the file, or None if it is not there.
    """
    remarks = Remarks()
    root = parse_xml(content, remarks)
    _check_is_urdf(root)
    links = _read_links(root, find_mesh, remarks)
    children = children_by_parent(links, _read_connections(root, remarks))
    base = free_base(find_root(links, children), links, children)
    bodies = resolve_mimics(lump(base, links, children, remarks), remarks)
    remark_on_degrees(root, remarks)
    tree = Tree(root.get("name") or base, bodies)
    check_plausible(tree, remarks)
    return replace(tree, warnings=remarks.sentences())


def _read_links(root: ET.Element, find_mesh: FindMesh, remarks: Remarks) -> Mapping[str, Link]:
    palette = read_palette(root)
    check_number_of_links(len(root.findall("link")))
    links = [read_link(element, find_mesh, palette, remarks) for element in root.findall("link")]
    if not links:
        raise RobotError(
            "the <robot> has no <link>",
            hint="a xacro file that only defines macros gives such a robot: "
            "expand the file that uses them",
        )
    unique((link.name for link in links), "link")
    for link in links:
        if link.shapes and link.mass_properties is None:
            remarks.add("links with a shape but no <inertial>, read as without mass", link.name)
    return {link.name: link for link in links}


def _read_connections(root: ET.Element, remarks: Remarks) -> Sequence[Connection]:
    connections = [read_connection(element, remarks) for element in root.findall("joint")]
    unique((connection.name for connection in connections), "joint")
    return connections


def _check_is_urdf(root: ET.Element) -> None:
    """Refuse other XML, each kind with its own cure."""
    if root.tag == "sdf":
        raise RobotError(
            "the file is SDF (Gazebo), which is not read",
            hint="give the URDF that it was made from, or convert it to URDF",
        )
    if root.tag in {"mujoco", "mujocoinclude"}:
        raise RobotError("the file is MJCF, not URDF", hint="give the model's main MJCF file")
    if root.tag != "robot":
        raise RobotError(
            f"the file is XML but no robot: its root element is <{root.tag}>",
            hint="give a URDF (<robot>) or MJCF (<mujoco>) file",
        )
    if is_xacro(root):
        raise unexpanded_xacro()


def is_xacro(root: ET.Element) -> bool:
    """Whether a `<robot>` still holds xacro's own elements or expressions."""
    if any("xacro" in element.tag for element in root.iter()):
        return True
    parts = [*root.findall("link"), *root.findall("joint")]
    return any(
        "${" in value for part in parts for each in part.iter() for value in each.attrib.values()
    )
