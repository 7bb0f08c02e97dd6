"""Whole robot with its device as one GLB file, for viewers and web pages.

Binary glTF 2.0 (Khronos, "glTF 2.0 Specification", sections 3 and 4) is written directly, so that
equal robots give equal bytes; trimesh rounds colours to 8 bits and takes 0.3 s to import.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.common.frames import Placement
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.device.bodies import IMU
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Color
from ocs_design.export.robot_model import model_of
from ocs_design.export.snapshot import geom_mesh, shown_color
from ocs_design.robot.mujoco_bodies import quaternion

_UPRIGHT = Placement(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.zeros(3))
"""Base frame B in the glTF frame, in which y is up and z is forward."""

_FLOAT, _UINT16, _UINT32 = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_MOST_UINT16 = 65535
"""Upper bound of 16-bit indices, exclusive: the largest one restarts a primitive."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `<name>_ocs.glb`, the robot in its nominal posture."""
    model = model_of(subject)
    content = robot_glb(model.compiled, subject.carrier.posture)
    (folder / f"{subject.name}_ocs.glb").write_bytes(content)
    return model.warnings


def robot_glb(model: mujoco.MjModel, posture: Mapping[str, float]) -> bytes:
    """GLB with the visible shapes of a `robot_model`, a node per body, base frame at the origin.

    Textures are left out. Joints not in `posture` [rad or m] stay as the model has them.
    """
    data = mujoco.MjData(model)
    for name, value in posture.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    return _Scene(model, data).to_glb()


class _Scene:
    """Scene of one model; surfaces, meshes and materials shared by geoms are stored once."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._buffer = bytearray()
        self._views: list[Mapping[str, object]] = []
        self._accessors: list[dict[str, object]] = []
        self._surfaces: dict[tuple[float, ...], tuple[int, int]] = {}
        self._materials: dict[Color, int] = {}
        self._meshes: list[Mapping[str, object]] = []
        self._mesh_of: dict[tuple[tuple[int, int], Color], int] = {}
        self._nodes: list[Mapping[str, object]] = []

    def to_glb(self) -> bytes:
        """GLB file with all bodies under one node that turns the robot upright."""
        site = self._data.site(IMU)
        bodies = self._bodies_on(0, Placement(site.xmat.reshape(3, 3), site.xpos))
        name = self._model.names[: self._model.names.index(b"\0")].decode("utf-8", "replace")
        root = self._add_node(name, _UPRIGHT, bodies)
        materials = []
        for color in self._materials:
            # glTF colours are linear, not sRGB-encoded (IEC 61966-2-1).
            red, green, blue = (
                part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
                for part in color[:3]
            )
            look: dict[str, object] = {"baseColorFactor": [red, green, blue, color[3]]}
            look |= {"metallicFactor": 0.0, "roughnessFactor": 0.7}
            # Double-sided, because robot meshes are often inside out.
            material: dict[str, object] = {"pbrMetallicRoughness": look, "doubleSided": True}
            if color[3] < 1.0:
                material["alphaMode"] = "BLEND"
            materials.append(material)
        document = {
            "asset": {"version": "2.0", "generator": "ocs-design"},
            "scene": 0,
            "scenes": [{"nodes": [root]}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": materials,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._buffer)}],
        }
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=True).encode("ascii")
        chunks = _chunk(b"JSON", text, b" ") + _chunk(b"BIN\0", bytes(self._buffer), b"\0")
        return b"glTF" + _uint32(2) + _uint32(12 + len(chunks)) + chunks

    def _bodies_on(self, parent: int, parent_place: Placement) -> list[int]:
        """Nodes of a body's children; `parent_place` is its frame in the world."""
        model, children = self._model, []
        # The world is its own parent.
        for child in filter(None, np.flatnonzero(model.body_parentid == parent).tolist()):
            data, first = self._data.body(child), model.body_geomadr[child]
            place = Placement(data.xmat.reshape(3, 3), data.xpos)
            geoms = map(self._geom, range(first, first + model.body_geomnum[child]))
            nodes = [node for node in geoms if node is not None]
            nodes += self._bodies_on(child, place)
            children.append(self._add_node(data.name, parent_place.inverse() @ place, nodes))
        return children

    def _geom(self, geom: int) -> int | None:
        """Node of a geom; None if it is hidden or has no surface."""
        model, color = self._model, shown_color(self._model, geom)
        if color is None:
            return None
        kind, source = int(model.geom_type[geom]), int(model.geom_dataid[geom])
        is_mesh = kind in {mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF}
        key = (kind, source) if is_mesh else (kind, *model.geom_size[geom].tolist())
        if key not in self._surfaces:
            surface_mesh = geom_mesh(model, geom)
            if surface_mesh is None:
                return None
            # A surface that meshes may share, keyed by its vertices and faces.
            vertices, corners = surface_mesh.vertices.astype("<f4"), surface_mesh.triangles
            small = len(vertices) <= _MOST_UINT16
            width, form = (_UINT16, "<u2") if small else (_UINT32, "<u4")
            points = self._accessor(vertices.tobytes(), _VERTICES, _FLOAT, len(vertices), "VEC3")
            self._accessors[points]["min"] = vertices.min(axis=0).tolist()
            self._accessors[points]["max"] = vertices.max(axis=0).tolist()
            content = corners.astype(form).tobytes()
            faces = self._accessor(content, _INDICES, width, corners.size, "SCALAR")
            self._surfaces[key] = points, faces
        surface, name = self._surfaces[key], model.geom(geom).name or f"geom{geom}"
        if (surface, color) not in self._mesh_of:
            material = self._materials.setdefault(color, len(self._materials))
            points, faces = surface
            primitive = {"attributes": {"POSITION": points}, "indices": faces, "material": material}
            self._mesh_of[surface, color] = len(self._meshes)
            self._meshes.append({"name": name, "primitives": [primitive]})
        rotation = rotation_from_quaternion(model.geom_quat[geom])
        place = Placement(rotation, model.geom_pos[geom])
        return self._add_node(name, place, mesh=self._mesh_of[surface, color])

    def _add_node(
        self, name: str, place: Placement, children: Sequence[int] = (), mesh: int | None = None
    ) -> int:
        """Add a node with its placement in the parent's frame and its children."""
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

    def _accessor(self, content: bytes, target: int, kind: int, count: int, shape: str) -> int:
        start, number = len(self._buffer), len(self._views)
        view = {"buffer": 0, "byteOffset": start, "byteLength": len(content), "target": target}
        self._buffer += content + b"\0" * (-len(content) % 4)
        self._views.append(view)
        entry = {"bufferView": number, "componentType": kind, "count": count, "type": shape}
        self._accessors.append(entry)
        return number


def _chunk(kind: bytes, content: bytes, filler: bytes) -> bytes:
    padded = content + filler * (-len(content) % 4)
    return _uint32(len(padded)) + kind + padded


def _uint32(value: int) -> bytes:
    return value.to_bytes(4, "little")
