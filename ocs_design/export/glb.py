"""Whole robot with its device as one GLB file, for viewers and web pages.

Binary glTF 2.0 (Khronos, "glTF 2.0 Specification", sections 3 and 4) is written here: equal robots
give equal bytes, and trimesh, which rounds colours to 8 bits, takes 0.3 s to import.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.device.naming import IMU
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Color, Mesh
from ocs_design.export.robot_model import model_of
from ocs_design.export.snapshot import geom_mesh, shown_color
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.rotations import rotation_from_quaternion
from ocs_design.robot.tree import Placement

_UPRIGHT = Placement(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.zeros(3))
"""Base frame B in the frame of glTF, whose y is up and whose front is z."""

_FLOAT, _UINT16, _UINT32 = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_MOST_UINT16 = 65535
"""Upper bound of indices: the largest one restarts a primitive."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `<name>_ocs.glb`, the robot in its nominal posture."""
    path = folder / f"{subject.name}_ocs.glb"
    model = model_of(subject)
    export_robot_glb(model.compiled, subject.carrier.posture, path)
    return model.warnings


def export_robot_glb(model: mujoco.MjModel, posture: Mapping[str, float], path: Path) -> Path:
    """Write the robot's visible shapes, a node for each body, its base frame at the origin.

    Args:
        model: of `robot_model`. Textures are left out.
        posture: value of each joint [rad or m]; those not named stay as the model has them.
        path: of the GLB.
    """
    data = mujoco.MjData(model)
    for name, value in posture.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    path.write_bytes(_ModelScene(model, data).to_glb())
    return path


class _ModelScene:
    """Scene of one model; geometries that several geoms share are in it once."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._scene = Scene()
        self._surfaces: dict[tuple[float, ...], tuple[int, int]] = {}
        self._meshes: dict[tuple[tuple[int, int], Color], int] = {}

    def to_glb(self) -> bytes:
        """File with all bodies under one node that sets the robot upright."""
        site = self._data.site(IMU)
        base = Placement(site.xmat.reshape(3, 3), site.xpos)
        bodies = self._bodies_on(0, base)
        name = self._model.names[: self._model.names.index(b"\0")].decode("utf-8", "replace")
        return self._scene.to_glb([self._scene.add_node(name, _UPRIGHT, bodies)])

    def _bodies_on(self, parent: int, parent_place: Placement) -> list[int]:
        """Nodes of a body's children; `parent_place` is its frame in the world."""
        found = []
        # The world is its own parent.
        for child in filter(None, np.flatnonzero(self._model.body_parentid == parent).tolist()):
            data = self._data.body(child)
            place = Placement(data.xmat.reshape(3, 3), data.xpos)
            nodes = [*self._geoms_of(child), *self._bodies_on(child, place)]
            found.append(self._scene.add_node(data.name, parent_place.inverse() @ place, nodes))
        return found

    def _geoms_of(self, body: int) -> Iterator[int]:
        model = self._model
        first = model.body_geomadr[body]
        for geom in range(first, first + model.body_geomnum[body]):
            color = shown_color(model, geom)
            if color is None:
                continue
            surface = self._surface(geom)
            if surface is not None:
                rotation = rotation_from_quaternion(model.geom_quat[geom])
                place = Placement(rotation, model.geom_pos[geom])
                name = model.geom(geom).name or f"geom{geom}"
                key = (surface, color)
                if key not in self._meshes:
                    self._meshes[key] = self._scene.add_mesh(name, surface, color)
                yield self._scene.add_node(name, place, mesh=self._meshes[key])

    def _surface(self, geom: int) -> tuple[int, int] | None:
        """Surface of a geom; None where it has none of its own."""
        model = self._model
        kind, mesh = int(model.geom_type[geom]), int(model.geom_dataid[geom])
        is_mesh = kind in {mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF}
        key = (kind, mesh) if is_mesh else (kind, *model.geom_size[geom].tolist())
        if key not in self._surfaces:
            found = geom_mesh(model, geom)
            if found is None:
                return None
            self._surfaces[key] = self._scene.add_surface(found)
        return self._surfaces[key]


class Scene:
    """Scene in binary glTF: surfaces, meshes and materials, and a tree of nodes.

    Each `add_...` gives the index that other parts name it by. Equal materials are one.
    """

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._views: list[Mapping[str, object]] = []
        self._accessors: list[Mapping[str, object]] = []
        self._materials: dict[Color, int] = {}
        self._meshes: list[Mapping[str, object]] = []
        self._nodes: list[Mapping[str, object]] = []

    def add_surface(self, mesh: Mesh) -> tuple[int, int]:
        """Add a surface that meshes may share; gives the indices of its vertices and faces."""
        vertices = np.ascontiguousarray(mesh.vertices, dtype="<f4")
        small = len(vertices) <= _MOST_UINT16
        faces = np.ascontiguousarray(mesh.triangles, dtype="<u2" if small else "<u4").ravel()
        bounds = {"min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()}
        points = self._accessor(vertices.tobytes(), _VERTICES, _FLOAT, len(vertices), "VEC3")
        self._accessors[points] = {**self._accessors[points], **bounds}
        kind = _UINT16 if small else _UINT32
        return points, self._accessor(faces.tobytes(), _INDICES, kind, faces.size, "SCALAR")

    def add_mesh(self, name: str, surface: tuple[int, int], color: Color) -> int:
        """Add a surface in one colour."""
        material = self._materials.setdefault(color, len(self._materials))
        points, faces = surface
        primitive = {"attributes": {"POSITION": points}, "indices": faces, "material": material}
        self._meshes.append({"name": name, "primitives": [primitive]})
        return len(self._meshes) - 1

    def add_node(
        self, name: str, place: Placement, children: Sequence[int] = (), mesh: int | None = None
    ) -> int:
        """Add a frame in that of its parent, with its children."""
        node: dict[str, object] = {"name": name}
        if place.position.any():
            node["translation"] = place.position.tolist()
        if not np.array_equal(place.rotation, np.eye(3)):
            w, x, y, z = quaternion(place.rotation).tolist()
            node["rotation"] = [x, y, z, w]
        if children:
            node["children"] = list(children)
        if mesh is not None:
            node["mesh"] = mesh
        self._nodes.append(node)
        return len(self._nodes) - 1

    def to_glb(self, roots: Sequence[int]) -> bytes:
        """File of the scene; `roots` are the nodes that have no parent."""
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


def _material(color: Color) -> Mapping[str, object]:
    """Material that is seen from both sides: robots' meshes are often turned inside out."""
    # glTF mixes light, not the codes of sRGB (IEC 61966-2-1).
    red, green, blue = (
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in color[:3]
    )
    look = {
        "baseColorFactor": [red, green, blue, color[3]],
        "metallicFactor": 0.0,
        "roughnessFactor": 0.7,
    }
    material = {"pbrMetallicRoughness": look, "doubleSided": True}
    return material if color[3] >= 1.0 else {**material, "alphaMode": "BLEND"}


def _chunk(kind: bytes, content: bytes, filler: bytes) -> bytes:
    padded = content + filler * (-len(content) % 4)
    return _uint32(len(padded)) + kind + padded


def _uint32(value: int) -> bytes:
    return value.to_bytes(4, "little")
