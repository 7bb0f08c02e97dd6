"""Analytic reference trajectories: a turn about a fixed axis, its torque from the gyrostat."""

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.simulation.reference import Turn
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import Trajectory


def from_rest(body: Gyrostat, turn: Turn, *, samples: int = 4001) -> Trajectory:
    """Trajectory of a gyrostat without momentum for `turn`, including the resulting yaw.

    H = I w + h A W = 0 gives the wheels' speeds, and its z row, where A is 0, the yaw rate. Roll
    and pitch rate move the vertical as the turn does. Then h A^T w' + (h + a) W' = tau.
    """
    time = np.linspace(0.0, turn.duration, samples)
    vertical = _vertical(turn, time)
    rate = _rate(body, vertical, np.gradient(vertical, time, axis=0, edge_order=2))
    share = np.linalg.pinv(body.axes)
    speed = -rate @ (share @ body.inertia).T / body.spin_inertia
    acceleration = np.gradient(rate, time, axis=0, edge_order=2)
    spin_up = np.gradient(speed, time, axis=0, edge_order=2)
    torque = body.spin_inertia * acceleration @ body.axes
    torque += (body.spin_inertia + body.armature) * spin_up
    return Trajectory(time, vertical, rate, acceleration, speed, torque, "by hand")


def _vertical(turn: Turn, time: FloatArray) -> FloatArray:
    """Rodrigues' formula for the upward direction, seen from a trunk turned about `turn.axis`."""
    n, up = turn.axis, np.array([0.0, 0.0, 1.0])
    angle = -turn.angle(time)[:, None]
    along = n * (n @ up)
    return np.cos(angle) * (up - along) + np.sin(angle) * np.cross(n, up) + along


def _rate(body: Gyrostat, vertical: FloatArray, change: FloatArray) -> FloatArray:
    """Rate from `v' = v x w` and `(I w)_z = 0`: four equations, one of them redundant."""
    equations = np.empty((len(vertical), 4, 3))
    equations[:, :3] = np.cross(vertical[:, None], np.eye(3)).swapaxes(1, 2)
    equations[:, 3] = body.inertia[2] / body.inertia[2, 2]
    right_side = np.column_stack([change, np.zeros(len(change))])
    return np.einsum("nij,nj->ni", np.linalg.pinv(equations), right_side)
