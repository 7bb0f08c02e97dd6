"""Polynomials of one interval: Radau collocation of the states, Bernstein form of the limits.

On each interval, s = 0..1, the states are polynomials through its start and its Radau points, where
they satisfy the equations of motion (Kelly, SIAM Review 59(4), 2017; the points: Hairer and Wanner,
Solving Ordinary Differential Equations II, section IV.5). The motor torques are parabolas. A
polynomial in Bernstein form lies between its smallest and its largest coefficient (Farouki,
Computer Aided Geometric Design 29, 2012), so limits on the coefficients hold between the points
too.
"""

from math import comb

import numpy as np
from numpy.polynomial import legendre

from ocs_design.common.arrays import FloatArray

DEGREE = 3
"""Degree of the states: an error of the fifth order in the length of the interval."""

TORQUE_DEGREE = 2


def radau_points(count: int) -> FloatArray:
    """Zeros of P_n - P_(n-1) on 0..1, increasing, the last of them 1; P_n: Legendre polynomials."""
    series = np.zeros(count + 1)
    series[count - 1 :] = -1.0, 1.0
    points = 0.5 * (np.sort(legendre.legroots(series).real) + 1.0)
    points[-1] = 1.0
    return points


def bernstein_basis(s: FloatArray, degree: int = TORQUE_DEGREE) -> FloatArray:
    """Values at `s` of each Bernstein polynomial, shape (len(s), degree + 1)."""
    i = np.arange(degree + 1)
    counts = np.array([comb(degree, k) for k in i])
    x = np.asarray(s)[:, None]
    return np.asarray(counts * x**i * (1.0 - x) ** (degree - i))


def bernstein_product(degree: int) -> list[list[tuple[int, float]]]:
    """Weights of a_i b_(k-i) in each Bernstein coefficient k of a product, pairs (i, weight).

    `C(n, i) C(n, k - i) / C(2 n, k)` for two factors of degree n (Farouki 2012, section 3).
    """
    return [
        [
            (i, comb(degree, i) * comb(degree, k - i) / comb(2 * degree, k))
            for i in range(max(0, k - degree), min(k, degree) + 1)
        ]
        for k in range(2 * degree + 1)
    ]


def _from_monomials(degree: int) -> FloatArray:
    """Matrix from coefficients of 1, s, s^2, ... to Bernstein coefficients."""
    rows = range(degree + 1)
    return np.array([[comb(i, k) / comb(degree, k) for k in rows] for i in rows])


NODES = np.append(0.0, radau_points(DEGREE))
"""0 and the Radau points, the last of which is 1, shape (n + 1,) with n = `DEGREE`."""

_POWERS = np.arange(1, DEGREE + 1)
_MONOMIALS = np.linalg.inv(np.vander(NODES, increasing=True))
_TO_BERNSTEIN = _from_monomials(DEGREE)

DERIVATIVE = (_POWERS * NODES[1:, None] ** (_POWERS - 1)) @ _MONOMIALS[1:]
"""Matrix from the values at the nodes to d/ds at the Radau points, shape (n, n + 1)."""

BERNSTEIN = _TO_BERNSTEIN @ _MONOMIALS
"""Matrix from the values at the nodes to Bernstein coefficients, shape (n + 1, n + 1)."""

TORQUE = bernstein_basis(NODES[1:])
"""Matrix from a torque's Bernstein coefficients to its values at the Radau points, shape (n, 3)."""

ELEVATION = _TO_BERNSTEIN[:, : TORQUE_DEGREE + 1] @ np.linalg.inv(_from_monomials(TORQUE_DEGREE))
"""Matrix from those coefficients to the ones of degree n, shape (n + 1, 3)."""

WEIGHTS = np.linalg.solve(np.vander(NODES[1:], increasing=True).T, 1.0 / _POWERS)
"""Weights of the Radau points in an integral over s, shape (n,)."""

SQUARE = np.array(
    [
        [
            comb(TORQUE_DEGREE, i) * comb(TORQUE_DEGREE, k) / comb(2 * TORQUE_DEGREE, i + k)
            for k in range(TORQUE_DEGREE + 1)
        ]
        for i in range(TORQUE_DEGREE + 1)
    ]
) / (2 * TORQUE_DEGREE + 1)
"""Gram matrix G: b^T G b is the integral of a torque's square over s, shape (3, 3)."""
