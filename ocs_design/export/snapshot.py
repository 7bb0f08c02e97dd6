"""Picture of a robot in MuJoCo drawn without OpenGL, the same on every machine.

Each triangle is covered with points closer than a pixel, and each pixel shows its nearest point: a
depth buffer (Catmull, A Subdivision Algorithm for Computer Display of Curved Surfaces, 1974).
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.export.glb import geom_mesh, shown_color

WIDTH, HEIGHT = 480, 360
"""Size [pixels]."""

AZIMUTH, ELEVATION = np.radians(37.0), np.radians(22.0)
"""Direction towards the viewer: from straight ahead to the left, and up."""

_SMOOTH = 2
"""Pixels in a row that become one, so that edges come out smooth."""

_ROOM = 1.06
"""Size of the picture over that of the robot."""

_SMALL = 8
"""Longest side of a triangle that is not cut in two before it is covered [pixels]."""

_AMBIENT = 0.35
"""Share of the light that comes from everywhere; the rest comes from the viewer."""


def snapshot(model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.uint8]:
    """Robot seen from its front, its left and above, before white, shape (360, 480, 3).

    Args:
        model: of `robot_model`.
        data: with kinematics computed.
    """
    cos, sin = np.cos(AZIMUTH), np.sin(AZIMUTH)
    towards = np.array([cos * np.cos(ELEVATION), sin * np.cos(ELEVATION), np.sin(ELEVATION)])
    right = np.array([-sin, cos, 0.0])
    view = np.stack([right, -np.cross(towards, right), towards])

    # Triangles in the viewer's frame: to the right, down and towards the viewer.
    corners, colors = [], []
    for geom in range(model.ngeom):
        color, mesh = shown_color(model, geom), geom_mesh(model, geom)
        if color is not None and mesh is not None and model.geom_bodyid[geom] > 0:
            turn = view @ data.geom_xmat[geom].reshape(3, 3)
            corners.append(mesh.corners @ turn.T + view @ data.geom_xpos[geom])
            colors.append(np.tile(color, (len(mesh.triangles), 1)))
    if not corners:
        return np.full((HEIGHT, WIDTH, 3), 255, dtype=np.uint8)
    triangles, rgba = np.concatenate(corners), np.concatenate(colors)
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    size = np.array([WIDTH, HEIGHT]) * _SMOOTH
    scale = float((size / (_ROOM * np.maximum((high - low)[:2], 1e-9))).min())
    triangles = (triangles - (low + high) / 2.0) * scale
    triangles[..., :2] += size / 2.0
    edges = np.diff(triangles, axis=1)
    normals = np.cross(edges[:, 0], edges[:, 1])
    # As MuJoCo does, no triangle is shown from behind.
    front = normals[:, 2] < 0.0
    triangles, normals, rgba = triangles[front], normals[front], rgba[front]
    facing = -normals[:, 2] / np.linalg.norm(normals, axis=1)
    lit = rgba[:, :3] * (_AMBIENT + (1.0 - _AMBIENT) * facing)[:, None]

    image = np.ones((*size[::-1], 3))
    opaque = rgba[:, 3] >= 1.0
    depth = np.full(image.shape[:2], -np.inf)
    for chosen in (opaque, ~opaque):
        found, nearest = _nearest(triangles[chosen], depth.shape)
        seen = nearest > depth
        shown = found[seen]
        cover = rgba[chosen, 3:][shown]
        image[seen] = (1.0 - cover) * image[seen] + cover * lit[chosen][shown]
        depth = np.maximum(depth, nearest)
    smooth = image.reshape(HEIGHT, _SMOOTH, WIDTH, _SMOOTH, 3).mean(axis=(1, 3))
    return np.asarray(np.round(255.0 * smooth), dtype=np.uint8)


def _nearest(triangles: FloatArray, shape: tuple[int, ...]) -> tuple[NDArray[np.int64], FloatArray]:
    """Index and depth of the triangle that each pixel shows; -inf where it shows none.

    Args:
        triangles: corners to the right, down and towards the viewer [pixels], shape (n, 3, 3).
        shape: height and width [pixels].
    """
    found, depth = np.zeros(shape, dtype=np.int64), np.full(shape, -np.inf)
    owners = np.arange(len(triangles))
    while len(triangles):
        sides = np.linalg.norm((triangles - np.roll(triangles, -1, axis=1))[..., :2], axis=2)
        small = sides.max(axis=1) <= _SMALL
        for count in range(1, _SMALL + 1):
            fits = small & (np.ceil(sides.max(axis=1)).clip(1) == count)
            # A grid of barycentric coordinates whose points are at most a pixel apart.
            i, j = np.tril_indices(count + 1)
            weights = np.column_stack([count - i, i - j, j]) / count
            points = (weights @ triangles[fits]).reshape(-1, 3)
            column, row = points[:, :2].astype(np.int64).T
            ahead = np.flatnonzero(points[:, 2] > depth[row, column])
            # Of points on one pixel the last one assigned stays: the nearest.
            ahead = ahead[np.argsort(points[ahead, 2], kind="stable")]
            place = row[ahead], column[ahead]
            depth[place], found[place] = points[ahead, 2], owners[fits][ahead // len(weights)]
        # The others are cut in two through the middle of their longest side.
        large = np.flatnonzero(~small)
        first = sides[large].argmax(axis=1)
        a, b, c = (triangles[large, (first + k) % 3] for k in range(3))
        middle = (a + b) / 2.0
        triangles = np.concatenate([np.stack([a, middle, c], 1), np.stack([middle, b, c], 1)])
        owners = np.tile(owners[large], 2)
    return found, depth
