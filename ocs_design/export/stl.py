"""The flywheel's rim as a closed mesh in binary STL."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.design import Flywheel

METRES = 1.0
MILLIMETRES = 1000.0
SECTIONS = 256
"""Sections of the rim: 1.4 degrees each."""

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = b"ocs-design flywheel".ljust(80)


def export_stl(flywheel: Flywheel, path: Path, *, units_per_metre: float) -> Path:
    """Write the rim; see `stl_bytes`."""
    path.write_bytes(stl_bytes(flywheel, units_per_metre=units_per_metre))
    return path


def stl_bytes(flywheel: Flywheel, *, units_per_metre: float) -> bytes:
    """The rim, its centre at the origin and its spin axis along z.

    Args:
        flywheel: a hollow cylinder; a bore of zero makes it a disc.
        units_per_metre: STL has no unit; `MILLIMETRES` for printing, `METRES` for robot files.
    """
    corners = units_per_metre * rim_triangles(flywheel)
    edges = corners[:, 1:] - corners[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    facets = np.zeros(len(corners), _FACET)
    facets["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    facets["corners"] = corners
    return _HEADER + len(facets).to_bytes(4, "little") + facets.tobytes()


def rim_triangles(flywheel: Flywheel) -> FloatArray:
    """Corners of the rim's triangles [m], counter-clockwise from outside, shape (n, 3, 3).

    Inscribed polygons would weigh less than the circles; radii larger by
    `sqrt(x / sin x)`, `x = 2 pi / n`, give each circle its own area, and the moments of
    inertia to about 1e-9.
    """
    profile = _profile(flywheel)
    step = 2.0 * np.pi / SECTIONS
    angles = step * np.arange(SECTIONS)
    radii = profile[:, 0] * np.sqrt(step / np.sin(step))
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    plane = radii[:, None, None] * ring
    height = np.broadcast_to(profile[:, 1, None, None], (*plane.shape[:2], 1))
    vertices = np.concatenate([plane, height], axis=2)
    following = np.roll(vertices, -1, axis=1)
    quads = [
        (vertices[i], following[i], following[j], vertices[j]) for i, j in _sides(len(profile))
    ]
    triangles = [
        np.stack(three, axis=1) for a, b, c, d in quads for three in ((a, b, c), (a, c, d))
    ]
    found: FloatArray = np.concatenate(triangles)
    return np.asarray(found[_has_area(found)])


def _profile(flywheel: Flywheel) -> FloatArray:
    """Radius and z of the cross-section's corners, counter-clockwise, shape (4, 2)."""
    inner, outer, half = flywheel.inner_radius, flywheel.outer_radius, flywheel.height / 2.0
    return np.array([[inner, -half], [outer, -half], [outer, half], [inner, half]])


def _sides(count: int) -> list[tuple[int, int]]:
    return [(i, (i + 1) % count) for i in range(count)]


def _has_area(triangles: FloatArray) -> NDArray[np.bool_]:
    """False for what a bore of zero collapses to a point or a line."""
    edges = triangles[:, 1:] - triangles[:, :1]
    doubled: FloatArray = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    return doubled > 0.0
