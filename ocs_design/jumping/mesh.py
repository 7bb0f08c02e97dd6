"""When the nodes of a push-off are: closer towards its end, where the legs are quickest.

Between nodes the second derivatives are linear in time: the coordinates are cubic splines
(de Boor, A Practical Guide to Splines, chapter IV).
"""

import numpy as np

from ocs_design.arrays import FloatArray, frozen

NODES = 17

_LAST = 0.25
"""Length of the last interval over that of the first."""

STEPS = frozen(np.linspace(1.0, _LAST, NODES - 1) / np.linspace(1.0, _LAST, NODES - 1).sum())
"""Of the intervals, as shares of the duration, shape (NODES - 1,)."""

SHARES = frozen(np.append(0.0, np.cumsum(STEPS)))
"""Of the duration that has passed at each node, shape (NODES,)."""

WEIGHTS = frozen((np.append(0.0, STEPS) + np.append(STEPS, 0.0)) / 2.0)
"""Of the nodes in an integral over the shares, by trapezoids, shape (NODES,)."""


def spline_slopes(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First and second derivatives, by the share, of the spline through `values` at the nodes.

    It starts at rest, and its end is natural; all of shape (m, NODES).
    """
    rise = np.diff(values, axis=1) / STEPS
    matrix, right = np.eye(NODES), np.zeros_like(values)
    matrix[0, :2], right[:, 0] = (2.0 * STEPS[0], STEPS[0]), 6.0 * rise[:, 0]
    for k in range(1, NODES - 1):
        before, after = STEPS[k - 1], STEPS[k]
        matrix[k, k - 1 : k + 2] = before, 2.0 * (before + after), after
        right[:, k] = 6.0 * (rise[:, k] - rise[:, k - 1])
    second = np.linalg.solve(matrix, right.T).T
    gained = np.cumsum(0.5 * STEPS * (second[:, 1:] + second[:, :-1]), axis=1)
    first = np.hstack([np.zeros((len(values), 1)), gained])
    return first, np.asarray(second, dtype=np.float64)
