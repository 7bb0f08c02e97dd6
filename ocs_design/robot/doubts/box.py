"""The room that a body takes, as far as its shapes tell within milliseconds."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.files.mesh_bounds import quick_mesh_bounds
from ocs_design.robot.tree import Body, Shape, ShapeKind

FLAT = 1e-6
"""A body that is thinner has no box [m]."""


@dataclass(frozen=True, eq=False)
class Box:
    """Around all shapes of a body, along the axes of its frame.

    Attributes:
        lower, upper: corners [m], shape (3,).
    """

    lower: FloatArray
    upper: FloatArray

    @property
    def sides(self) -> FloatArray:
        """[m], shape (3,)."""
        return self.upper - self.lower

    @property
    def volume(self) -> float:
        """[m^3]."""
        return float(np.prod(self.sides))


def box_of(body: Body) -> Box | None:
    """The box of all that a body collides with or shows; None if part of that is not known.

    Where a shape is missing or slow to read, or a link has a mass and no shape, what is left may be
    a fraction of the body, and no inertia can be called too large for it.
    """
    shaped = {shape.link for shape in body.shapes}
    if any(mass > 0.0 and link not in shaped for link, mass in body.link_masses.items()):
        return None
    corners = []
    for shape in body.shapes:
        own = _own_bounds(shape)
        if own is None:
            return None
        centre, half = own.mean(axis=0), 0.5 * (own[1] - own[0])
        middle = shape.position + shape.rotation @ centre
        reach = np.abs(shape.rotation) @ half
        corners += [middle - reach, middle + reach]
    if not corners:
        return None
    box = Box(np.min(corners, axis=0), np.max(corners, axis=0))
    return box if (box.sides > FLAT).all() else None


def _own_bounds(shape: Shape) -> FloatArray | None:
    """Lower and upper corner in the shape's own frame [m], shape (2, 3)."""
    match shape.kind:
        case ShapeKind.MESH:
            return None if shape.mesh is None else quick_mesh_bounds(shape.mesh, shape.size)
        case ShapeKind.BOX:
            half = np.array(shape.size)
        case ShapeKind.SPHERE:
            half = np.full(3, shape.size[0])
        case ShapeKind.CYLINDER:
            half = np.array([shape.size[0], shape.size[0], shape.size[1]])
        case ShapeKind.CAPSULE:
            half = np.array([shape.size[0], shape.size[0], sum(shape.size)])
    return np.array([-half, half])
