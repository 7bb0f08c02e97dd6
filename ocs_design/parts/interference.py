"""Whether parts overlap, and how far apart they are."""

from collections.abc import Iterable, Sequence

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.parts.flattening import SECTIONS
from ocs_design.parts.mesh import part_manifold
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism


def overlap_volume(one: Part, other: Part, sections: int = SECTIONS) -> float:
    """Of both parts' meshes in one frame [m^3]."""
    return float((part_manifold(one, sections) ^ part_manifold(other, sections)).volume())


def swept(part: Part) -> Part:
    """What a part of bodies of revolution takes up over a full turn: its holes are not regarded.

    Raises:
        ValueError: it has prisms, which sweep more than themselves.
    """
    if any(isinstance(solid, Prism) for solid in part.joined):
        raise ValueError(f"{part.name} is no body of revolution")
    return Part(part.name, part.density, part.joined)


def turning_clearance(
    wheel: Iterable[Part], still: Iterable[Part], reach: float, sections: int = SECTIONS
) -> float:
    """Smallest gap between turning parts and still ones over a full turn [m].

    Args:
        wheel: bodies of revolution about z, with holes.
        still: of any shape, in the same frame.
        reach: how far is looked [m]: the answer if the gap is larger.
        sections: of the meshes, whose polygons are about `R x^2 / 12`, `x = 2 pi / n`, off the
            circle: 2 um at 40 mm with 256.
    """
    bodies = [part_manifold(swept(part), sections) for part in wheel]
    around = [part_manifold(part, sections) for part in still]
    return min(float(body.min_gap(other, reach)) for body in bodies for other in around)


def profile_clearance(ours: Sequence[FloatArray], theirs: Sequence[FloatArray]) -> float:
    """Smallest distance between bodies of revolution about one axis [m]; exact.

    It lies in a half plane through the axis: between two edges of the cross-sections, of which one
    ends there. They must not overlap.

    Args:
        ours, theirs: cross-sections, each r and z of its corners [m], shape (n, 2).
    """
    return min(
        min(_to_edges(one, other), _to_edges(other, one)) for one in ours for other in theirs
    )


def _to_edges(corners: FloatArray, polygon: FloatArray) -> float:
    """Smallest distance of corners, shape (m, 2), to the edges of a polygon, shape (n, 2)."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    offsets = corners[:, None] - polygon
    share = np.clip(np.sum(offsets * edges, axis=2) / np.sum(edges**2, axis=1), 0.0, 1.0)
    return float(np.linalg.norm(offsets - share[..., None] * edges, axis=2).min())
