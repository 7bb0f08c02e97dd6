"""Geoms of a compiled MJCF model."""

from collections.abc import Iterator

import mujoco
import numpy as np

from ocs_design.robot.rotations import rotation_from_quaternion
from ocs_design.robot.tree import Placement, Shape, ShapeKind

_PRIMITIVES = {
    int(mujoco.mjtGeom.mjGEOM_BOX): (ShapeKind.BOX, 3),
    int(mujoco.mjtGeom.mjGEOM_SPHERE): (ShapeKind.SPHERE, 1),
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): (ShapeKind.CYLINDER, 2),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): (ShapeKind.CAPSULE, 2),
}
_UNBOUNDED = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


def shapes_of(model: mujoco.MjModel, body: int) -> Iterator[Shape]:
    """Shapes of a body in its frame; meshes and ellipsoids as the boxes around them."""
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        kind = int(model.geom_type[geom])
        if kind in _UNBOUNDED:
            continue
        place = Placement(rotation_from_quaternion(model.geom_quat[geom]), model.geom_pos[geom])
        if kind in _PRIMITIVES:
            shape, count = _PRIMITIVES[kind]
            size = model.geom_size[geom, :count]
        else:
            shape, size = ShapeKind.BOX, model.geom_aabb[geom, 3:]
            place = place @ Placement(np.eye(3), model.geom_aabb[geom, :3])
        yield Shape(
            shape,
            tuple(float(length) for length in size),
            place.position,
            place.rotation,
            model.body(body).name,
            bool(model.geom_contype[geom] or model.geom_conaffinity[geom]),
        )
