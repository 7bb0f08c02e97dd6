"""The shapes of a robot that a device may hit, as a MuJoCo model."""

from dataclasses import replace

import mujoco

from ocs_design.robot.bounds import solid_shapes
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.frames import quaternion
from ocs_design.robot.spec.model import compile_spec, plain_spec, trunk_body
from ocs_design.robot.tree import Body

BASE = "ocs_probe_base"
"""Site at the frame B."""

BALL = "ocs_probe_ball"
DRUMS = ("ocs_probe_left", "ocs_probe_right")
PROBES = (BALL, *DRUMS)
"""Geoms on the trunk that stand in for a device; distances are measured from them."""


def solid_model(robot: Robot, remarks: Remarks) -> mujoco.MjModel:
    """The robot with the probes on its trunk.

    A body collides with its collision shapes, or, where it has none, with what it shows; meshes
    count as their convex hulls. Geoms of an MJCF model are all there: see `parts`.

    Args:
        robot: as read.
        remarks: takes meshes that cannot be read.
    """
    bodies = tuple(_solid(body) for body in robot.tree.bodies)
    solid = replace(robot, tree=replace(robot.tree, bodies=bodies))
    spec = plain_spec(solid, remarks, visuals=False)
    trunk, base = trunk_body(spec, solid)
    trunk.add_site(name=BASE, pos=base.position, quat=quaternion(base.rotation))
    _add_probe(trunk, BALL, mujoco.mjtGeom.mjGEOM_SPHERE)
    for name in DRUMS:
        _add_probe(trunk, name, mujoco.mjtGeom.mjGEOM_CYLINDER)
    return compile_spec(spec, robot, remarks)


def _solid(body: Body) -> Body:
    return replace(
        body, shapes=tuple(replace(shape, collides=True) for shape in solid_shapes(body))
    )


def _add_probe(trunk: mujoco.MjsBody, name: str, kind: mujoco.mjtGeom) -> None:
    trunk.add_geom(name=name, type=kind, size=(1.0, 1.0, 1.0), mass=0.0, contype=0, conaffinity=0)
