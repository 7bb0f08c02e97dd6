"""Simple solids in the trunk's frame that stand in for a device or a part of it."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Ball:
    """What a module may sweep.

    Attributes:
        center: in B [m], shape (3,).
        radius: [m].
    """

    center: FloatArray
    radius: float

    @property
    def reach(self) -> float:
        """Of the ball around it [m]."""
        return self.radius


@dataclass(frozen=True, eq=False)
class Drum:
    """A cylinder, what a module is as it stands.

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
        """Of the ball around it [m]."""
        return float(np.hypot(self.radius, 0.5 * self.height))


Probe = Ball | Drum
