"""Bodies of the robot and its device, read from an exported GLB."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.export.meshes import Color
from ocs_design.export.snapshot import picture

_HEADER, _CHUNK = 12, 8
"""Sizes of the headers of a GLB and of its chunks [bytes] (glTF 2.0, section 4)."""

_COMPONENT_TYPES = {5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""NumPy types of the components of an accessor; our GLB files have no others."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles in one colour.

    Attributes:
        vertices: points in the frame of their body [m], shape (n, 3).
        faces: vertex indices of each triangle, shape (m, 3).
    """

    vertices: FloatArray
    faces: NDArray[np.int64]
    color: Color


@dataclass(frozen=True, eq=False)
class ShownBody:
    """Surfaces that move together.

    Attributes:
        name: name of the body in MuJoCo.
        placement: placement of its frame in B, in the posture of the file.
        surfaces: one for each colour.
    """

    name: str
    placement: Placement
    surfaces: tuple[Surface, ...]


def read_bodies(glb: bytes) -> tuple[ShownBody, ...]:
    """All bodies that have surfaces, in tree order, from a file written by `export.glb`.

    Nodes with a mesh are geoms, the others bodies; the root only turns the base frame upright.
    """
    length = int.from_bytes(glb[_HEADER : _HEADER + 4], "little")
    start = _HEADER + _CHUNK
    document: Mapping[str, Any] = json.loads(glb[start : start + length])
    nodes, buffer = document["nodes"], glb[start + length + _CHUNK :]

    def values(accessor: int) -> NDArray[Any]:
        """Values of an accessor, three in a row."""
        entry = document["accessors"][accessor]
        view = document["bufferViews"][entry["bufferView"]]
        content = buffer[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        return np.frombuffer(content, _COMPONENT_TYPES[entry["componentType"]]).reshape(-1, 3)

    def below(index: int, parent: Placement) -> Iterator[ShownBody]:
        """The body of a node, with one surface for all geoms of one colour, and those below it."""
        placement, children = parent @ _placement(nodes[index]), nodes[index].get("children", ())
        by_color: dict[Color, list[tuple[FloatArray, NDArray[np.int64]]]] = {}
        for geom in (nodes[child] for child in children if "mesh" in nodes[child]):
            frame = _placement(geom)
            for primitive in document["meshes"][geom["mesh"]]["primitives"]:
                points = values(primitive["attributes"]["POSITION"]).astype(np.float64)
                faces = values(primitive["indices"]).astype(np.int64)
                material = document["materials"][primitive["material"]]["pbrMetallicRoughness"]
                red, green, blue, opacity = material["baseColorFactor"]
                color = _srgb(red), _srgb(green), _srgb(blue), opacity
                in_body = points @ frame.rotation.T + frame.position
                by_color.setdefault(color, []).append((in_body, faces))
        surfaces = []
        for color, pieces in by_color.items():
            counts = np.cumsum([0, *(len(points) for points, _ in pieces)])
            shifted = [faces + first for (_, faces), first in zip(pieces, counts, strict=False)]
            vertices = np.concatenate([points for points, _ in pieces])
            surfaces.append(Surface(vertices, np.concatenate(shifted), color))
        if surfaces:
            yield ShownBody(nodes[index]["name"], placement, tuple(surfaces))
        for child in children:
            if "mesh" not in nodes[child]:
                yield from below(child, placement)

    (root,) = document["scenes"][0]["nodes"]
    trunks = nodes[root].get("children", ())
    return tuple(body for child in trunks for body in below(child, Placement.identity()))


def still_picture(bodies: Sequence[ShownBody]) -> NDArray[np.uint8]:
    """Picture of the bodies, for print, for mail and while the page loads (`picture`)."""
    shapes = []
    for body in bodies:
        place = body.placement
        for surface in body.surfaces:
            points = surface.vertices @ place.rotation.T + place.position
            shapes.append((points[surface.faces], surface.color))
    return picture(shapes)


def _placement(node: Mapping[str, Any]) -> Placement:
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    rotation = rotation_from_quaternion(np.array([w, x, y, z]))
    return Placement(rotation, np.array(node.get("translation", (0.0, 0.0, 0.0))))


def _srgb(intensity: float) -> float:
    """Colour code of a linear intensity in sRGB (IEC 61966-2-1), the inverse of the writer's."""
    code = 12.92 * intensity if intensity <= 0.0031308 else 1.055 * intensity ** (1.0 / 2.4) - 0.055
    return float(round(code, 4))
