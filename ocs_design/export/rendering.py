"""Pictures of MuJoCo models, drawn in a process of their own."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import MissingToolError

TIME_LIMIT = 120.0
"""For all pictures together [s]; a graphics driver may hang."""

HINT = "install OpenGL without a screen, on Debian: apt install libegl1 libgl1-mesa-dri libosmesa6"


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
        failures = []
        for backend in _backends():
            failure = _draw([str(path) for three in paths for path in three], backend)
            if failure is None:
                return {
                    name: three[2].read_bytes() for name, three in zip(scenes, paths, strict=True)
                }
            failures.append(failure)
    raise MissingToolError(f"no pictures, because {'; '.join(failures)}", hint=HINT)


def _written(scene: Scene, stem: Path) -> tuple[Path, Path, Path]:
    """Model and joint positions for the other process, and where the picture will be."""
    model, qpos, sheet = (stem.with_suffix(suffix) for suffix in (".mjb", ".npy", ".png"))
    mujoco.mj_saveModel(scene.model, str(model))
    np.save(qpos, scene.qpos)
    return model, qpos, sheet


def _backends() -> tuple[str, ...]:
    """Values of MUJOCO_GL to try: what the user chose, or what needs no screen."""
    chosen = os.environ.get("MUJOCO_GL")
    if chosen is not None or not sys.platform.startswith("linux"):
        return (chosen or "",)
    return ("egl", "osmesa")


def _draw(paths: list[str], backend: str) -> str | None:
    """Draw in another process; what went wrong, or None."""
    environment = dict(os.environ)
    if backend:
        environment["MUJOCO_GL"] = environment["PYOPENGL_PLATFORM"] = backend
    command = [sys.executable, "-m", "ocs_design.export.camera_views", *paths]
    try:
        done = subprocess.run(
            command,
            env=environment,
            capture_output=True,
            check=False,
            timeout=TIME_LIMIT,
            stdin=subprocess.DEVNULL,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"{backend or 'OpenGL'}: {error}"
    if done.returncode == 0:
        return None
    said = done.stderr.decode(errors="replace").strip().splitlines()
    return f"{backend or 'OpenGL'}: {said[-1] if said else f'exit code {done.returncode}'}"
