"""Surfaces of MuJoCo's primitive shapes, about their own centres, as triangles to look at."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.export.gltf import Triangles

SECTIONS = 32
_RINGS = 8
"""Of a half sphere."""
_ON_AXIS = 1e-9
"""Largest radius, over that of the shape, which rounding gives a point on the axis."""


def box(half: FloatArray) -> Triangles:
    """Of half extents [m], shape (3,)."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [three for a, b, c, d in sides for three in ((a, b, c), (a, c, d))]
    return Triangles(signs * half, np.array(faces, dtype=np.int32))


def ellipsoid(radii: FloatArray) -> Triangles:
    """Of three half axes [m], shape (3,); equal ones make a sphere."""
    latitudes = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * _RINGS + 1)
    ball = _revolved(np.column_stack([np.cos(latitudes), np.sin(latitudes)]))
    return Triangles(ball.vertices * radii, ball.faces)


def cylinder(radius: float, half_length: float) -> Triangles:
    """Along z, closed [m]."""
    r, h = radius, half_length
    # An edge is sharp where its two sides have vertices of their own.
    return _joined(
        _revolved(np.array([[0.0, -h], [r, -h]])),
        _revolved(np.array([[r, -h], [r, h]])),
        _revolved(np.array([[r, h], [0.0, h]])),
    )


def capsule(radius: float, half_length: float) -> Triangles:
    """Along z, a half ball on either end of a cylinder of that half length [m]."""
    upper = np.linspace(0.0, 0.5 * np.pi, _RINGS + 1)
    cap = radius * np.column_stack([np.cos(upper), np.sin(upper)]) + [0.0, half_length]
    return _revolved(np.concatenate([cap[::-1] * [1.0, -1.0], cap]))


def _revolved(profile: FloatArray) -> Triangles:
    """Radius and z along a line, shape (n, 2), turned about z; seen from outside on its right."""
    angles = 2.0 * np.pi / SECTIONS * np.arange(SECTIONS)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    flat = profile[:, :1, None] * ring
    height = np.broadcast_to(profile[:, 1, None, None], (*flat.shape[:2], 1))
    corners = np.arange(flat.shape[0] * SECTIONS).reshape(-1, SECTIONS)
    after = np.roll(corners, -1, axis=1)
    a, b, c, d = corners[:-1], after[:-1], after[1:], corners[1:]
    # On the axis a quad shrinks to one triangle.
    off_axis = profile[:, 0] > _ON_AXIS * profile[:, 0].max()
    lower, upper = np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)
    faces = np.concatenate(
        [lower[off_axis[:-1]].reshape(-1, 3), upper[off_axis[1:]].reshape(-1, 3)]
    )
    return Triangles(np.concatenate([flat, height], axis=2).reshape(-1, 3), faces.astype(np.int32))


def _joined(*parts: Triangles) -> Triangles:
    counts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = [part.faces + first for part, first in zip(parts, counts, strict=False)]
    vertices = np.concatenate([part.vertices for part in parts])
    return Triangles(vertices, np.concatenate(faces).astype(np.int32))
