"""Triangle meshes: closed meshes of parts, and surfaces of MuJoCo's primitive shapes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, product
from math import pi
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.parts.outline import SECTIONS, circle_radius_factor, flat_outline, ring_points
from ocs_design.parts.shapes import Disc
from ocs_design.parts.solids import Part, Prism, Relief, Revolution, Solid

if TYPE_CHECKING:
    from manifold3d import Manifold

Color: TypeAlias = tuple[float, float, float, float]
"""Red, green, blue (sRGB) and opacity, 0..1."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Surface of triangles.

    Attributes:
        vertices: [m], shape (n, 3).
        triangles: indices of vertices, counter-clockwise from outside, shape (m, 3).
    """

    vertices: FloatArray
    triangles: NDArray[np.int64]

    @classmethod
    def of_corners(cls, corners: FloatArray) -> "Mesh":
        """Mesh from the triangles' corners, shape (m, 3, 3); equal points become one vertex."""
        # Adding 0 turns -0 into 0.
        vertices, places = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
        triangles = places.reshape(-1, 3)
        a, b, c = triangles.T
        return cls(vertices, triangles[(a != b) & (b != c) & (c != a)])

    @property
    def corners(self) -> FloatArray:
        """Corners of the triangles [m], shape (m, 3, 3)."""
        return np.asarray(self.vertices[self.triangles])

    def placed(self, place: Placement) -> "Mesh":
        """The mesh transformed by the placement of its frame."""
        return Mesh(self.vertices @ place.rotation.T + place.position, self.triangles)

    def moved(self, offset: FloatArray) -> "Mesh":
        """The mesh shifted by an offset [m]."""
        return Mesh(self.vertices + offset, self.triangles)


def part_mesh(part: Part, sections: int = SECTIONS) -> Mesh:
    """Part as one closed mesh, with so many chords per full circle.

    Circles are enlarged so that their polygons keep the mass: see `circle_radius_factor`.
    """
    if len(part.joined) == 1 and not part.cut:
        return solid_mesh(part.joined[0], sections)
    mesh = part_manifold(part, sections).to_mesh64()
    return Mesh(np.asarray(mesh.vert_properties), np.asarray(mesh.tri_verts, dtype=np.int64))


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes merged into one."""
    starts = accumulate((len(mesh.vertices) for mesh in meshes), initial=0)
    faces = [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def part_manifold(part: Part, sections: int = SECTIONS) -> "Manifold":
    """Part as a manifold for boolean operations."""
    # Only needed for parts of several solids.
    from manifold3d import Manifold, Mesh64, OpType  # noqa: PLC0415

    def manifold(solid: Solid) -> "Manifold":
        """One solid."""
        mesh = solid_mesh(solid, sections)
        return Manifold(Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64)))

    union = Manifold.batch_boolean([manifold(solid) for solid in part.joined], OpType.Add)
    holes = (manifold(solid) for solid in part.cut)
    return Manifold.batch_boolean([union, *holes], OpType.Subtract)


def solid_mesh(solid: Solid, sections: int = SECTIONS) -> Mesh:
    """Solid as a closed mesh."""
    match solid:
        case Revolution():
            factor = np.array([circle_radius_factor(sections), 1.0])
            return Mesh.of_corners(_revolved(factor * solid.profile, sections))
        case Prism():
            from manifold3d import triangulate  # noqa: PLC0415 - robot files need no prisms

            ring, place = flat_outline(solid.outline, sections), solid.placement
            ends, around = triangulate([ring]), np.ones((len(ring), 1))
            low, high = (np.hstack([ring, end * around]) for end in (solid.low, solid.high))
            sides = _sides(low[None], high[None])
            corners = np.concatenate([sides, low[ends[:, ::-1]], high[ends]])
            return Mesh.of_corners(np.asarray(corners @ place.rotation.T + place.position))
        case Relief():
            if not solid.holes:
                return _relief_mesh(solid).placed(solid.placement)
            overhang = 0.1 * float(solid.heights.max())
            cut = tuple(
                Prism(Disc(radius, (x, y)), -overhang, 11.0 * overhang, solid.placement)
                for x, y, radius in solid.holes
            )
            block = Part("block", 1.0, (replace(solid, holes=()),), cut)
            return part_mesh(block, sections)


def _relief_mesh(relief: Relief) -> Mesh:
    """A relief without its holes, in its own frame."""
    x, y = np.meshgrid(relief.x, relief.y, indexing="ij")
    upper = np.stack([x, y, relief.heights], axis=-1)
    lower = upper * [1.0, 1.0, 0.0]
    corners = []
    for face, order in ((upper, (0, 1, 2)), (lower, (0, 2, 1))):
        a, b, c, d = face[:-1, :-1], face[1:, :-1], face[1:, 1:], face[:-1, 1:]
        corners += [
            np.stack([three[corner] for corner in order], axis=2).reshape(-1, 3, 3)
            for three in ((a, b, c), (a, c, d))
        ]
    # Counter-clockwise from above, as rings on both faces.
    rim = [
        np.concatenate([face[:-1, 0], face[-1, :-1], face[:0:-1, -1], face[0, :0:-1]])
        for face in (lower, upper)
    ]
    corners.append(_sides(rim[0][None], rim[1][None]))
    return Mesh.of_corners(np.concatenate(corners))


def _revolved(profile: FloatArray, sections: int) -> FloatArray:
    """Triangle corners of a closed profile, r and z, revolved about z; some may be degenerate."""
    radii, heights = profile.T[:, :, None, None]
    plane = radii * ring_points(2.0 * pi * np.arange(sections) / sections)
    vertices = np.concatenate([plane, heights + 0.0 * plane[:, :, :1]], axis=2)
    return _sides(vertices, np.roll(vertices, -1, axis=0))


def _sides(lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Triangles between closed rings of points, each shape (rings, n, 3)."""
    next_lower, next_upper = (np.roll(ring, -1, axis=1) for ring in (lower, upper))
    pairs = ((lower, next_lower, next_upper), (lower, next_upper, upper))
    return np.concatenate([np.stack(three, axis=2).reshape(-1, 3, 3) for three in pairs])


PRIMITIVE_SECTIONS, RINGS = 32, 8
"""Chords per full circle of MuJoCo's primitive shapes, and per quarter of a meridian."""


def primitive_mesh(kind: int, size: FloatArray) -> Mesh | None:
    """Surface of a MuJoCo primitive shape about its own centre; None for other kinds.

    `size` is MuJoCo's: half extents, radii, or radius and half length along z [m].
    """
    # MuJoCo takes a third of a second to import, and parts do not need it.
    from mujoco import mjtGeom  # noqa: PLC0415

    quarter = np.linspace(0.0, 0.5 * pi, RINGS + 1)
    arc = np.column_stack([np.cos(quarter), np.sin(quarter)])
    # Exactly on the axis, so that its points coincide.
    arc[-1, 0] = 0.0
    mirrored = arc[:0:-1] * [1.0, -1.0]
    r, h = size[0], size[1]
    match mjtGeom(kind):
        case mjtGeom.mjGEOM_BOX:
            signs = np.array(list(product((-1.0, 1.0), repeat=3)))
            sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]
            sides.append((1, 5, 7, 3))
            triangles = [three for a, b, c, d in sides for three in ((a, b, c), (a, c, d))]
            return Mesh(signs * size, np.array(triangles, dtype=np.int64))
        case mjtGeom.mjGEOM_SPHERE | mjtGeom.mjGEOM_ELLIPSOID as ball_kind:
            radii = size if ball_kind == mjtGeom.mjGEOM_ELLIPSOID else np.full(3, r)
            ball = _revolved(np.concatenate([mirrored, arc]), PRIMITIVE_SECTIONS)
            return Mesh.of_corners(ball * radii)
        case mjtGeom.mjGEOM_CYLINDER:
            profile = np.array([[0.0, -h], [r, -h], [r, h], [0.0, h]])
            return Mesh.of_corners(_revolved(profile, PRIMITIVE_SECTIONS))
        case mjtGeom.mjGEOM_CAPSULE:
            caps = [r * mirrored - [0.0, h], r * arc[:1] - [0.0, h], r * arc + [0.0, h]]
            return Mesh.of_corners(_revolved(np.concatenate(caps), PRIMITIVE_SECTIONS))
    return None
