"""Solids on a trunk, for measuring distances from the robot's links, and how a limb hits them.

Devices describe themselves by these without MuJoCo, which measures the distances (`collision.py`).
"""

from collections.abc import Mapping
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


@dataclass(frozen=True)
class Reach:
    """Shortest movement by which a limb hits a solid.

    Attributes:
        part: name of the body that hits it first.
        joints: values at the contact [rad or m], on a straight path from the nominal posture; one
            joint if one is enough.
    """

    part: str
    joints: Mapping[str, float]
