"""Frames of a robot that moves over a floor, with its device or without.

Poses of MuJoCo models are rendered by `offscreen` in a separate process.
"""

import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.device.bodies import device_bodies
from ocs_design.device.device import Device
from ocs_design.export.programs import draw
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.mjcf_spec import compiled
from ocs_design.robot.mujoco_bodies import HIDDEN_GROUP
from ocs_design.robot.robot import Robot

Frames: TypeAlias = NDArray[np.uint8]

T = TypeVar("T")

CHEQUERS = 4.0
"""Number of pairs of floor tiles within the extent of a robot."""


@dataclass(frozen=True, eq=False)
class Take:
    """A compiled model and the poses to render, as joint positions of shape (n, nq)."""

    model: mujoco.MjModel
    qpos: FloatArray


def add_white_sky(spec: mujoco.MjSpec) -> None:
    """Add a white background, which is visible through transparent parts."""
    kind, flat = mujoco.mjtTexture.mjTEXTURE_SKYBOX, mujoco.mjtBuiltin.mjBUILTIN_FLAT
    white = (1.0, 1.0, 1.0)
    spec.add_texture(name="ocs_sky", type=kind, builtin=flat, rgb1=white, width=16, height=16)


def show_floor(spec: mujoco.MjSpec, extent: float) -> None:
    """Add a chequered plane at z = 0 in sunlight, for a robot of that extent [m]."""
    name, kind = "ocs_floor", mujoco.mjtTexture.mjTEXTURE_2D
    look = {"rgb1": (0.90, 0.91, 0.92), "rgb2": (0.80, 0.81, 0.83), "width": 64, "height": 64}
    chequered = mujoco.mjtBuiltin.mjBUILTIN_CHECKER
    spec.add_texture(name=name, type=kind, builtin=chequered, **look)
    material = spec.add_material(name=name, texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
    material.texrepeat = [CHEQUERS / extent] * 2
    sun = {"type": mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, "dir": (0.3, 0.4, -1.0)}
    spec.worldbody.add_light(**sun, diffuse=(0.5, 0.5, 0.5), castshadow=False)
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    spec.worldbody.add_geom(name=name, type=plane, size=(0.0, 0.0, 1.0), material=name)


def film_model(robot: Robot, device: Device, *, ocs: bool) -> mujoco.MjModel:
    """Model of robot and device on a floor; the device is in `qpos` even if hidden (not `ocs`)."""
    model = robot_model(robot, device)
    add_white_sky(model.spec)
    show_floor(model.spec, model.compiled.stat.extent)
    film = compiled(model.spec)
    film.opt.gravity[:] = 0.0
    if not ocs:
        bodies = [film.body(body.name).id for body in device_bodies(device)]
        film.geom_group[np.isin(film.geom_bodyid, bodies)] = HIDDEN_GROUP
    return film


def render_takes(takes: Sequence[Take]) -> list[Frames]:
    """Frames of each take, shape (n, height, width, 3); the camera follows the trunk.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    return rendered(takes, "frames", np.load, "video")


def rendered(takes: Iterable[Take], kind: str, read: Callable[[Path], T], what: str) -> list[T]:
    """Results of the rendering process, one for each take; raises like `programs.draw`.

    Args:
        kind: `frames` or `views`. read: reads a result from its file. what: its name in messages.
    """
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for i, take in enumerate(takes):
            stem = Path(folder) / f"{i}"
            paths += [*written_take(take, stem), stem.with_suffix(f".{kind}")]
        draw([kind, *map(str, paths)], what)
        return [read(result) for result in paths[2::3]]


def written_take(take: Take, stem: Path) -> tuple[Path, Path]:
    """Write model and joint positions for the rendering process; returns both paths."""
    model, qpos = stem.with_suffix(".mjb"), stem.with_suffix(".npy")
    mujoco.mj_saveModel(take.model, str(model))
    np.save(qpos, take.qpos)
    return model, qpos
