"""How far apart meshes of parts are, how much they overlap, and how thin they are."""

import numpy as np

from ocs_design.export.meshes import Mesh, part_manifold
from ocs_design.parts.outline import SECTIONS
from ocs_design.parts.solids import Part, Revolution

OFF_THE_SURFACE = 1e-7
"""Where rays begin below it [m], so that they do not meet it."""


def overlap_volume(one, other, sections=SECTIONS):
    """Of both parts' meshes in one frame [m^3]."""
    return float((part_manifold(one, sections) ^ part_manifold(other, sections)).volume())


def turning_clearance(wheel, still, reach, sections=SECTIONS):
    """Smallest gap between turning parts and still ones over a full turn [m].

    Turning parts are bodies of revolution about z, whose holes are not regarded. No gap beyond
    `reach` is looked for. Polygons are about `R x^2 / 12`, `x = 2 pi / n`, off the circle.
    """
    assert all(isinstance(solid, Revolution) for part in wheel for solid in part.joined)
    swept = [Part(part.name, part.density, part.joined) for part in wheel]
    bodies = [part_manifold(part, sections) for part in swept]
    around = [part_manifold(part, sections) for part in still]
    return min(float(body.min_gap(other, reach)) for body in bodies for other in around)


def thinnest_wall(part, sections=128):
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
    begins = corners.mean(axis=1) - OFF_THE_SURFACE * normals
    ends = begins - across * normals
    hits = (body.ray_cast(begin, end) for begin, end in zip(begins, ends, strict=True))
    ways = [
        np.linalg.norm(hit[0].position - start) for hit, start in zip(hits, begins, strict=True)
    ]
    return float(min(ways)) + OFF_THE_SURFACE
