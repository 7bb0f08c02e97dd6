"""How much of what is only to look at goes into a MuJoCo model."""

from collections.abc import Iterator, Set
from itertools import accumulate
from pathlib import Path

from ocs_design.robot.tree import Shape, Tree

VISUAL_BYTES = 16 * 2**20
"""Files of meshes to look at, in all; reading a .dae takes about 0.1 s and 25 MB of memory per MB.

Whoever exports a CAD model with every screw as the visual of a trunk gets 30 MB and 350,000
facets, more than all else together.
"""


def oversized_visuals(tree: Tree) -> Set[Path]:
    """Mesh files that only show and that go beyond `VISUAL_BYTES`, smallest first, in all."""
    touching = {shape.mesh for shape in _shapes(tree) if shape.collides}
    showing = {shape.mesh for shape in _shapes(tree) if shape.mesh is not None} - touching
    sizes = sorted((path.stat().st_size, path) for path in showing if path is not None)
    totals = accumulate(size for size, _ in sizes)
    return frozenset(
        path for total, (_, path) in zip(totals, sizes, strict=True) if total > VISUAL_BYTES
    )


def _shapes(tree: Tree) -> Iterator[Shape]:
    for body in tree.bodies:
        yield from body.shapes
