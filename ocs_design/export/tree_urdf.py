"""A kinematic tree written as a URDF, for robots that came in another form."""

from collections.abc import Iterator
from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.export.device_urdf import UNLIMITED
from ocs_design.export.templates import numbers
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.rotations import rpy_from_rotation
from ocs_design.robot.spec.unused_name import unused_name
from ocs_design.robot.tree import Body, Joint, JointKind, Placement, Shape, ShapeKind, Tree


def tree_urdf(tree: Tree) -> str:
    """The robot as a URDF: masses, joints and primitive shapes in full double precision.

    Links that are rigidly joined come out as one that weighs what they weigh together, the others
    as frames without mass, so that every name of the file is still there. Meshes are left out.
    """
    root = ET.Element("robot", name=tree.name)
    names = [_name(body, tree) for body in tree.bodies]
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


def _name(body: Body, tree: Tree) -> str:
    """Of the link that moves with the body's joint: its own unless its frame stands elsewhere."""
    own = body.links[body.name]
    if np.array_equal(own.rotation, np.eye(3)) and not own.position.any():
        return body.name
    return unused_name(body.name, "_at_joint", tree.body_of_link)


def _link(name: str, body: Body) -> ET.Element:
    link = ET.Element("link", name=name)
    if body.mass_properties.mass > 0.0:
        link.append(_inertial(body.mass_properties))
    for shape in body.shapes:
        for geometry, place in _geometries(shape):
            element = ET.SubElement(link, "collision" if shape.collides else "visual")
            element.append(_origin(place))
            ET.SubElement(element, "geometry").append(geometry)
    return link


def _inertial(mass: MassProperties) -> ET.Element:
    inertial = ET.Element("inertial")
    inertial.append(_origin(Placement(np.eye(3), mass.com)))
    ET.SubElement(inertial, "mass", value=numbers(mass.mass))
    axes = "xyz"
    moments = {
        f"i{axes[i]}{axes[j]}": numbers(mass.inertia[i, j]) for i in range(3) for j in range(i, 3)
    }
    ET.SubElement(inertial, "inertia", moments)
    return inertial


def _geometries(shape: Shape) -> Iterator[tuple[ET.Element, Placement]]:
    """URDF shapes that make up a shape, each with its place; URDF has no capsule."""
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
    element = _connection(joint.name, _type(joint), parent, name, body.placement)
    ET.SubElement(element, "axis", xyz=numbers(joint.axis))
    if _type(joint) != "continuous":
        ET.SubElement(element, "limit", _limits(joint))
    dynamics = {"damping": numbers(joint.damping), "friction": numbers(joint.friction)}
    ET.SubElement(element, "dynamics", dynamics)
    if joint.mimic is not None:
        leader, multiplier, offset = joint.mimic
        follow = {"joint": leader, "multiplier": numbers(multiplier), "offset": numbers(offset)}
        ET.SubElement(element, "mimic", follow)
    return element


def _type(joint: Joint) -> str:
    if joint.kind is JointKind.PRISMATIC:
        return "prismatic"
    return "revolute" if np.isfinite([joint.lower, joint.upper]).all() else "continuous"


def _limits(joint: Joint) -> dict[str, str]:
    bounds = np.clip(
        [joint.lower, joint.upper, joint.effort, joint.velocity], -UNLIMITED, UNLIMITED
    )
    names = ("lower", "upper", "effort", "velocity")
    return {name: numbers(bound) for name, bound in zip(names, bounds, strict=True)}


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
