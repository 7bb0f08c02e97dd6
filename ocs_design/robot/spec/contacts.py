"""What of a robot may touch what: feet that have nothing to stand on, links that overlap."""

from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.robot.robot import Leg, Robot
from ocs_design.robot.spec.bodies import body_names

_FOOT_SHARE = 0.02
"""Radius of a foot that is a bare point, as a share of its leg's length."""


def add_missing_feet(spec: mujoco.MjSpec, model: mujoco.MjModel, robot: Robot) -> None:
    """Give each foot that has nothing to stand on a small sphere, named after the foot's link.

    Args:
        spec: to change.
        model: that it was compiled to.
        robot: that it was built from.
    """
    names = body_names(robot.tree)
    for leg in robot.legs:
        name = names[leg.body]
        if _has_collision_geometry(model, name):
            continue
        # The tree's frame stands at the joint; that of a body in the model is its link's.
        link = robot.tree.bodies[leg.body].links[robot.tree.bodies[leg.body].name].inverse()
        spec.body(name).add_geom(
            name=foot_geom_name(leg),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[leg.foot_radius or _FOOT_SHARE * leg.length, 0.0, 0.0],
            pos=link.rotation @ leg.foot + link.position,
        )


def foot_geom_name(leg: Leg) -> str:
    """Name of the sphere that a foot without collision geometry gets."""
    return f"ocs_foot_{leg.name}"


def _has_collision_geometry(model: mujoco.MjModel, body: str) -> bool:
    welded = model.body_weldid == model.body_weldid[model.body(body).id]
    return bool(np.any(_collides(model) & welded[model.geom_bodyid]))


def _collides(model: mujoco.MjModel) -> NDArray[np.bool_]:
    collides: NDArray[np.bool_] = (model.geom_contype | model.geom_conaffinity) != 0
    return collides


def exclude_neighbours(spec: mujoco.MjSpec, model: mujoco.MjModel, robot: Robot) -> None:
    """Forbid contact of bodies that touch in the nominal posture.

    Collision geometry of neighbouring links overlaps in most robot files; contact there would
    only throw the robot about. Arguments as for `add_missing_feet`.
    """
    for first, second in sorted(set(_touching(model, robot))):
        spec.add_exclude(bodyname1=model.body(first).name, bodyname2=model.body(second).name)


def _touching(model: mujoco.MjModel, robot: Robot) -> Iterator[tuple[int, int]]:
    data = mujoco.MjData(model)
    data.qpos[:] = posture_qpos(model, robot)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_collision(model, data)
    for first, second in model.geom_bodyid[data.contact.geom]:
        yield min(first, second), max(first, second)


def posture_qpos(model: mujoco.MjModel, robot: Robot) -> FloatArray:
    """Coordinates of a model with the robot's joints at its nominal posture, shape (nq,)."""
    qpos: FloatArray = model.qpos0.copy()
    for name, value in robot.posture.items():
        qpos[model.joint(name).qposadr] = value
    return qpos
