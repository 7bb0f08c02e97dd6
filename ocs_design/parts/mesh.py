"""Closed triangle meshes of parts."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.parts.flattening import (
    SECTIONS,
    circle_radius_factor,
    flat_outline,
    ring_points,
)
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, Revolution, Solid

if TYPE_CHECKING:
    from manifold3d import Manifold


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface.

    Attributes:
        vertices: [m], shape (n, 3).
        triangles: indices of vertices, counter-clockwise from outside, shape (m, 3).
    """

    vertices: FloatArray
    triangles: NDArray[np.int64]

    @classmethod
    def of_corners(cls, corners: FloatArray) -> "Mesh":
        """From the triangles' corners, shape (m, 3, 3): equal points become one vertex."""
        # Adding 0 makes one number of both zeros.
        vertices, places = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
        triangles = places.reshape(-1, 3)
        a, b, c = triangles.T
        return cls(vertices, triangles[(a != b) & (b != c) & (c != a)])

    @property
    def corners(self) -> FloatArray:
        """Of the triangles [m], shape (m, 3, 3)."""
        return np.asarray(self.vertices[self.triangles])

    @property
    def volume(self) -> float:
        """Enclosed, by the divergence theorem [m^3]."""
        a, b, c = self.corners.transpose(1, 0, 2)
        return float(np.sum(a * np.cross(b, c)) / 6.0)


def part_mesh(part: Part, sections: int = SECTIONS) -> Mesh:
    """The part as one closed mesh.

    Args:
        part: what is meshed.
        sections: of a full circle. Polygons inscribed in circles would weigh less than they do:
            see `circle_radius_factor`.
    """
    if len(part.joined) == 1 and not part.cut:
        return solid_mesh(part.joined[0], sections)
    found = part_manifold(part, sections).to_mesh64()
    return Mesh(
        np.asarray(found.vert_properties, dtype=np.float64),
        np.asarray(found.tri_verts, dtype=np.int64),
    )


def together(meshes: Sequence[Mesh]) -> Mesh:
    """Several closed surfaces in one."""
    starts = accumulate((len(mesh.vertices) for mesh in meshes), initial=0)
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(
            [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
        ),
    )


def part_manifold(part: Part, sections: int = SECTIONS) -> "Manifold":
    """The part for boolean operations."""
    # Only parts of several solids need it.
    from manifold3d import Manifold, OpType  # noqa: PLC0415

    joined, cut = (
        [_manifold(solid, sections) for solid in solids] for solids in (part.joined, part.cut)
    )
    whole = Manifold.batch_boolean(joined, OpType.Add)
    return Manifold.batch_boolean([whole, *cut], OpType.Subtract)


def solid_mesh(solid: Solid, sections: int = SECTIONS) -> Mesh:
    """One solid as a closed mesh."""
    match solid:
        case Revolution():
            return Mesh.of_corners(_revolution_corners(solid, sections))
        case Prism():
            return Mesh.of_corners(_prism_corners(solid, sections))


def _revolution_corners(solid: Revolution, sections: int) -> FloatArray:
    """Two triangles for each side of the profile and section; some of them may be void."""
    radii, heights = solid.profile.T
    ring = ring_points(2.0 * pi * np.arange(sections) / sections)
    plane = (radii * circle_radius_factor(sections))[:, None, None] * ring
    height = np.broadcast_to(heights[:, None, None], (*plane.shape[:2], 1))
    vertices = np.concatenate([plane, height], axis=2)
    return _sides(vertices, np.roll(vertices, -1, axis=0))


def _prism_corners(solid: Prism, sections: int) -> FloatArray:
    """Sides and both ends, in the part's frame."""
    from manifold3d import triangulate  # noqa: PLC0415 - robot files need no prisms

    ring = flat_outline(solid.outline, sections)
    ends = triangulate([ring])
    low, high = (
        np.column_stack([ring, np.full(len(ring), height)]) for height in (solid.low, solid.high)
    )
    sides = _sides(low[None], high[None])
    corners = np.concatenate([sides, low[ends[:, ::-1]], high[ends]])
    return np.asarray(corners @ solid.placement.rotation.T + solid.placement.position)


def _sides(lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Triangles between closed rings of points, each shape (rings, n, 3)."""
    next_lower, next_upper = (np.roll(ring, -1, axis=1) for ring in (lower, upper))
    pairs = ((lower, next_lower, next_upper), (lower, next_upper, upper))
    return np.concatenate([np.stack(three, axis=2).reshape(-1, 3, 3) for three in pairs])


def _manifold(solid: Solid, sections: int) -> "Manifold":
    from manifold3d import Manifold, Mesh64  # noqa: PLC0415 - as above

    mesh = solid_mesh(solid, sections)
    return Manifold(Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))
