"""How far the wheels are from the robot and from each other in the nominal posture."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.design import Device
from ocs_design.export.attach import attach_device
from ocs_design.export.naming import flywheel_names
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.contacts import posture_qpos
from ocs_design.robot.spec.model import build_spec

_FARTHEST = 10.0
"""Distances are looked for up to this [m]."""


@dataclass(frozen=True)
class Clearance:
    """The part that a wheel is nearest to.

    Attributes:
        part: name of a body of the robot, or of the other wheel.
        distance: between the surfaces, negative if they overlap [m].
    """

    part: str
    distance: float


def nearest_part(robot: Robot, device: Device) -> Clearance | None:
    """What the wheels come closest to; None if the robot has no collision geometry.

    Meshes count as their convex hulls. The device is looked at as it is delivered, and the joints
    as they stand in the nominal posture: what moves into a wheel is not seen.
    """
    spec = build_spec(robot, visuals=False).spec
    attach_device(spec, robot, device)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_forward(model, data)
    left, right = (model.geom(name).id for name in flywheel_names(device))
    others = [geom for geom in range(model.ngeom) if geom not in {left, right}]
    pairs = [(wheel, geom) for wheel in (left, right) for geom in others] + [(left, right)]
    fromto = np.zeros(6)
    distances = [
        mujoco.mj_geomDistance(model, data, wheel, geom, _FARTHEST, fromto) for wheel, geom in pairs
    ]
    nearest = int(np.argmin(distances))
    part = model.body(int(model.geom_bodyid[pairs[nearest][1]])).name
    return Clearance(part, float(distances[nearest])) if others else None
