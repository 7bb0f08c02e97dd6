"""Picture of a robot without OpenGL, the same on every machine, for folders, print and mail.

Triangles are rasterized row by row, and the nearest one at each pixel wins (a z-buffer, as in
Foley, van Dam, Feiner, Hughes, "Computer Graphics", section 15.4).
"""

from collections.abc import Sequence
from itertools import product

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.export.meshes import Color, Mesh, primitive_mesh
from ocs_design.export.raster import covered_pixels, view_of
from ocs_design.robot.mujoco_bodies import HIDDEN_GROUP

WIDTH, HEIGHT = 800, 500
"""Size of the picture [pixels]."""

_OVERSAMPLING = 2
_AZIMUTH, _ELEVATION = np.radians(-37.0), np.radians(22.0)
"""Direction of the camera, seen from the robot [rad]: in front, to its right, above."""

_LEVEL = np.cos(_ELEVATION)
_TOWARDS = (_LEVEL * np.cos(_AZIMUTH), _LEVEL * np.sin(_AZIMUTH), np.sin(_ELEVATION))
"""Unit vector in B towards the viewer."""

_ROOM = 1.06
_AMBIENT, _BACKGROUND = 0.42, 255
_GLASS = 0.9
"""Opacity below which triangles are left out, so that wheels are visible in their housings."""

_BITS = 24
"""Bits of a triangle's number."""

_CHUNK = 1 << 9
"""Triangles drawn per pass, so that their pixels stay in the processor's cache."""

_DEPTHS = float(2**38)
"""Number of depth levels."""

_PLAIN: Color = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's default colour; a geom with it takes the colour of its material."""


def snapshot(model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.uint8]:
    """Picture of a `robot_model` with computed kinematics; see `picture`."""
    shapes = []
    for geom in range(model.ngeom):
        color, mesh = shown_color(model, geom), geom_mesh(model, geom)
        if color is not None and mesh is not None and model.geom_bodyid[geom] > 0:
            turn = data.geom_xmat[geom].reshape(3, 3)
            shapes.append((mesh.corners @ turn.T + data.geom_xpos[geom], color))
    return picture(shapes)


def shown_color(model: mujoco.MjModel, geom: int) -> Color | None:
    """Colour of a geom; None if viewers do not show it."""
    color, material = _rgba(model.geom_rgba[geom]), model.geom_matid[geom]
    if material >= 0 and color == _PLAIN:
        color = _rgba(model.mat_rgba[material])
    return None if model.geom_group[geom] >= HIDDEN_GROUP or color[3] == 0.0 else color


def _rgba(values: FloatArray) -> Color:
    red, green, blue, opacity = (round(float(value), 6) for value in values)
    return red, green, blue, opacity


def geom_mesh(model: mujoco.MjModel, geom: int) -> Mesh | None:
    """Surface of a geom in its own frame; None if it has none."""
    if int(model.geom_type[geom]) not in {mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_SDF}:
        return primitive_mesh(int(model.geom_type[geom]), model.geom_size[geom])
    mesh = model.geom_dataid[geom]
    vertex, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    return Mesh(
        model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]],
        model.mesh_face[face : face + model.mesh_facenum[mesh]],
    )


def picture(shapes: Sequence[tuple[FloatArray, Color]]) -> NDArray[np.uint8]:
    """Orthographic picture on white: red, green and blue, shape (HEIGHT, WIDTH, 3).

    Shapes are triangle corners, x forward and z up [m], shape (n, 3, 3), with their colour.
    """
    opaque = [(corners, color[:3]) for corners, color in shapes if color[3] >= _GLASS]
    corners = np.concatenate([np.empty((0, 3, 3)), *(triangles for triangles, _ in opaque)])
    tints = (np.tile(color, (len(triangles), 1)) for triangles, color in opaque)
    colors = np.concatenate([np.empty((0, 3)), *tints])
    right, up, towards = view_of(_TOWARDS, (0.0, 0.0, 1.0))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    seen = length > 0.0
    # Light comes over the viewer's left shoulder.
    light = towards + 0.55 * up - 0.45 * right
    shade = np.abs(normal[seen] @ light) / np.linalg.norm(light) / length[seen]
    # Pixels from the upper left, shape (n, 3, 2), and nearness of each corner, shape (n, 3).
    plane = np.stack([corners[seen] @ right, -(corners[seen] @ up)], axis=-1)
    width, height = _OVERSAMPLING * WIDTH, _OVERSAMPLING * HEIGHT
    if len(plane):
        low, high = plane.min(axis=(0, 1)), plane.max(axis=(0, 1))
        size = _ROOM * np.max((high - low) / (width, height))
        plane = (plane - (low + high) / 2.0) / size + np.array([width, height]) / 2.0
    shown = _nearest(np.concatenate([plane, (corners[seen] @ towards)[..., None]], axis=-1))
    lit = colors[seen] * (_AMBIENT + (1.0 - _AMBIENT) * shade)[:, None]
    palette = np.concatenate([lit, np.ones((1, 3))]).astype(np.float32)
    # Each pixel is the mean of its oversampled pixels.
    k = _OVERSAMPLING
    total = sum(palette[shown[row::k, column::k]] for row, column in product(range(k), repeat=2))
    return np.asarray(np.round(_BACKGROUND / k**2 * np.minimum(total, k**2)), dtype=np.uint8)


def _nearest(corners: FloatArray) -> NDArray[np.int64]:
    """Number of the triangle visible at each pixel, -1 for none, shape (height, width).

    Corners are x and y in pixels and the nearness, shape (n, 3, 3).
    """
    width, height = _OVERSAMPLING * WIDTH, _OVERSAMPLING * HEIGHT
    shown = np.full(width * height, -1, dtype=np.int64)
    depth = corners[:, :, 2]
    least, spread = (depth.min(), np.ptp(depth)) if depth.size else (0.0, 0.0)
    step = _DEPTHS / max(float(spread), 1e-12)
    for begin in range(0, len(corners), _CHUNK):
        triangle, row, column, near = covered_pixels(corners[begin : begin + _CHUNK], 0.5)
        # The upper bits are the nearness, the lower ones the triangle: the largest number wins.
        near = step * (near - least)
        number = np.clip(near, 0.0, _DEPTHS, out=near).astype(np.int64) << _BITS
        np.maximum.at(shown, row * width + column, number | (begin + triangle))
    np.bitwise_and(shown, (1 << _BITS) - 1, out=shown, where=shown >= 0)
    return shown.reshape(height, width)
