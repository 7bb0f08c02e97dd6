"""Joint limits in degrees."""

import numpy as np

from ocs_design.robot.tree import Joint, JointKind

DEGREES = (8.0 * np.pi, 1440.0)
"""Range of a hinge [rad] that four turns of degrees would be; beyond, it is meant to be endless."""


def is_in_degrees(joint: Joint) -> bool:
    """Whether the range of a hinge is one of degrees."""
    fewest, most = DEGREES
    return joint.kind is JointKind.REVOLUTE and fewest < joint.upper - joint.lower <= most
