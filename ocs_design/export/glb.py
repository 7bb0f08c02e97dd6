"""The whole robot with its device as one GLB file: to look at, in any viewer or web page."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.export import surfaces
from ocs_design.export.gltf import Color, Scene, Triangles
from ocs_design.export.naming import IMU
from ocs_design.robot.rotations import rotation_from_quaternion
from ocs_design.robot.spec.bodies import HIDDEN_GROUP
from ocs_design.robot.tree import Placement

_UPRIGHT = Placement(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.zeros(3))
"""B in the frame of glTF, whose y is up and whose front is z."""

_PLAIN: Color = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's own colour; a geom that has it has that of its material."""


def export_robot_glb(model: mujoco.MjModel, posture: Mapping[str, float], path: Path) -> Path:
    """Write what a viewer shows of the robot, a node for each body, its base frame at the origin.

    Args:
        model: of `robot_model`. Textures are left out.
        posture: value of each joint [rad or m]; those not named stay as the model has them.
        path: of the GLB.
    """
    path.write_bytes(_Drawing(model, _data_in(model, posture)).to_glb())
    return path


def _data_in(model: mujoco.MjModel, posture: Mapping[str, float]) -> mujoco.MjData:
    data = mujoco.MjData(model)
    for name, value in posture.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    return data


class _Drawing:
    """The scene of one model; geometries that several geoms share are in it once."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._scene = Scene()
        self._surfaces: dict[tuple[float, ...], tuple[int, int]] = {}
        self._meshes: dict[tuple[tuple[int, int], Color], int] = {}

    def to_glb(self) -> bytes:
        """All bodies under one node that sets the robot upright."""
        site = self._data.site(IMU)
        base = Placement(site.xmat.reshape(3, 3), site.xpos)
        bodies = self._bodies_on(0, base)
        name = self._model.names[: self._model.names.index(b"\0")].decode("utf-8", "replace")
        return self._scene.to_glb([self._scene.add_node(name, _UPRIGHT, bodies)])

    def _bodies_on(self, parent: int, parent_place: Placement) -> list[int]:
        """Nodes of the bodies that hang on a body; `parent_place` is its frame in the world."""
        children = np.flatnonzero(self._model.body_parentid == parent)
        return [self._body(int(child), parent_place) for child in children if child]

    def _body(self, body: int, parent_place: Placement) -> int:
        data = self._data.body(body)
        place = Placement(data.xmat.reshape(3, 3), data.xpos)
        nodes = [*self._geoms_of(body), *self._bodies_on(body, place)]
        return self._scene.add_node(data.name, parent_place.inverse() @ place, nodes)

    def _geoms_of(self, body: int) -> Iterator[int]:
        first = self._model.body_geomadr[body]
        for geom in range(first, first + self._model.body_geomnum[body]):
            color = self._color(geom)
            if self._model.geom_group[geom] >= HIDDEN_GROUP or color[3] == 0.0:
                continue
            surface = self._surface(geom)
            if surface is not None:
                rotation = rotation_from_quaternion(self._model.geom_quat[geom])
                place = Placement(rotation, self._model.geom_pos[geom])
                name = self._model.geom(geom).name or f"geom{geom}"
                yield self._scene.add_node(name, place, mesh=self._mesh(name, surface, color))

    def _mesh(self, name: str, surface: tuple[int, int], color: Color) -> int:
        key = (surface, color)
        if key not in self._meshes:
            self._meshes[key] = self._scene.add_mesh(name, surface, color)
        return self._meshes[key]

    def _surface(self, geom: int) -> tuple[int, int] | None:
        """None for what has no surface of its own."""
        model = self._model
        kind, mesh = int(model.geom_type[geom]), int(model.geom_dataid[geom])
        is_mesh = kind in {mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF}
        key = (kind, mesh) if is_mesh else (kind, *model.geom_size[geom].tolist())
        if key not in self._surfaces:
            triangles = _mesh(model, mesh) if is_mesh else _primitive(kind, model.geom_size[geom])
            if triangles is None:
                return None
            self._surfaces[key] = self._scene.add_triangles(triangles)
        return self._surfaces[key]

    def _color(self, geom: int) -> Color:
        material = self._model.geom_matid[geom]
        own = _rgba(self._model.geom_rgba[geom])
        is_materials = material >= 0 and own == _PLAIN
        return _rgba(self._model.mat_rgba[material]) if is_materials else own


def _rgba(values: FloatArray) -> Color:
    red, green, blue, opacity = (round(float(value), 6) for value in values)
    return red, green, blue, opacity


def _mesh(model: mujoco.MjModel, mesh: int) -> Triangles:
    vertex, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    return Triangles(
        model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]],
        model.mesh_face[face : face + model.mesh_facenum[mesh]],
    )


def _primitive(kind: int, size: FloatArray) -> Triangles | None:
    match mujoco.mjtGeom(kind):
        case mujoco.mjtGeom.mjGEOM_BOX:
            return surfaces.box(size)
        case mujoco.mjtGeom.mjGEOM_SPHERE:
            return surfaces.ellipsoid(np.full(3, size[0]))
        case mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            return surfaces.ellipsoid(size)
        case mujoco.mjtGeom.mjGEOM_CYLINDER:
            return surfaces.cylinder(size[0], size[1])
        case mujoco.mjtGeom.mjGEOM_CAPSULE:
            return surfaces.capsule(size[0], size[1])
    return None
