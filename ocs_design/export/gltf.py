"""Scenes in binary glTF 2.0 (Khronos, "glTF 2.0 Specification", sections 3 and 4).

Written by hand: a scene of meshes needs little of it, equal scenes give equal bytes, and reading
one needs no other file.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.tree import Placement

Color = tuple[float, float, float, float]
"""Red, green, blue and opacity, 0..1, as screens take them (sRGB)."""

_FLOAT, _UINT16, _UINT32 = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_MOST_UINT16 = 65535
"""Indices must stay below: the largest one restarts a primitive."""


@dataclass(frozen=True, eq=False)
class Triangles:
    """A surface.

    Attributes:
        vertices: [m], shape (n, 3).
        faces: corners of each triangle, counter-clockwise from outside, shape (m, 3).
    """

    vertices: FloatArray
    faces: NDArray[np.int32]


class Scene:
    """A scene that grows: surfaces, meshes and materials, and a tree of nodes.

    Each `add_...` gives the index that other parts name it by. Equal materials are one.
    """

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._views: list[Mapping[str, object]] = []
        self._accessors: list[Mapping[str, object]] = []
        self._materials: dict[Color, int] = {}
        self._meshes: list[Mapping[str, object]] = []
        self._nodes: list[Mapping[str, object]] = []

    def add_triangles(self, triangles: Triangles) -> tuple[int, int]:
        """A surface that meshes may share: indices of its vertices and its faces."""
        vertices = np.ascontiguousarray(triangles.vertices, dtype="<f4")
        small = len(vertices) <= _MOST_UINT16
        faces = np.ascontiguousarray(triangles.faces, dtype="<u2" if small else "<u4").ravel()
        bounds = {"min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()}
        points = self._accessor(vertices.tobytes(), _VERTICES, _FLOAT, len(vertices), "VEC3")
        self._accessors[points] = {**self._accessors[points], **bounds}
        kind = _UINT16 if small else _UINT32
        return points, self._accessor(faces.tobytes(), _INDICES, kind, faces.size, "SCALAR")

    def add_mesh(self, name: str, surface: tuple[int, int], color: Color) -> int:
        """A surface in one colour."""
        material = self._materials.setdefault(color, len(self._materials))
        points, faces = surface
        primitive = {"attributes": {"POSITION": points}, "indices": faces, "material": material}
        self._meshes.append({"name": name, "primitives": [primitive]})
        return len(self._meshes) - 1

    def add_node(
        self, name: str, place: Placement, children: Sequence[int] = (), mesh: int | None = None
    ) -> int:
        """A frame in that of its parent, with what hangs on it."""
        node: dict[str, object] = {"name": name, **_transform(place)}
        if children:
            node["children"] = list(children)
        if mesh is not None:
            node["mesh"] = mesh
        self._nodes.append(node)
        return len(self._nodes) - 1

    def to_glb(self, roots: Sequence[int]) -> bytes:
        """The file; `roots` are the nodes that have no parent."""
        document = {
            "asset": {"version": "2.0", "generator": "ocs-design"},
            "scene": 0,
            "scenes": [{"nodes": list(roots)}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": [_material(color) for color in self._materials],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._buffer)}],
        }
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=True).encode("ascii")
        chunks = _chunk(b"JSON", text, b" ") + _chunk(b"BIN\0", bytes(self._buffer), b"\0")
        return b"glTF" + _uint32(2) + _uint32(12 + len(chunks)) + chunks

    def _accessor(self, content: bytes, target: int, kind: int, count: int, shape: str) -> int:
        view = {
            "buffer": 0,
            "byteOffset": len(self._buffer),
            "byteLength": len(content),
            "target": target,
        }
        self._buffer += content + b"\0" * (-len(content) % 4)
        self._views.append(view)
        self._accessors.append(
            {
                "bufferView": len(self._views) - 1,
                "componentType": kind,
                "count": count,
                "type": shape,
            }
        )
        return len(self._accessors) - 1


def _transform(place: Placement) -> Mapping[str, object]:
    """What differs from standing still."""
    found: dict[str, object] = {}
    if place.position.any():
        found["translation"] = place.position.tolist()
    if not np.array_equal(place.rotation, np.eye(3)):
        w, x, y, z = quaternion(place.rotation).tolist()
        found["rotation"] = [x, y, z, w]
    return found


def _material(color: Color) -> Mapping[str, object]:
    """Seen from both sides: robots' meshes are often turned inside out."""
    red, green, blue = (_linear(part) for part in color[:3])
    look = {
        "baseColorFactor": [red, green, blue, color[3]],
        "metallicFactor": 0.0,
        "roughnessFactor": 0.7,
    }
    material = {"pbrMetallicRoughness": look, "doubleSided": True}
    return material if color[3] >= 1.0 else {**material, "alphaMode": "BLEND"}


def _linear(part: float) -> float:
    """Intensity of an sRGB component (IEC 61966-2-1); glTF mixes light, not codes."""
    return part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4


def _chunk(kind: bytes, content: bytes, filler: bytes) -> bytes:
    padded = content + filler * (-len(content) % 4)
    return _uint32(len(padded)) + kind + padded


def _uint32(value: int) -> bytes:
    return value.to_bytes(4, "little")
