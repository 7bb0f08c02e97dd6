"""Links of a URDF: what they weigh and how they look.

Format: http://wiki.ros.org/urdf/XML/link.
"""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.links import Link
from ocs_design.robot.mass_properties import NEGLIGIBLE_MOMENT, MassProperties
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.rotations import rotation_from_rpy
from ocs_design.robot.tree import Placement, Shape, ShapeKind
from ocs_design.robot.urdf.colors import Color, color_of
from ocs_design.robot.urdf.xml import number, numbers, required, text

FindMesh = Callable[[str], Path | None]


def read_link(
    element: ET.Element, find_mesh: FindMesh, palette: Mapping[str, Color], remarks: Remarks
) -> Link:
    """One `<link>`."""
    name = text(element, "name", "a link")
    inertial = element.find("inertial")
    return Link(
        name,
        None if inertial is None else _read_inertial(inertial, f"link {name!r}"),
        tuple(_read_shapes(element, name, find_mesh, palette, remarks)),
    )


def read_origin(parent: ET.Element, where: str) -> Placement:
    """The `<origin>` of an element; the identity without one."""
    origin = parent.find("origin")
    xyz = numbers(origin, "xyz", where, (0.0, 0.0, 0.0))
    rpy = numbers(origin, "rpy", where, (0.0, 0.0, 0.0))
    return Placement(rotation_from_rpy(*rpy), xyz)


def _read_inertial(inertial: ET.Element, where: str) -> MassProperties:
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
    ixy, ixz, iyz = (number(moments, name, where, default=0.0) for name in ("ixy", "ixz", "iyz"))
    inertia = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return MassProperties(mass, np.zeros(3), inertia).moved(origin.rotation, origin.position)


def _read_shapes(
    link: ET.Element,
    name: str,
    find_mesh: FindMesh,
    palette: Mapping[str, Color],
    remarks: Remarks,
) -> Iterator[Shape]:
    where = f"link {name!r}"
    for element in (each for each in link if each.tag in {"visual", "collision"}):
        geometry = element.find("geometry")
        found = None if geometry is None else _read_geometry(geometry, where, find_mesh)
        if found is None:
            continue
        kind, size, mesh = found
        if not _has_extent(kind, size):
            remarks.add("links with a shape of no extent, left out", name)
            continue
        place = read_origin(element, where)
        collides = element.tag == "collision"
        color = None if collides else color_of(element, palette)
        yield Shape(kind, size, place.position, place.rotation, name, collides, mesh, color)


def _has_extent(kind: ShapeKind, size: tuple[float, ...]) -> bool:
    """Meshes may be mirrored by a negative scale; a capsule may be a sphere."""
    if kind is ShapeKind.MESH:
        return all(size)
    if kind is ShapeKind.CAPSULE:
        return size[0] > 0.0 and size[1] >= 0.0
    return min(size) > 0.0


def _read_geometry(
    geometry: ET.Element, where: str, find_mesh: FindMesh
) -> tuple[ShapeKind, tuple[float, ...], Path | None] | None:
    """Kind, size and mesh file of the first shape that is known, in MuJoCo's measures."""
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
