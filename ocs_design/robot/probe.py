"""Solids on a trunk, for measuring distances from the robot's links.

Devices describe themselves by these without MuJoCo, which measures the distances (`collision.py`).
"""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Ball:
    """Ball that a module may sweep through.

    Attributes:
        center: in B [m], shape (3,).
        radius: [m].
    """

    center: FloatArray
    radius: float

    @property
    def reach(self) -> float:
        """Radius of the ball around it [m]."""
        return self.radius


@dataclass(frozen=True, eq=False)
class Drum:
    """Cylinder that a module occupies.

    Attributes:
        center: in B [m], shape (3,).
        axis: unit vector in B, shape (3,).
        radius, height: [m].
    """

    center: FloatArray
    axis: FloatArray
    radius: float
    height: float

    @property
    def reach(self) -> float:
        """Radius of the ball around it [m]."""
        return float(np.hypot(self.radius, 0.5 * self.height))


Probe: TypeAlias = Ball | Drum
"""Solid on the trunk."""
