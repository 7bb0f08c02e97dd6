"""Joint limits in degrees, and efforts that limit nothing."""

from collections.abc import Iterator, Sequence

import numpy as np

from ocs_design.robot.robot import Leg
from ocs_design.robot.tree import Joint, JointKind, Tree

DEGREES = (8.0 * np.pi, 1440.0)
"""Range of a hinge [rad] that four turns of degrees would be; beyond, it is meant to be endless."""


def is_in_degrees(joint: Joint) -> bool:
    """Whether the range of a hinge is one of degrees."""
    fewest, most = DEGREES
    return joint.kind is JointKind.REVOLUTE and fewest < joint.upper - joint.lower <= most


EFFORT = 10.0
"""Effort of a leg's joint, over weight times the leg's length, that is a placeholder: legs that
somebody has built lie between 0.3 and 0.7."""

_GRAVITY = 9.81


def effort_doubts(tree: Tree, legs: Sequence[Leg], mass: float) -> Iterator[tuple[str, str]]:
    """What joints of the legs hardly can give, each with its joint.

    Args:
        tree: of the robot. legs: of it. mass: of the whole [kg].
    """
    for leg in legs:
        most = EFFORT * mass * _GRAVITY * leg.length
        for name in leg.joints:
            joint = tree.joints[name]
            if joint.kind is JointKind.REVOLUTE and most < joint.effort < np.inf:
                yield (
                    f"efforts over {EFFORT:.0f} times weight times leg length limit no jump: state "
                    f"what the motors give",
                    f"{name} ({joint.effort:.4g} N m)",
                )
