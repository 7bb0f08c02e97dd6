"""Pictures of MuJoCo models, drawn in a process of their own."""

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import MissingToolError
from ocs_design.export.opengl import OPENGL_HINT, backends, failure_of

_DRAWING = "ocs_design.export.camera_views"


@dataclass(frozen=True, eq=False)
class Scene:
    """What is drawn.

    Attributes:
        model: compiled.
        qpos: its joint positions.
    """

    model: mujoco.MjModel
    qpos: FloatArray


def render_views(scenes: Mapping[str, Scene]) -> dict[str, bytes]:
    """Each scene from the front, the side, above and in perspective, as PNG.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    with tempfile.TemporaryDirectory() as folder:
        paths = [_written(scene, Path(folder) / f"{i}") for i, scene in enumerate(scenes.values())]
        draw(_DRAWING, [str(path) for three in paths for path in three], "pictures")
        return {name: three[2].read_bytes() for name, three in zip(scenes, paths, strict=True)}


def draw(program: str, arguments: Sequence[str], what: str) -> None:
    """Run a program that draws, in a process of its own, by the first way to OpenGL that works.

    Args:
        program: module to run.
        arguments: of it.
        what: it draws, for the message.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    failures = []
    for backend in backends():
        failure = failure_of(program, arguments, backend)
        if failure is None:
            return
        failures.append(failure)
    raise MissingToolError(f"no {what}, because {'; '.join(failures)}", hint=OPENGL_HINT)


def _written(scene: Scene, stem: Path) -> tuple[Path, Path, Path]:
    """Model and joint positions for the other process, and where the picture will be."""
    model, qpos, sheet = (stem.with_suffix(suffix) for suffix in (".mjb", ".npy", ".png"))
    mujoco.mj_saveModel(scene.model, str(model))
    np.save(qpos, scene.qpos)
    return model, qpos, sheet
