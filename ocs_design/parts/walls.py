"""How thin a part is."""

import numpy as np

from ocs_design.parts.mesh import Mesh, part_manifold
from ocs_design.parts.part import Part

SECTIONS = 128
"""Fewer than of files: each triangle costs a ray."""

_OFF_THE_SURFACE = 1e-7
"""Where rays begin below it [m], so that they do not meet it."""


def thinnest_wall(part: Part, sections: int = SECTIONS) -> float:
    """Smallest way through the part along the normals of its surface [m].

    From the middle of each triangle of its mesh, so it finds walls between faces, not the edges of
    wedges. Polygons make round walls thinner by about `R x^2 / 8`, `x = 2 pi / n`.
    """
    body = part_manifold(part, sections)
    found = body.to_mesh64()
    corners = Mesh(found.vert_properties, found.tri_verts).corners
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    across = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0)))
    begins = corners.mean(axis=1) - _OFF_THE_SURFACE * normals
    ends = begins - across * normals
    hits = (body.ray_cast(begin, end) for begin, end in zip(begins, ends, strict=True))
    ways = [
        np.linalg.norm(hit[0].position - start) for hit, start in zip(hits, begins, strict=True)
    ]
    return float(min(ways)) + _OFF_THE_SURFACE
