"""Inertias that do not go with what a body looks like.

What lies between two planes at a distance L cannot have a larger variance along their normal than
L^2 / 4 (Popoviciu1935 in docs/references.md). The variance of a mass along an axis is
(tr(I) / 2 - I_ii) / m, and its root the radius of gyration about the plane through its centre.
"""

from collections.abc import Iterator

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.doubts.box import Box
from ocs_design.robot.mass_properties import MassProperties, physical_defect

TOO_LARGE = 1.25
"""Of a radius of gyration over what fits into the body's box: 1.6 times the largest inertia.

Above 1 is impossible already, but shapes leave out screws, cables and fins. Whole shapes of public
robots that look right reach 1.14.
"""

TOO_SMALL = 0.2
"""Of a radius of gyration over a full box's: a 25th of its inertia. Public robots begin at 0.27."""

OUTSIDE = 0.05
"""Of a centre of mass, how far it is out of the box, over the longest side."""

ELONGATED, SWAPPED = 1.75, 2.0
"""A body so many times as long as wide has its mass along the length: if the variance of its mass
is so many times larger across, the inertia belongs to other axes."""

SHIFTED = 2.0
"""An inertia that is so many times a full box's, and less than that over this if the parallel axes
to the frame's origin are taken off, is about the origin."""


def inertia_doubts(weighed: MassProperties, box: Box) -> Iterator[tuple[str, str]]:
    """What is wrong between a body's mass properties and its box, and by how much.

    Args:
        weighed: physical, of a mass above zero, in the body's frame.
        box: of the body, in its frame.
    """
    outside = float(np.maximum(box.lower - weighed.com, weighed.com - box.upper).max())
    variances = mass_variances(weighed.inertia, weighed.mass)
    excess = _excess(variances, box)
    share = _share(variances, box)
    if outside > OUTSIDE * box.sides.max():
        yield (
            "links whose centre of mass is outside of their shapes: in another frame, or in "
            "millimetres?",
            f"by {1e3 * outside:.3g} mm",
        )
    elif _is_about_origin(weighed, box):
        yield (
            "links whose inertia is about their origin, not their centre of mass?",
            f"{share:.3g} times a full box's",
        )
    elif excess > TOO_LARGE:
        yield _too_large(weighed, box), f"radius of gyration {excess:.3g} times what fits"
    elif share < TOO_SMALL**2:
        yield (
            "links with too little inertia for their shapes: another unit than kg m2, or a mesh "
            "without its scale?",
            f"{share:.2g} times a full box's",
        )
    elif _is_swapped(variances, box.sides):
        yield _OTHER_AXES, "most of it about the long side"


_OTHER_AXES = "links whose inertia does not lie as their shapes do: written in other axes?"


def mass_variances(inertia: FloatArray, mass: float) -> FloatArray:
    """Variance of the mass along each axis [m^2], shape (3,)."""
    return np.asarray(np.maximum(0.5 * np.trace(inertia) - np.diag(inertia), 0.0) / mass)


def _excess(variances: FloatArray, box: Box) -> float:
    """Largest radius of gyration over what fits into the box."""
    return float(np.sqrt((variances / (0.25 * box.sides**2)).max()))


def _share(variances: FloatArray, box: Box) -> float:
    """Polar inertia over that of the full box."""
    return float(variances.sum() / (box.sides @ box.sides / 12.0))


def _is_swapped(variances: FloatArray, sides: FloatArray) -> bool:
    long = int(np.argmax(sides))
    wide = (sides[long] > ELONGATED * sides) & (variances > SWAPPED * variances[long])
    return bool(wide.any())


def _is_about_origin(weighed: MassProperties, box: Box) -> bool:
    """Whether an inertia beyond a full box's is one of a body after moving it to its centre."""
    offset = MassProperties(weighed.mass, weighed.com, np.zeros((3, 3))).inertia_about(np.zeros(3))
    moved = MassProperties(weighed.mass, weighed.com, weighed.inertia - offset)
    if physical_defect(moved) is not None:
        return False
    before, after = (
        _share(mass_variances(each.inertia, each.mass), box) for each in (weighed, moved)
    )
    return before > SHIFTED and after < before / SHIFTED


def _too_large(weighed: MassProperties, box: Box) -> str:
    """The likeliest mistake: other axes if any turn by right angles would fit."""
    orders = ([0, 2, 1], [2, 1, 0], [1, 0, 2], [1, 2, 0], [2, 0, 1])
    turned = [weighed.inertia[np.ix_(order, order)] for order in orders]
    if any(_excess(mass_variances(each, weighed.mass), box) < TOO_LARGE for each in turned):
        return _OTHER_AXES
    return (
        "links with more inertia than fits into their shapes: another unit than kg m2, a "
        "placeholder, or a mesh without its scale?"
    )
