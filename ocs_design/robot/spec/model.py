"""The robot as a MuJoCo model: free in space, at rest, nothing around it."""

from dataclasses import dataclass
from pathlib import Path

import mujoco

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.source import STANDARD_INPUT
from ocs_design.robot.mjcf.spec import compiled, parse_mjcf
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot.spec.bodies import body_names, spec_from_tree
from ocs_design.robot.spec.contacts import add_missing_feet, exclude_neighbours
from ocs_design.robot.spec.free_base import free_base
from ocs_design.robot.spec.hulls import reduce_to_hulls
from ocs_design.robot.spec.meshes import drop_refused_meshes
from ocs_design.robot.spec.written_out import write_out_inertials, write_out_orientations
from ocs_design.robot.tree import Placement


@dataclass(frozen=True, eq=False)
class BuiltModel:
    """A robot in MuJoCo.

    Attributes:
        spec: to be completed (floor, actuators, device) and compiled; holds its meshes' bytes.
        warnings: what MuJoCo's copy has otherwise than the robot's file, one sentence each.
    """

    spec: mujoco.MjSpec
    warnings: tuple[str, ...]


def build_spec(robot: Robot, *, visuals: bool = True) -> BuiltModel:
    """The robot with a free base, without floor, at MuJoCo's own defaults of contact.

    Bodies and joints have the names of the file's links (of each moving body's first link) and
    joints. An MJCF robot keeps its own model: actuators, sensors, contacts, keyframes.

    Args:
        robot: as read.
        visuals: whether the model will be looked at; if not, what only shows is left out, and
            meshes are reduced to their convex hulls, all that MuJoCo lets touch.
    """
    remarks = Remarks()
    spec = plain_spec(robot, remarks, visuals=visuals)
    # MuJoCo 4.0.0's sparse Newton solver is wrong.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    model = compile_spec(spec, robot, remarks)
    if not visuals:
        reduce_to_hulls(spec, model)
    add_missing_feet(spec, model, robot)
    exclude_neighbours(spec, compiled(spec), robot)
    return BuiltModel(spec, remarks.sentences())


def plain_spec(robot: Robot, remarks: Remarks, *, visuals: bool) -> mujoco.MjSpec:
    """The robot as its file has it, but for its base, which is free.

    Args:
        robot: as read.
        remarks: takes what had to be changed for MuJoCo.
        visuals: whether to load what is only to look at; an MJCF robot keeps it in any case.
    """
    if robot.format is Format.MJCF:
        return _spec_from_mjcf(robot, remarks)
    return spec_from_tree(robot.tree, remarks, visuals=visuals)


def compile_spec(spec: mujoco.MjSpec, robot: Robot, remarks: Remarks) -> mujoco.MjModel:
    """What a spec of `plain_spec` compiles to; meshes that MuJoCo refuses are taken out of it."""
    try:
        return compiled(spec)
    except RobotError:
        if robot.format is Format.MJCF:
            raise
        drop_refused_meshes(spec, remarks)
        return compiled(spec)


def _spec_from_mjcf(robot: Robot, remarks: Remarks) -> mujoco.MjSpec:
    folder = Path.cwd() if robot.source == STANDARD_INPUT else Path(robot.source).absolute().parent
    # What is odd in the file itself has been told by the reader.
    spec = parse_mjcf(robot.content, folder, Remarks())
    write_out_orientations(spec)
    write_out_inertials(spec)
    free_base(spec, robot.floating_base, remarks)
    return spec


def trunk_body(spec: mujoco.MjSpec, robot: Robot) -> tuple[mujoco.MjsBody, Placement]:
    """The trunk's body in a spec of `build_spec`, and the base frame B in that body's frame."""
    if robot.format is Format.MJCF:
        # The tree joins what is welded; the user's model has it apart still.
        if robot.mount is not None:
            return spec.body(robot.mount.link), robot.mount.placement
        return spec.body(robot.trunk), Placement.identity()
    index = robot.tree.body_of_link[robot.trunk]
    body = robot.tree.bodies[index]
    return spec.body(body_names(robot.tree)[index]), body.links[robot.trunk]
