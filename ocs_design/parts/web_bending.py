"""Bending of a wheel's web by a push along its axis, which its rim passes on to its hub."""

from dataclasses import dataclass
from math import pi

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.rim import HoleRing

_ELEMENTS = 200
"""Number of elements between hub and rim: the deflection is exact to 1e-4."""


@dataclass(frozen=True)
class BentWeb:
    """A web under a push along the wheel's axis.

    Attributes:
        stress: largest bending stress at hub, rim or holes [Pa].
        deflection: of the rim along the axis [m].
    """

    stress: float
    deflection: float


def bent_web(
    force: float,
    radii: tuple[float, float],
    thickness: float,
    *,
    elastic_modulus: float,
    poisson_ratio: float,
    holes: HoleRing | None = None,
) -> BentWeb:
    """Bending of a disc whose edges cannot turn, held by the hub and pushed by the rim.

    Kirchhoff's plate: with the slope `f` and `M_r = D (f' + nu f / r)`, `M_t = D (f / r + nu f')`,
    it is `(r M_r)' = M_t - F / (2 pi)`, solved by linear finite elements for f. Holes reduce D to
    the share of material left at their radii, and raise the moment in what is left.

    Args:
        force: along the axis [N]. radii: of hub and bore [m]. thickness: of the web [m].
        elastic_modulus: [Pa]. poisson_ratio: of its material.
        holes: in it; None: none.
    """
    nodes = np.linspace(*radii, _ELEMENTS + 1)
    step, middle = nodes[1] - nodes[0], (nodes[:-1] + nodes[1:]) / 2.0
    left = np.ones(_ELEMENTS) if holes is None else _share_left(holes, middle)
    plate = elastic_modulus * thickness**3 / (12.0 * (1.0 - poisson_ratio**2)) * left
    # Energy per element of D (r f'^2 + 2 nu f f' + f^2 / r) / 2, evaluated in its middle.
    tension, own = plate * middle / step, plate * step / (4.0 * middle)
    ends, across = tension + own, own - tension
    mixed = poisson_ratio * plate
    diagonal = np.append(ends - mixed, 0.0) + np.append(0.0, ends + mixed)
    load = np.full(nodes.size, force / (2.0 * pi) * step)
    load[[0, -1]] /= 2.0
    turned = np.zeros(nodes.size)
    turned[1:-1] = _tridiagonal_solution(diagonal[1:-1], across[1:-1], load[1:-1])
    # Moments at the edges balance what is left of the equations there.
    first = across[0] * turned[1] - load[0]
    last = across[-1] * turned[-2] - load[-1]
    edges = np.abs([first / radii[0], last / radii[1]])
    between = turned[:-1] + turned[1:]
    radial = plate * (np.diff(turned) / step + poisson_ratio * between / (2.0 * middle))
    moment = max(float(edges.max()), float((np.abs(radial) / left).max()))
    return BentWeb(6.0 * moment / thickness**2, float(between.sum() * step / 2.0))


def _tridiagonal_solution(
    diagonal: FloatArray, beside: FloatArray, right: FloatArray
) -> list[float]:
    """Solution of a symmetric tridiagonal system, by Thomas's algorithm.

    SciPy has it too, but importing that takes most of the time in which parts are exported.
    """
    pivots, left = diagonal.tolist(), beside.tolist()
    solution: list[float] = right.tolist()
    for row in range(1, len(pivots)):
        factor = left[row - 1] / pivots[row - 1]
        pivots[row] -= factor * left[row - 1]
        solution[row] -= factor * solution[row - 1]
    solution[-1] /= pivots[-1]
    for row in range(len(pivots) - 2, -1, -1):
        solution[row] = (solution[row] - left[row] * solution[row + 1]) / pivots[row]
    return solution


def _share_left(holes: HoleRing, radius: FloatArray) -> FloatArray:
    """Share of the circles of these radii [m] that is not in a hole."""
    circle, hole = holes.circle_radius, holes.hole_radius
    cosine = (radius**2 + circle**2 - hole**2) / (2.0 * radius * circle)
    return np.asarray(1.0 - holes.count / pi * np.arccos(np.clip(cosine, -1.0, 1.0)))
