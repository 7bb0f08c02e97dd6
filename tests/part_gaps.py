"""Gaps between meshes of parts, overlap volumes, and wall thickness."""

import numpy as np

from ocs_design.export.meshes import Mesh, part_manifold
from ocs_design.parts.outline import SECTIONS
from ocs_design.parts.solids import Part, Revolution

RAY_START_DEPTH = 1e-7
"""Depth below the surface at which rays start [m], so that they do not hit it."""


def overlap_volume(one, other, sections=SECTIONS):
    """Volume common to the meshes of two parts in one frame [m^3]."""
    return float((part_manifold(one, sections) ^ part_manifold(other, sections)).volume())


def turning_clearance(wheel, fixed, reach, sections=SECTIONS):
    """Smallest gap between rotating and fixed parts over a full turn [m].

    Rotating parts are bodies of revolution about z; their holes are ignored. Gaps beyond `reach`
    are not searched. Polygons are about `R x^2 / 12`, `x = 2 pi / n`, off the circle.
    """
    assert all(isinstance(solid, Revolution) for part in wheel for solid in part.joined)
    swept = [Part(part.name, part.density, part.joined) for part in wheel]
    bodies = [part_manifold(part, sections) for part in swept]
    obstacles = [part_manifold(part, sections) for part in fixed]
    return min(float(body.min_gap(other, reach)) for body in bodies for other in obstacles)


def thinnest_wall(part, sections=128):
    """Smallest thickness of the part along the normals of its surface [m].

    Rays start at the centre of each triangle of its mesh, so they find walls between faces, not the
    edges of wedges. Polygons make round walls thinner by about `R x^2 / 8`, `x = 2 pi / n`.
    """
    body = part_manifold(part, sections)
    mesh = body.to_mesh64()
    corners = Mesh(mesh.vert_properties, mesh.tri_verts).corners
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    diameter = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0)))
    starts = corners.mean(axis=1) - RAY_START_DEPTH * normals
    ends = starts - diameter * normals
    hits = (body.ray_cast(start, end) for start, end in zip(starts, ends, strict=True))
    thicknesses = [
        np.linalg.norm(hit[0].position - start) for hit, start in zip(hits, starts, strict=True)
    ]
    return float(min(thicknesses)) + RAY_START_DEPTH
