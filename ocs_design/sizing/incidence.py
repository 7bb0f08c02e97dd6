"""The incidence angle of the two wheel axes (THEORY, section 4)."""

import numpy as np

from ocs_design.arrays import FloatArray, frozen


def module_axes(incidence: float) -> FloatArray:
    """Unit spin axes of the left and the right wheel in B as columns, shape (3, 2) (paper, section 3.2).

    Args:
        incidence: angle between a wheel axis and the lateral direction y [rad], 0..pi/2.
    """
    sine, cosine = np.sin(incidence), np.cos(incidence)
    return frozen([[sine, -sine], [cosine, cosine], [0.0, 0.0]])
