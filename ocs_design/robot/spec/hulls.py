"""Collision meshes reduced to what collides: MuJoCo lets only their convex hulls touch."""

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.spec.unused_name import unused_name


def reduce_to_hulls(spec: mujoco.MjSpec, model: mujoco.MjModel) -> None:
    """Give each mesh that may touch the corners of its convex hull in place of all its vertices.

    A humanoid's meshes take 70 MB of each compiled model, and every world has one. What touches,
    and how, stays the same; the looks do not.

    Args:
        spec: to change.
        model: that it was compiled to.
    """
    fitted = {geom.meshname for geom in spec.geoms if geom.type != mujoco.mjtGeom.mjGEOM_MESH}
    for mesh in list(spec.meshes):
        index = model.mesh(mesh.name).id
        # A box or capsule fitted to a mesh would come out otherwise around its hull.
        if mesh.name not in fitted and model.mesh_graphadr[index] >= 0:
            _replace(spec, mesh, _hull_corners(model, index))


def _replace(spec: mujoco.MjSpec, mesh: mujoco.MjsMesh, corners: FloatArray) -> None:
    """Put a mesh of these corners alone where `mesh` was."""
    name = unused_name(mesh.name, "", {each.name for each in spec.meshes})
    spec.add_mesh(
        name=name, uservert=corners.ravel(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    )
    for geom in spec.geoms:
        if geom.meshname == mesh.name:
            geom.meshname = name
    if [each.file for each in spec.meshes].count(mesh.file) == 1:
        spec.assets.pop(mesh.file, None)
    spec.delete(mesh)


def _hull_corners(model: mujoco.MjModel, mesh: int) -> FloatArray:
    """In the frame that the geoms of the mesh are placed by [m], shape (n, 3).

    The hull's graph begins with the numbers of its vertices and faces, then for each vertex where
    its edges begin, then the index of each vertex among the mesh's.
    """
    graph = model.mesh_graph[model.mesh_graphadr[mesh] :]
    indices = graph[2 + graph[0] : 2 + 2 * graph[0]]
    corners = model.mesh_vert[model.mesh_vertadr[mesh] + indices].astype(np.float64)
    # MuJoCo turns meshes into their principal axes.
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, model.mesh_quat[mesh])
    placed: FloatArray = corners @ rotation.reshape(3, 3).T + model.mesh_pos[mesh]
    return placed
