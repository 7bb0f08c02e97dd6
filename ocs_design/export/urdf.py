"""URDF: the device as elements, a user's URDF with the device, and robots of other formats.

A user's URDF is preserved byte for byte. Robots from other formats are written from the kinematic
tree that was read.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from pathlib import Path, PurePath
from xml.etree import ElementTree as ET
from xml.parsers import expat

import numpy as np

from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement, rpy_from_rotation
from ocs_design.device.bodies import DeviceBody, device_bodies, largest_torque, require_free
from ocs_design.device.device import Device
from ocs_design.export.formats import Base, Notes, Subject
from ocs_design.export.stl import device_meshes
from ocs_design.export.templates import fill, in_comment, numbers, quoted
from ocs_design.export.visuals import WHEEL_MESH, Visual, plain_visuals, still_visuals
from ocs_design.robot.leg_geometry import BASE_FRAME
from ocs_design.robot.links import unused_name
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Mount, Robot, RobotFormat
from ocs_design.robot.tree import Body, Joint, JointKind, Shape, ShapeKind, Tree
from ocs_design.robot.xml import parse_xml

UNLIMITED = 1e6
"""Torque or speed limit [SI] if URDF requires one and there is none."""

MOCK_PLUGIN = "mock_components/GenericSystem"
"""Mock hardware of ros2_control, which moves nothing."""


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

    A user's URDF is preserved byte for byte, with its references to meshes: those relative to the
    file are valid only in its folder. Other robots are written from what was read.
    """
    content = robot.content if robot.format is RobotFormat.URDF else tree_urdf(robot.tree).encode()
    root = parse_xml(content)
    # A URDF written from the tree already has the base frame.
    mount = robot.mount if robot.format is RobotFormat.URDF else None
    base, bodies = () if mount is None else (BASE_FRAME,), list(device_bodies(device))
    links, joints = [body.name for body in bodies], [body.joint or body.name for body in bodies]
    for kind, names in (("link", links), ("joint", joints)):
        taken = (element.get("name", "") for element in root.iter(kind))
        require_free(kind, taken, (*names, *base))
    trunk = in_comment(robot.trunk)
    heading = f"  <!-- Orientation control system on {trunk}, by ocs-design. -->\n"
    frame = "" if mount is None else mount_urdf(mount)
    elements = device_urdf(device, robot.trunk, mesh=WHEEL_MESH)
    return insert_before_end(content, heading + frame + elements)


def urdf_notes(robot: Robot) -> Notes:
    """Notes for users of the written URDF."""
    if robot.format is not RobotFormat.URDF:
        return ()
    meshes = {mesh.get("filename", "") for mesh in parse_xml(robot.content).iter("mesh")}
    relative = [name for name in meshes if "://" not in name and not PurePath(name).is_absolute()]
    if not relative:
        return ()
    return (
        f"the URDF with the device names {len(relative)} of its meshes relative to the robot's own "
        "file, as that does: to see them, copy it and its meshes folder next to that file",
    )


def insert_before_end(content: bytes, addition: str) -> bytes:
    """Content of an XML file with `addition` inserted before the end tag of its root element.

    Args:
        content: a well-formed XML file in any encoding that expat knows, or in undeclared Latin-1.
        addition: elements, one per line, with line feeds; these become CRLF if the file has CRLF,
            and the text is written in the file's encoding.
    """
    try:
        place = _offset_of_root_end(content, None)
    except expat.ExpatError:
        # Undeclared Latin-1 or Windows-1252: one byte per character, as the reader assumed.
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
    """Byte offset of the root's end tag, from expat, which skips comments and CDATA."""
    parser = expat.ParserCreate(encoding)
    ends: list[int] = []
    parser.EndElementHandler = lambda _: ends.append(parser.CurrentByteIndex)
    parser.Parse(content, True)
    if not content[ends[-1] :].startswith((b"</", b"<\0/", b"\0<\0/")):
        raise RobotError("the robot's root element is empty", hint="give a robot with links")
    return ends[-1]


def _encoded(text: str, unit: str) -> bytes:
    """Text in an encoding; characters that it lacks become XML character references."""
    return text.encode(unit, errors="xmlcharrefreplace")


def trunk_link(base: Base) -> str:
    """Name of the robot's own link that carries the device."""
    return base.trunk if base.mount is None else base.mount.link


def mount_urdf(mount: Mount) -> str:
    """Base frame as a link fixed to the robot's own link, if no link has x forward and z up."""
    names = {"link": BASE_FRAME, "parent": quoted(mount.link)}
    return fill("base_frame.urdf", {**names, **place_values(mount.placement)})


def device_urdf(device: Device, parent: str, *, mesh: str | None = None) -> str:
    """Flywheels and their carriers on `parent` as URDF elements, indented by two spaces.

    `mesh` is the path of the wheel's mesh in metres, with those of `still_meshes` beside it;
    without one the visuals are cylinders and boxes.
    """
    looks = plain_visuals if mesh is None else still_visuals
    wheel, elements = device.flywheel, []
    solid = cylinder_urdf(wheel.outer_radius, wheel.height)
    for body in device_bodies(device):
        values = body_values(body, quoted(parent))
        if body.joint:
            values["limit"], values["collision"] = limit_urdf(device), solid
            values["visual"] = solid if mesh is None else f'<mesh filename="{quoted(mesh)}"/>'
            elements.append(fill("flywheel.urdf", values))
        else:
            values["visuals"] = visuals_urdf(looks(device, body.module))
            elements.append(fill("carrier.urdf", values))
    return "".join(elements)


def body_values(body: DeviceBody, parent: str) -> dict[str, str]:
    """Names, place and mass properties of a body, for templates."""
    return {
        **inertial_values(body.mass_properties),
        "link": body.name,
        "joint": body.joint,
        "parent": parent,
        "position": numbers(body.position),
        "rpy": numbers(body.rpy),
    }


def visuals_urdf(visuals: Iterable[Visual]) -> str:
    """Visual elements of a link."""
    elements = []
    for visual in visuals:
        match visual.kind:
            case ShapeKind.BOX:
                geometry = f'<box size="{numbers(2.0 * np.array(visual.size))}"/>'
            case ShapeKind.CYLINDER:
                radius, half = visual.size
                geometry = cylinder_urdf(radius, 2.0 * half)
            case _:
                geometry = f'<mesh filename="{visual.mesh}"/>'
        elements.append(fill("visual.urdf", {**visual_values(visual), "geometry": geometry}))
    return "".join(elements)


def visual_values(visual: Visual) -> dict[str, str]:
    """Name, place and colour of a visual shape, for templates."""
    color = numbers(visual.color)
    return {"name": visual.name, "color": color, **place_values(visual.place)}


def place_values(place: Placement) -> dict[str, str]:
    """Position and angles of a frame, for templates."""
    rpy = numbers(rpy_from_rotation(place.rotation))
    return {"position": numbers(place.position), "rpy": rpy}


def inertial_values(body: MassProperties) -> dict[str, str]:
    """Mass properties of a body, for templates."""
    entries = zip(product("xyz", repeat=2), body.inertia.ravel(), strict=True)
    moments = {f"i{one}{other}": numbers(entry) for (one, other), entry in entries}
    return {"mass": numbers(body.mass), "com": numbers(body.com), **moments}


def cylinder_urdf(radius: float, length: float) -> str:
    """Cylinder as a geometry [m]."""
    return f'<cylinder radius="{numbers(radius)}" length="{numbers(length)}"/>'


def limit_urdf(device: Device) -> str:
    """Limits of the motor; URDF allows no speed limit without a torque limit, and no armature."""
    motor, torque = device.motor, largest_torque(device.motor)
    velocity = numbers(min(motor.top_speed, UNLIMITED))
    limit = "<!-- the motor's torque is not limited -->"
    if torque is not None:
        limit = f'<limit effort="{numbers(torque)}" velocity="{velocity}"/>'
    if motor.armature != 0.0:
        unstated = f"armature {numbers(motor.armature)} kg m^2, which URDF cannot state"
        limit += f"\n    <!-- {unstated} -->"
    return limit


def ros2_control_urdf(
    device: Device, joints: Iterable[str], *, name: str = "ocs", plugin: str = MOCK_PLUGIN
) -> str:
    """Motors for ros2_control, indented by two spaces: torque in; angle, speed and torque out.

    See control.ros.org, "ros2_control hardware interface types". All texts must be valid in XML:
    `joints` of the wheels, `name` of the system, and `plugin`, its hardware.
    """
    elements = "".join(control_wheels(device, joints))
    return fill("ros2_control.urdf", {"name": name, "plugin": plugin, "joints": elements})


def control_wheels(device: Device, joints: Iterable[str]) -> Iterator[str]:
    """Element of each wheel's joint, commanded by torque; arguments of `ros2_control_urdf`."""
    limit = largest_torque(device.motor)
    bounds = {} if limit is None else {"min": -limit, "max": limit}
    for joint in joints:
        yield control_joint(joint, "effort", bounds)


def control_joint(
    joint: str, command: str, bounds: Mapping[str, float], position: float | None = None
) -> str:
    """Element of ros2_control for one joint.

    Args:
        joint: its name, valid in XML.
        command: its command interface; empty: none.
        bounds: bounds of the command, `min` and `max`.
        position: initial position [rad or m]; None: not specified.
    """
    start = {} if position is None else {"initial_value": position}
    interface = f"      {_interface('command', command, bounds)}\n" if command else ""
    state = _interface("state", "position", start)
    values = {"joint": joint, "command": interface, "position": state}
    return fill("ros2_control_joint.urdf", values)


def _interface(kind: str, name: str, parameters: Mapping[str, float]) -> str:
    inside = "".join(
        f'<param name="{parameter}">{numbers(value)}</param>'
        for parameter, value in parameters.items()
    )
    tag = f"{kind}_interface"
    return f'<{tag} name="{name}">{inside}</{tag}>' if inside else f'<{tag} name="{name}"/>'


def tree_urdf(tree: Tree) -> str:
    """Kinematic tree as a URDF: masses, joints and primitive shapes in full double precision.

    Of rigidly joined links, one has the mass of all, and the others are frames without mass, so
    that every name of the file is kept. Meshes are left out.
    """
    root = ET.Element("robot", name=tree.name)
    # A body is named after its own link unless the link's frame differs from the body's.
    names = []
    for body in tree.bodies:
        own = body.links[body.name]
        same = np.array_equal(own.rotation, np.eye(3)) and not own.position.any()
        names.append(body.name if same else unused_name(body.name, "_at_joint", tree.body_of_link))
    for name, body in zip(names, tree.bodies, strict=True):
        link = ET.SubElement(root, "link", name=name)
        mass = body.mass_properties
        if mass.mass > 0.0:
            inertial = ET.SubElement(link, "inertial")
            inertial.append(_origin(Placement(np.eye(3), mass.com)))
            ET.SubElement(inertial, "mass", value=numbers(mass.mass))
            values = inertial_values(mass)
            moments = {key: values[key] for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
            ET.SubElement(inertial, "inertia", moments)
        for shape in body.shapes:
            for geometry, place in _geometries(shape):
                element = ET.SubElement(link, "collision" if shape.collides else "visual")
                element.append(_origin(place))
                ET.SubElement(element, "geometry").append(geometry)
        if body.joint is not None:
            root.append(_joint(name, body, body.joint, names[body.parent]))
        for frame, place in body.links.items():
            if frame != name:
                ET.SubElement(root, "link", name=frame)
                fixed = unused_name(frame, "_fixed", tree.joints)
                root.append(_connection(fixed, "fixed", name, frame, place))
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _geometries(shape: Shape) -> Iterator[tuple[ET.Element, Placement]]:
    """URDF shapes that make up a shape, each with its placement; URDF has no capsule."""
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
        bounds = np.clip([getattr(joint, key) for key in names], -UNLIMITED, UNLIMITED)
        limits = {key: numbers(bound) for key, bound in zip(names, bounds, strict=True)}
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
    values = place_values(place)
    return ET.Element("origin", xyz=values["position"], rpy=values["rpy"])
