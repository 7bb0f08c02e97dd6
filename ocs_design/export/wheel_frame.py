"""Where the frame of a flywheel stands: at its centre, z along the spin axis."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Module
from ocs_design.robot.rotations import rotation_from_rpy
from ocs_design.robot.tree import Placement


def wheel_rpy(axis: FloatArray) -> tuple[float, float, float]:
    """Roll, pitch and yaw [rad] of the frame whose z axis is the unit vector `axis`.

    Of all such frames the one without pitch: `z = Rz(yaw) Rx(roll) e_z
    = (sin(yaw) sin(roll), -cos(yaw) sin(roll), cos(roll))`, with roll in -pi..0. For the paper's
    axes roll is -90 degrees, and yaw is the incidence angle, negative on the left.
    """
    x, y, z = (float(value) for value in axis)
    return -float(np.arctan2(np.hypot(x, y), z)), 0.0, float(np.arctan2(-x, y))


def wheel_placement(module: Module) -> Placement:
    """The flywheel's frame in the base frame B."""
    return Placement(rotation_from_rpy(*wheel_rpy(module.axis)), module.position)
