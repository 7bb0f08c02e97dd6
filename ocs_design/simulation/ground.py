"""The floor, what touches it, and how far the robot is above it."""

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray

FLOOR = "ocs_floor"

_Geom = mujoco.mjtGeom


def add_floor(spec: mujoco.MjSpec) -> None:
    """A plane at z = 0 that meets every geom of the robot, while these do not meet each other.

    Neighbouring links overlap in most robot files; only contact with the floor is of interest here,
    and it begins where they meet, not a margin before.
    """
    for geom in spec.geoms:
        geom.margin = geom.gap = 0.0
        geom.conaffinity = int(bool(geom.contype or geom.conaffinity))
        geom.contype = 0
    spec.worldbody.add_geom(
        name=FLOOR,
        type=_Geom.mjGEOM_PLANE,
        size=[0, 0, 1],
        contype=1,
        conaffinity=0,
        margin=0.0,
        gap=0.0,
    )


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Height of the lowest point of everything that can touch the floor [m]; inf if nothing can."""
    touching = np.flatnonzero((model.geom_conaffinity & 1) & (model.geom_bodyid > 0))
    return min((_lowest_of(model, data, int(geom)) for geom in touching), default=np.inf)


def _lowest_of(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> float:
    """Support of one geom downwards; `up` is the world's vertical in the geom's frame."""
    up: FloatArray = data.geom_xmat[geom].reshape(3, 3)[2]
    size = model.geom_size[geom]
    across = np.sqrt(max(0.0, 1.0 - up[2] ** 2))
    match model.geom_type[geom]:
        case _Geom.mjGEOM_SPHERE:
            reach = size[0]
        case _Geom.mjGEOM_CAPSULE:
            reach = size[0] + size[1] * abs(up[2])
        case _Geom.mjGEOM_CYLINDER:
            reach = size[0] * across + size[1] * abs(up[2])
        case _Geom.mjGEOM_BOX:
            reach = size @ np.abs(up)
        case _Geom.mjGEOM_ELLIPSOID:
            reach = np.linalg.norm(size * up)
        case _Geom.mjGEOM_MESH:
            first = model.mesh_vertadr[model.geom_dataid[geom]]
            count = model.mesh_vertnum[model.geom_dataid[geom]]
            reach = -(model.mesh_vert[first : first + count] @ up).min()
        case _:
            reach = model.geom_rbound[geom]
    return float(data.geom_xpos[geom, 2] - reach)
