"""Which of the bodies in a MJCF world is the robot."""

from collections.abc import Sequence

import mujoco
import numpy as np

from ocs_design.exceptions import RobotError
from ocs_design.robot.remarks import Remarks

_FREE = mujoco.mjtJoint.mjJNT_FREE


def find_base(model: mujoco.MjModel, remarks: Remarks) -> int:
    """Index of the floating base: the body with a free joint, of several the robot's.

    A robot is told from a loose object by its joints, then by its mass. In a world where nothing
    is free the robot's own joints to the world, if any, are dropped.
    """
    candidates = [
        body
        for body in range(1, model.nbody)
        if model.body_parentid[body] == 0 and model.body_mocapid[body] < 0
    ]
    if not candidates:
        raise RobotError("the model has no bodies", hint="is this the file that was meant?")
    free = [body for body in candidates if _joint_types(model, body)[:1] == [_FREE]]
    base = max(free or candidates, key=lambda body: _rank(model, body))
    name = model.body(base).name
    if not free:
        remarks.add("no body has a free joint: taken as the floating base", name)
    for body in free:
        if body != base:
            remarks.add("other free bodies, left out", model.body(body).name)
    return base


def bodies_of(model: mujoco.MjModel, base: int) -> Sequence[int]:
    """The base and all bodies below it, parents first."""
    return [int(body) for body in np.flatnonzero(model.body_rootid == base)]


def _rank(model: mujoco.MjModel, body: int) -> tuple[bool, float]:
    below = [each for each in bodies_of(model, body) if each != body]
    moves = any(model.body_jntnum[each] for each in below)
    return moves, float(model.body_subtreemass[body])


def _joint_types(model: mujoco.MjModel, body: int) -> list[int]:
    first = model.body_jntadr[body]
    return list(model.jnt_type[first : first + model.body_jntnum[body]]) if first >= 0 else []
