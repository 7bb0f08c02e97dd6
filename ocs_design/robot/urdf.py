"""Reads a URDF into a tree of moving bodies, with the file's raw numbers.

Format: http://wiki.ros.org/urdf/XML/link and http://wiki.ros.org/urdf/XML/joint.

MuJoCo's own URDF reader is no substitute: it fuses the root link to the world and loses its mass.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement, rotation_from_rpy
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.common.wording import some_of
from ocs_design.robot.links import (
    Children,
    Connection,
    Link,
    Warnings,
    check_number_of_links,
    make_tree,
)
from ocs_design.robot.mass import NEGLIGIBLE_MOMENT, MassProperties
from ocs_design.robot.tree import Joint, JointKind, Shape, ShapeKind, Tree
from ocs_design.robot.xml import number, numbers, parse_xml, required, text, unexpanded_xacro

Color: TypeAlias = tuple[float, float, float, float]
"""Red, green, blue and opacity, each 0..1."""


def read_palette(root: ET.Element) -> Mapping[str, Color]:
    """Colours of the file's named materials, by their first definition."""
    palette: dict[str, Color] = {}
    for material in root.iter("material"):
        color = _color(material)
        if color is not None:
            palette.setdefault(material.get("name", ""), color)
    return palette


def color_of(visual: ET.Element, palette: Mapping[str, Color]) -> Color | None:
    """Colour of one `<visual>`: its own, or that of the material it names."""
    material = visual.find("material")
    if material is None:
        return None
    return _color(material) or palette.get(material.get("name", ""))


def _color(material: ET.Element) -> Color | None:
    color = material.find("color")
    if color is None:
        return None
    try:
        red, green, blue, opacity = (float(part) for part in color.get("rgba", "").split())
    except ValueError:
        return None
    values = (red, green, blue, opacity)
    return values if all(0.0 <= value <= 1.0 for value in values) else None


def _check_unique(names: Iterable[str], what: str) -> None:
    """Refuse names that occur twice."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise RobotError(f"two {what}s are named {name!r}", hint="rename one of them")
        seen.add(name)


def children_by_parent(links: Mapping[str, Link], connections: Sequence[Connection]) -> Children:
    """The joints below each link, in file order; every link has at most one parent."""
    children: dict[str, list[Connection]] = {}
    above: dict[str, Connection] = {}
    for connection in connections:
        for link in (connection.parent, connection.child):
            if link not in links:
                raise RobotError(
                    f"joint {connection.name!r} names a link that is not in the file: {link!r}",
                    hint=f"correct the name or add the link; there are {_quoted(links)}",
                )
        if connection.child in above:
            raise RobotError(
                f"link {connection.child!r} is the child of two joints, "
                f"{above[connection.child].name!r} and {connection.name!r}: a loop",
                hint="a URDF is a tree: cut the loop by removing one of the two joints",
            )
        above[connection.child] = connection
        children.setdefault(connection.parent, []).append(connection)
    return children


def find_base(links: Mapping[str, Link], children: Children) -> str:
    """The floating base: the one link without a parent, from which all others can be reached.

    If it has no mass and only a `floating` joint below it, the child of that joint.
    """
    below = {connection.child for siblings in children.values() for connection in siblings}
    roots = [name for name in links if name not in below]
    if len(roots) > 1:
        raise RobotError(
            f"the file contains {len(roots)} separate trees, with the roots {_quoted(roots)}",
            hint="join them with a fixed joint, or remove what is not part of the robot",
        )
    reached: set[str] = set()
    stack = list(roots)
    while stack:
        name = stack.pop()
        reached.add(name)
        stack.extend(connection.child for connection in children.get(name, ()))
    lost = [name for name in links if name not in reached]
    if lost:
        raise RobotError(
            f"the links {_quoted(lost)} form a loop of joints",
            hint="a URDF is a tree: cut the loop by removing one of its joints",
        )
    base = roots[0]
    while links[base].mass_properties is None:
        siblings = children.get(base, ())
        if len(siblings) != 1 or not siblings[0].held:
            break
        base = siblings[0].child
    return base


def _quoted(names: Iterable[str]) -> str:
    return some_of([repr(name) for name in names])


FindMesh = Callable[[str], Path | None]
"""Function that finds the file of a mesh's `filename`; None if it does not exist."""


def read_link(
    element: ET.Element, find_mesh: FindMesh, palette: Mapping[str, Color], warnings: Warnings
) -> Link:
    """Name, mass properties and shapes of a `<link>`."""
    name = text(element, "name", "a link")
    inertial, where, properties = element.find("inertial"), f"link {name!r}", None
    if inertial is not None:
        origin = read_origin(inertial, where)
        mass = number(required(inertial, "mass", where), "value", where)
        if mass < 0.0:
            raise RobotError(
                f"{where} has the negative mass {mass:g} kg", hint="correct its <mass value>"
            )
        moments = required(inertial, "inertia", where)
        ixx, iyy, izz = (number(moments, name, where) for name in ("ixx", "iyy", "izz"))
        if min(ixx, iyy, izz) < -NEGLIGIBLE_MOMENT:
            raise RobotError(
                f"{where} has a negative moment of inertia: ixx {ixx:g}, iyy {iyy:g}, izz {izz:g}",
                hint="correct its <inertia>; all three must be positive",
            )
        ixy, ixz, iyz = (
            number(moments, name, where, default=0.0) for name in ("ixy", "ixz", "iyz")
        )
        inertia = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        about_com = MassProperties(mass, np.zeros(3), inertia)
        properties = about_com.moved(origin.rotation, origin.position)
    return Link(name, properties, tuple(_read_shapes(element, name, find_mesh, palette, warnings)))


def read_origin(parent: ET.Element, where: str) -> Placement:
    """Placement given by the `<origin>` of an element; the identity without one."""
    origin = parent.find("origin")
    xyz = numbers(origin, "xyz", where, (0.0, 0.0, 0.0))
    if origin is not None and _QUATERNION in origin.attrib:
        if "rpy" in origin.attrib:
            raise RobotError(
                f"{where}: an <origin> has both rpy and {_QUATERNION}", hint="remove one of them"
            )
        x, y, z, w = numbers(origin, _QUATERNION, where, (0.0, 0.0, 0.0, 1.0))
        if not any((x, y, z, w)):
            raise RobotError(
                f"{where}: {_QUATERNION} of <origin> is all zero",
                hint=f'the identity is {_QUATERNION}="0 0 0 1"',
            )
        return Placement(rotation_from_quaternion([w, x, y, z]), xyz)
    return Placement(rotation_from_rpy(*numbers(origin, "rpy", where, (0.0, 0.0, 0.0))), xyz)


_QUATERNION = "quat_xyzw"
"""Attribute that replaces `rpy` since version 1.1 (ros/urdfdom, urdf_parser/src/pose.cpp)."""


def _read_shapes(
    link: ET.Element,
    name: str,
    find_mesh: FindMesh,
    palette: Mapping[str, Color],
    warnings: Warnings,
) -> Iterator[Shape]:
    where = f"link {name!r}"
    for element in (child for child in link if child.tag in {"visual", "collision"}):
        geometry = element.find("geometry")
        read = None if geometry is None else _read_geometry(geometry, where, find_mesh)
        if read is None:
            continue
        kind, size, mesh = read
        if kind is ShapeKind.MESH:
            # A negative scale mirrors the mesh.
            solid = all(size)
        elif kind is ShapeKind.CAPSULE:
            # A capsule without length is a sphere.
            solid = size[0] > 0.0 and size[1] >= 0.0
        else:
            solid = min(size) > 0.0
        if not solid:
            warnings.add("links with a shape of zero size, left out", name)
            continue
        place = read_origin(element, where)
        collides = element.tag == "collision"
        color = None if collides else color_of(element, palette)
        yield Shape(kind, size, place.position, place.rotation, name, collides, mesh, color)


def _read_geometry(
    geometry: ET.Element, where: str, find_mesh: FindMesh
) -> tuple[ShapeKind, tuple[float, ...], Path | None] | None:
    """Kind, size in MuJoCo's convention, and mesh file of the first known shape."""
    for shape in geometry:
        match shape.tag:
            case "box":
                edges = numbers(shape, "size", where, (0.0, 0.0, 0.0))
                return ShapeKind.BOX, tuple(float(edge) / 2 for edge in edges), None
            case "sphere":
                return ShapeKind.SPHERE, (number(shape, "radius", where),), None
            case "cylinder" | "capsule":
                half_length = number(shape, "length", where) / 2
                size = (number(shape, "radius", where), half_length)
                return ShapeKind(shape.tag), size, None
            case "mesh":
                scale = numbers(shape, "scale", where, (1.0, 1.0, 1.0))
                mesh = find_mesh(text(shape, "filename", where))
                return ShapeKind.MESH, tuple(float(factor) for factor in scale), mesh
    return None


_MOVING = {
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
}
_FREE_TYPES = ("floating", "planar")
_TYPES = (*_MOVING, "fixed", *_FREE_TYPES)


def read_connection(element: ET.Element, warnings: Warnings) -> Connection:
    """Parent, child and motion of a `<joint>`."""
    name = text(element, "name", "a joint")
    where = f"joint {name!r}"
    kind = text(element, "type", where)
    if kind not in _TYPES:
        raise RobotError(
            f"{where} has the unknown type {kind!r}", hint=f"known types: {', '.join(_TYPES)}"
        )
    return Connection(
        name,
        text(required(element, "parent", where), "link", where),
        text(required(element, "child", where), "link", where),
        read_origin(element, where),
        _read_joint(element, name, kind, warnings) if kind in _MOVING else None,
        held=kind if kind in _FREE_TYPES else "",
    )


def _read_joint(element: ET.Element, name: str, kind: str, warnings: Warnings) -> Joint:
    where = f"joint {name!r}"
    axis = numbers(element.find("axis"), "xyz", where, (1.0, 0.0, 0.0))
    length = np.linalg.norm(axis)
    if length == 0.0:
        raise RobotError(
            f"{where} has an axis of zero length",
            hint='give a direction, as in <axis xyz="0 1 0"/>',
        )
    lower, upper, effort, velocity = -np.inf, np.inf, 0.0, 0.0
    limit = element.find("limit")
    if limit is not None:
        names = ("lower", "upper", "effort", "velocity")
        limits = [number(limit, attribute, where, default=0.0) for attribute in names]
        if np.isinf(limits).any():
            warnings.add("joints with an infinite <limit>, which ROS refuses", name)
        effort, velocity = limits[2:]
        if kind != "continuous":
            lower, upper = limits[:2]
    elif kind != "continuous":
        warnings.add("joints without a <limit>, which ROS refuses, read as unlimited", name)
    if lower >= upper:
        warnings.add("joints whose lower limit is not below the upper, read as unlimited", name)
        lower, upper = -np.inf, np.inf
    damping, friction = 0.0, 0.0
    dynamics = element.find("dynamics")
    if dynamics is not None:
        damping = number(dynamics, "damping", where, default=0.0)
        friction = number(dynamics, "friction", where, default=0.0)
    leader = None
    mimic = element.find("mimic")
    if mimic is not None:
        multiplier = number(mimic, "multiplier", where, default=1.0)
        offset = number(mimic, "offset", where, default=0.0)
        leader = (text(mimic, "joint", where), multiplier, offset)
    return Joint(
        name,
        _MOVING[kind],
        axis / length,
        lower,
        upper,
        # Exporters write 0 for an unknown limit.
        effort=effort if effort > 0.0 else np.inf,
        velocity=velocity if velocity > 0.0 else np.inf,
        damping=damping,
        friction=friction,
        mimic=leader,
    )


_LARGEST_ANGLE = 4.0 * np.pi
"""Largest roll, pitch or yaw believed to be in radians: two turns."""


def read_urdf(content: bytes, *, find_mesh: FindMesh) -> Tree:
    """The moving bodies of a URDF, with warnings of its oddities.

    Args:
        content: the file, unzipped.
        find_mesh: returns the file of a mesh's `filename`, or None if it does not exist.
    """
    warnings = Warnings()
    root = parse_xml(content, warnings)
    # Other XML is refused, each kind with its own hint.
    if root.tag == "sdf":
        raise RobotError(
            "the file is SDF (Gazebo), which cannot be read",
            hint="give the URDF from which it was made, or convert it to URDF",
        )
    if root.tag in {"mujoco", "mujocoinclude"}:
        raise RobotError("the file is MJCF, not URDF", hint="give the model's main MJCF file")
    if root.tag != "robot":
        raise RobotError(
            f"the file is XML but not a robot: its root element is <{root.tag}>",
            hint="give a URDF (<robot>) or MJCF (<mujoco>) file",
        )
    if is_xacro(root):
        raise unexpanded_xacro()
    if root.get("version", "1.0") == "1.0":
        _ignore_quaternions(root, warnings)
    palette, elements = read_palette(root), root.findall("link")
    check_number_of_links(len(elements))
    if not elements:
        raise RobotError(
            "the <robot> has no <link>",
            hint="this happens with a xacro file that only defines macros: "
            "expand the file that uses them",
        )
    read = [read_link(element, find_mesh, palette, warnings) for element in elements]
    _check_unique((link.name for link in read), "link")
    links = {link.name: link for link in read}
    for link in read:
        if link.shapes and link.mass_properties is None:
            warnings.add("links with a shape but no <inertial>, read as massless", link.name)
    connections = [read_connection(element, warnings) for element in root.findall("joint")]
    _check_unique((connection.name for connection in connections), "joint")
    children = children_by_parent(links, connections)
    base = find_base(links, children)
    for part in root:
        name = part.get("name", "")
        angles = [numbers(origin, "rpy", name, (0.0, 0.0, 0.0)) for origin in part.iter("origin")]
        if angles and np.abs(angles).max() > _LARGEST_ANGLE:
            warnings.add("frames turned by more than two turns (angles in degrees?)", name)
    return make_tree(root.get("name") or base, base, links, children, warnings)


def _ignore_quaternions(root: ET.Element, warnings: Warnings) -> None:
    """Ignore quaternions in a file of version 1.0, which has none, as ROS does."""
    for part in root:
        for origin in part.iter("origin"):
            if origin.attrib.pop(_QUATERNION, None) is not None:
                warnings.add(
                    f'{_QUATERNION} without version="1.1" of <robot>, ignored as in ROS',
                    part.get("name", ""),
                )


def is_xacro(root: ET.Element) -> bool:
    """Whether a `<robot>` still contains xacro elements or expressions."""
    if any("xacro" in element.tag for element in root.iter()):
        return True
    parts = [*root.findall("link"), *root.findall("joint")]
    return any(
        "${" in value or "$(" in value
        for part in parts
        for element in part.iter()
        for value in element.attrib.values()
    )
