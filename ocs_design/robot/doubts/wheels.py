"""Wheels whose inertia is not round about their axle."""

from collections.abc import Iterator

import numpy as np

from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.tree import Joint

LOPSIDED = 0.05
"""Of a wheel's inertia, what is not round, over its largest moment across the axle.

Wheels of public robots are round to 0.001.
"""


def wheel_doubts(weighed: MassProperties, joint: Joint) -> Iterator[tuple[str, str]]:
    """What is wrong with the inertia of a body that is round about its endless joint."""
    across = np.linalg.svd(joint.axis[None])[2][1:]
    moments = np.linalg.eigvalsh(across @ weighed.inertia @ across.T)
    product = float(np.linalg.norm(across @ weighed.inertia @ joint.axis))
    unround = max(float(moments[1] - moments[0]), product) / max(float(moments[1]), 1e-300)
    if unround > LOPSIDED:
        yield (
            "links that are round about their joint with an inertia that is not: in other axes?",
            f"by {unround:.0%}",
        )
