"""Pictures of a design as PNG: the wheel, a module, and the robot with its device."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.common.errors import MissingToolError
from ocs_design.device.device import Device
from ocs_design.export.assembly.placed import placed_parts
from ocs_design.export.device_parts import wheel_pieces
from ocs_design.export.film import Take, add_white_sky, rendered
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Color, Mesh, part_mesh
from ocs_design.export.robot_model import RobotModel, model_of
from ocs_design.export.visuals import SHELL, piece_color
from ocs_design.robot.robot import Robot

_MODULE_ON_ROBOT = (np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0)
"""Attitude of a module's frame at zero incidence, as a quaternion: its z axis to the left, y down.
"""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `wheel.png`, `module.png` and `robot.png`; return a note if OpenGL does not work."""
    try:
        pictures = draw_pictures(subject.device, subject.carrier, model_of(subject))
    except MissingToolError as error:
        return (f"{error}; {error.hint}" if error.hint else str(error),)
    for name, content in pictures.items():
        (folder / f"{name}.png").write_bytes(content)
    return ()


def draw_pictures(device: Device, robot: Robot, model: RobotModel) -> dict[str, bytes]:
    """PNG by name: `wheel`, `module` if it is more than the wheel, and the posed `robot`."""
    shown = []
    for name, (part, place) in placed_parts(device).items():
        # The housing is transparent.
        color = SHELL if name in {"drum", "lid"} else piece_color(device, name)
        shown.append((part_mesh(part).placed(place), color))
    # The wheel's pieces come first.
    takes = {"wheel": parts_take(shown[: len(wheel_pieces(device.flywheel))])}
    if not device.wheels_alone:
        takes["module"] = parts_take(shown)
    qpos = np.array(model.compiled.qpos0)
    for joint, value in robot.posture.items():
        qpos[model.compiled.joint(joint).qposadr[0]] = value
    takes["robot"] = Take(model.compiled, qpos[None])
    return render_views(takes)


def render_views(takes: Mapping[str, Take]) -> dict[str, bytes]:
    """PNG of each take's first pose, from the front, the side, above and in perspective.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    pages = rendered(takes.values(), "views", Path.read_bytes, "pictures")
    return dict(zip(takes, pages, strict=True))


def parts_take(shown: Sequence[tuple[Mesh, Color]]) -> Take:
    """Take of coloured parts in the module's frame, in the attitude of zero incidence."""
    spec = mujoco.MjSpec()
    add_white_sky(spec)
    body = spec.worldbody.add_body(quat=_MODULE_ON_ROBOT)
    for index, (mesh, color) in enumerate(shown):
        name, faces = f"part{index}", mesh.triangles.ravel().astype(np.int32)
        spec.add_mesh(name=name, uservert=mesh.vertices.ravel(), userface=faces)
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, rgba=color)
    model = spec.compile()
    return Take(model, model.qpos0[None])
