"""Frames of a robot that moves over a floor, with its device or without."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.design import Device
from ocs_design.export.backdrop import add_floor, add_white_sky
from ocs_design.export.naming import carrier_names, flywheel_names
from ocs_design.export.rendering import draw
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.mjcf.spec import compiled
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.bodies import HIDDEN_GROUP

Frames = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Take:
    """What is filmed.

    Attributes:
        model: see `film_model`.
        qpos: joint positions of each frame, shape (n, nq).
    """

    model: mujoco.MjModel
    qpos: FloatArray


def film_model(robot: Robot, device: Device, *, ocs: bool) -> mujoco.MjModel:
    """Robot and device on a floor.

    Args:
        robot: that carries the device.
        device: as it is flown.
        ocs: whether to show the device; its joints are in `qpos` in any case.
    """
    model = robot_model(robot, device)
    add_white_sky(model.spec)
    add_floor(model.spec, model.compiled.stat.extent)
    found = compiled(model.spec)
    found.opt.gravity[:] = 0.0
    if not ocs:
        bodies = [found.body(name).id for name in flywheel_names(device) + carrier_names(device)]
        found.geom_group[np.isin(found.geom_bodyid, bodies)] = HIDDEN_GROUP
    return found


def render_takes(takes: Sequence[Take]) -> list[Frames]:
    """Frames of each take, shape (n, height, width, 3); the camera goes along with the trunk.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    with tempfile.TemporaryDirectory() as folder:
        paths = [
            (*written_take(take, Path(folder) / f"{i}"), Path(folder) / f"{i}.frames.npy")
            for i, take in enumerate(takes)
        ]
        program = "ocs_design.export.film_frames"
        draw(program, [str(path) for three in paths for path in three], "video")
        return [np.load(frames) for _, _, frames in paths]


def written_take(take: Take, stem: Path) -> tuple[Path, Path]:
    """Model and joint positions for the other process."""
    model, qpos = stem.with_suffix(".mjb"), stem.with_suffix(".npy")
    mujoco.mj_saveModel(take.model, str(model))
    np.save(qpos, take.qpos)
    return model, qpos
