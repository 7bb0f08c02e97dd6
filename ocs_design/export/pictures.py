"""What a design looks like: the wheel, a module, and the robot with both."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from ocs_design.design import Device
from ocs_design.drive_solids import drive_solids, motor_mount
from ocs_design.export.backdrop import add_white_sky
from ocs_design.export.rendering import Scene, render_views
from ocs_design.export.robot_model import RobotModel
from ocs_design.export.standing import GEAR, MOTOR, PRINT, SHELL, Color, cage_placement
from ocs_design.export.workshop import printed_foot, printed_parts
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import Foot
from ocs_design.parts.mesh import Mesh, part_mesh, solid_mesh
from ocs_design.parts.solids import hollow_cylinder
from ocs_design.parts.wheel import Wheel
from ocs_design.parts.wheel_parts import wheel_parts
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Placement

STEEL: Color = (0.55, 0.57, 0.6, 1.0)
ALUMINIUM: Color = (0.78, 0.79, 0.8, 1.0)

_MODULE_ON_ROBOT = (np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0)
"""Attitude of a module's frame at no incidence, as a quaternion: its z axis to the left, y down."""


@dataclass(frozen=True, eq=False)
class Shown:
    """A mesh in its color, in the module's frame."""

    mesh: Mesh
    color: Color


def draw_pictures(
    device: Device, wheel: Wheel, robot: Robot, model: RobotModel
) -> dict[str, bytes]:
    """PNG by name: `wheel`, `module` where there is more than the wheel, and `robot`.

    Args:
        device: to draw. wheel: each of its two, as it is made.
        robot: that carries it, for its posture. model: of both.

    Raises:
        MissingToolError: OpenGL does not work here.
    """
    turning, carrier = _wheel(wheel), _carrier(device)
    scenes = {"wheel": shown_scene(turning)}
    if carrier:
        scenes["module"] = shown_scene([*turning, *carrier])
    scenes["robot"] = robot_scene(robot, model)
    return render_views(scenes)


def shown_scene(shown: Sequence[Shown]) -> Scene:
    """Parts alone, as they stand on the robot at no incidence."""
    spec = mujoco.MjSpec()
    add_white_sky(spec)
    body = spec.worldbody.add_body(quat=_MODULE_ON_ROBOT)
    for index, part in enumerate(shown):
        name = f"part{index}"
        spec.add_mesh(
            name=name,
            uservert=part.mesh.vertices.ravel(),
            userface=part.mesh.triangles.ravel().astype(np.int32),
        )
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, rgba=part.color)
    model = spec.compile()
    return Scene(model, model.qpos0)


def robot_scene(robot: Robot, model: RobotModel) -> Scene:
    """In the nominal posture."""
    qpos = np.array(model.compiled.qpos0)
    for joint, value in robot.posture.items():
        qpos[model.compiled.joint(joint).qposadr[0]] = value
    return Scene(model.compiled, qpos)


def _wheel(wheel: Wheel) -> list[Shown]:
    """The rim, and in a color of its own what carries it."""
    return [
        Shown(part_mesh(part), color)
        for part, color in zip(wheel_parts(wheel), (STEEL, ALUMINIUM), strict=False)
    ]


def _carrier(device: Device) -> list[Shown]:
    """Motor and gear, where their sizes are known, and what is printed around them."""
    if device.carrier.mass == 0.0:
        return []
    foot, (drum, lid, base, *_) = printed_foot(device), printed_parts(device)
    return [
        *_drive(device),
        Shown(_placed(part_mesh(base), foot.placement), PRINT),
        *_cage(device, foot),
        *(Shown(part_mesh(part), SHELL) for part in (drum, lid)),
    ]


def _drive(device: Device) -> Iterator[Shown]:
    colors = {"motor": MOTOR, "gear": GEAR}
    for solid in drive_solids(device):
        if solid.name in colors:
            mesh = solid_mesh(hollow_cylinder(0.0, solid.radius, solid.low, solid.high))
            above = Placement(np.eye(3), np.array([0.0, -solid.up, 0.0]))
            yield Shown(_placed(mesh, above), colors[solid.name])


def _cage(device: Device, foot: Foot) -> Iterator[Shown]:
    cage = motor_mount(device).cage
    if cage is not None:
        yield Shown(_placed(part_mesh(cage_part(cage)), cage_placement(foot, cage)), PRINT)


def _placed(mesh: Mesh, place: Placement) -> Mesh:
    return Mesh(mesh.vertices @ place.rotation.T + place.position, mesh.triangles)
