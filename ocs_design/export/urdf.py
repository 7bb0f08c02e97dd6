"""Whole robot with its device as a URDF: a user's file with additions, or written anew.

A user's URDF stays as it is byte for byte. Robots that came in another form are written from the
kinematic tree that was read.
"""

from collections.abc import Iterator
from pathlib import Path, PurePath
from xml.etree import ElementTree as ET
from xml.parsers import expat

import numpy as np

from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement, rpy_from_rotation
from ocs_design.device.bodies import carrier_names, flywheel_names, joint_names, require_free
from ocs_design.device.device import Device
from ocs_design.export.device_urdf import UNLIMITED, device_urdf, mount_urdf
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.stl import device_meshes
from ocs_design.export.templates import in_comment, numbers
from ocs_design.export.visuals import WHEEL_MESH
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.links import unused_name
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot.tree import Body, Joint, JointKind, Shape, ShapeKind, Tree
from ocs_design.robot.xml import parse_xml


def write(subject: Subject, folder: Path) -> Notes:
    """Write `<name>_ocs.urdf` and its meshes."""
    robot, device = subject.carrier, subject.device
    (folder / f"{subject.name}_ocs.urdf").write_bytes(robot_urdf(robot, device))
    write_meshes(device, folder)
    return urdf_notes(robot)


def write_meshes(device: Device, folder: Path) -> None:
    """Write the device's meshes to their places in the folder of a robot file."""
    for place, mesh in device_meshes(device).items():
        target = folder / place
        target.parent.mkdir(exist_ok=True)
        target.write_bytes(mesh)


def robot_urdf(robot: Robot, device: Device) -> bytes:
    """Text of the robot with the flywheels on its trunk.

    A URDF robot stays as it is byte for byte, its references to meshes too: those relative to the
    file hold only where the file stood. Other robots are written from what was read.
    """
    content = robot.content if robot.format is Format.URDF else tree_urdf(robot.tree).encode()
    root = parse_xml(content)
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
    return insert_before_end(content, heading + elements)


def urdf_notes(robot: Robot) -> Notes:
    """Advice for whoever opens the written URDF."""
    if robot.format is not Format.URDF:
        return ()
    meshes = {mesh.get("filename", "") for mesh in parse_xml(robot.content).iter("mesh")}
    relative = [name for name in meshes if "://" not in name and not PurePath(name).is_absolute()]
    if not relative:
        return ()
    return (
        f"the URDF with the device names {len(relative)} of its meshes relative to the robot's own "
        "file, as that does: to see them, copy it and its meshes folder beside that file",
    )


def insert_before_end(content: bytes, addition: str) -> bytes:
    """Content of an XML file with `addition` in front of the end tag of its root element.

    Args:
        content: a well-formed XML file in any encoding that expat knows, or in Latin-1 undeclared.
        addition: elements, one a line, each line ended by a line feed; becomes CRLF where the file
            has it, and is written in the file's encoding.
    """
    try:
        place = _offset_of_root_end(content, None)
    except expat.ExpatError:
        # Undeclared Latin-1 or Windows-1252: one byte a character, as the reader has taken it.
        place = _offset_of_root_end(content, "iso-8859-1")
    unit = "ascii"
    if content.startswith((b"\xff\xfe", b"<\0")):
        unit = "utf-16-le"
    elif content.startswith((b"\xfe\xff", b"\0<")):
        unit = "utf-16-be"
    newline = "\r\n" if _encoded("\r\n", unit) in content else "\n"
    if not content[:place].rstrip(b" \t\0").endswith(b"\n"):
        addition = "\n" + addition
    return content[:place] + _encoded(addition.replace("\n", newline), unit) + content[place:]


def _offset_of_root_end(content: bytes, encoding: str | None) -> int:
    """Offset of the root's end tag; expat is not fooled by comments and CDATA, and counts bytes."""
    parser = expat.ParserCreate(encoding)
    ends: list[int] = []
    parser.EndElementHandler = lambda _: ends.append(parser.CurrentByteIndex)
    parser.Parse(content, True)
    if not content[ends[-1] :].startswith((b"</", b"<\0/", b"\0<\0/")):
        raise RobotError("the robot's root element is empty", hint="give a robot with links")
    return ends[-1]


def _encoded(text: str, unit: str) -> bytes:
    """Text in an encoding; characters that it lacks become references, which XML takes anywhere."""
    return text.encode(unit, errors="xmlcharrefreplace")


def tree_urdf(tree: Tree) -> str:
    """Kinematic tree as a URDF: masses, joints and primitive shapes in full double precision.

    Links that are rigidly joined come out as one that weighs what they weigh together, the others
    as frames without mass, so that every name of the file is still there. Meshes are left out.
    """
    root = ET.Element("robot", name=tree.name)
    # The link that moves with a body's joint is its own unless its frame is elsewhere.
    names = [
        body.name
        if np.array_equal(own.rotation, np.eye(3)) and not own.position.any()
        else unused_name(body.name, "_at_joint", tree.body_of_link)
        for body in tree.bodies
        for own in (body.links[body.name],)
    ]
    for name, body in zip(names, tree.bodies, strict=True):
        root.append(_link(name, body))
        if body.joint is not None:
            root.append(_joint(name, body, body.joint, names[body.parent]))
        for frame, place in body.links.items():
            if frame != name:
                ET.SubElement(root, "link", name=frame)
                fixed = unused_name(frame, "_fixed", tree.joints)
                root.append(_connection(fixed, "fixed", name, frame, place))
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _link(name: str, body: Body) -> ET.Element:
    link = ET.Element("link", name=name)
    mass = body.mass_properties
    if mass.mass > 0.0:
        inertial = ET.SubElement(link, "inertial")
        inertial.append(_origin(Placement(np.eye(3), mass.com)))
        ET.SubElement(inertial, "mass", value=numbers(mass.mass))
        moments = {
            f"i{one}{other}": numbers(mass.inertia[i, j])
            for i, one in enumerate("xyz")
            for j, other in enumerate("xyz")
            if i <= j
        }
        ET.SubElement(inertial, "inertia", moments)
    for shape in body.shapes:
        for geometry, place in _geometries(shape):
            element = ET.SubElement(link, "collision" if shape.collides else "visual")
            element.append(_origin(place))
            ET.SubElement(element, "geometry").append(geometry)
    return link


def _geometries(shape: Shape) -> Iterator[tuple[ET.Element, Placement]]:
    """Shapes of URDF that make up a shape, each with its place; it has no capsule."""
    place = Placement(shape.rotation, shape.position)
    match shape.kind:
        case ShapeKind.BOX:
            yield ET.Element("box", size=numbers(2.0 * np.array(shape.size))), place
        case ShapeKind.SPHERE:
            yield ET.Element("sphere", radius=numbers(shape.size)), place
        case ShapeKind.CYLINDER | ShapeKind.CAPSULE:
            radius, half = shape.size
            size = {"radius": numbers(radius), "length": numbers(2.0 * half)}
            yield ET.Element("cylinder", size), place
            for end in (-half, half) if shape.kind is ShapeKind.CAPSULE else ():
                cap = Placement(np.eye(3), np.array([0.0, 0.0, end]))
                yield ET.Element("sphere", radius=numbers(radius)), place @ cap
        case ShapeKind.MESH:
            return


def _joint(name: str, body: Body, joint: Joint, parent: str) -> ET.Element:
    limited = bool(np.isfinite([joint.lower, joint.upper]).all())
    sliding = joint.kind is JointKind.PRISMATIC
    kind = "prismatic" if sliding else "revolute" if limited else "continuous"
    element = _connection(joint.name, kind, parent, name, body.placement)
    ET.SubElement(element, "axis", xyz=numbers(joint.axis))
    if kind != "continuous":
        names = ("lower", "upper", "effort", "velocity")
        bounds = np.clip([getattr(joint, each) for each in names], -UNLIMITED, UNLIMITED)
        limits = {each: numbers(bound) for each, bound in zip(names, bounds, strict=True)}
        ET.SubElement(element, "limit", limits)
    dynamics = {"damping": numbers(joint.damping), "friction": numbers(joint.friction)}
    ET.SubElement(element, "dynamics", dynamics)
    if joint.mimic is not None:
        leader, multiplier, offset = joint.mimic
        follow = {"joint": leader, "multiplier": numbers(multiplier), "offset": numbers(offset)}
        ET.SubElement(element, "mimic", follow)
    return element


def _connection(name: str, kind: str, parent: str, child: str, place: Placement) -> ET.Element:
    element = ET.Element("joint", name=name, type=kind)
    ET.SubElement(element, "parent", link=parent)
    ET.SubElement(element, "child", link=child)
    element.append(_origin(place))
    return element


def _origin(place: Placement) -> ET.Element:
    return ET.Element(
        "origin", xyz=numbers(place.position), rpy=numbers(rpy_from_rotation(place.rotation))
    )
