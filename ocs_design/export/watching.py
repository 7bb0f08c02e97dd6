"""Replay of recorded flights in MuJoCo's viewer, one window after another.

The windows are opened in a separate process: without a display GLFW ends the process, and with one
it may crash on exit. So this module is also a program:

    python -m ocs_design.export.watching SECONDS_PER_POSE MODEL.mjb QPOS.npy ...
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import MissingToolError
from ocs_design.export.film import Take, written_take

PAUSE = 1.0
"""Pause before a run is repeated [s]."""

DISPLAY_HINT = (
    "run it where there is a screen, or film the flights with `ocs-design size ROBOT --video`; a "
    "virtual screen comes with: apt install xvfb"
)


def watch_takes(takes: Sequence[Take], seconds: float) -> None:
    """Show each take in a window, a pose every so many seconds; closing it opens the next.

    Raises:
        MissingToolError: there is no display, or no window can be opened on it.
    """
    check_display()
    with tempfile.TemporaryDirectory() as folder:
        paths = [written_take(take, Path(folder) / f"{i}") for i, take in enumerate(takes)]
        files = [str(path) for pair in paths for path in pair]
        command = [sys.executable, "-m", "ocs_design.export.watching", str(seconds), *files]
        # The command line disables OpenGL for its own process.
        environment = {**os.environ, "MUJOCO_GL": "glfw"}
        process = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
    if process.returncode != 0:
        lines = process.stderr.strip().splitlines()
        why = lines[-1].removeprefix("ERROR: ") if lines else f"exit code {process.returncode}"
        raise MissingToolError(f"no window of MuJoCo's viewer: {why}", hint=DISPLAY_HINT)


def check_display() -> None:
    """Fail early, before any work, if no window can be opened.

    Raises:
        MissingToolError: there is neither X11 nor Wayland.
    """
    displays = map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY"))
    if sys.platform == "linux" and not any(displays):
        raise MissingToolError("--view needs a display, and there is none", hint=DISPLAY_HINT)


def watch(model: mujoco.MjModel, qpos: FloatArray, seconds: float, parent: int) -> None:
    """Play poses, shape (n, nq), one every so many seconds, repeatedly until the window is closed.

    The window also closes when the parent process ends, so that no window is orphaned.
    """
    # Imported here, because it loads a window system.
    import mujoco.viewer  # noqa: PLC0415

    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    quiet = {"show_left_ui": False, "show_right_ui": False}
    with mujoco.viewer.launch_passive(model, data, **quiet) as viewer:
        viewer.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
        viewer.cam.trackbodyid = 1
        start, duration = time.monotonic(), len(qpos) * seconds + PAUSE
        while viewer.is_running() and os.getppid() == parent:
            pose = int((time.monotonic() - start) % duration / seconds)
            with viewer.lock():
                data.qpos[:] = qpos[min(pose, len(qpos) - 1)]
                data.time = pose * seconds
                mujoco.mj_forward(model, data)
            viewer.sync()
            time.sleep(seconds)


def main(arguments: list[str]) -> None:
    """Open one window for every two paths: model and joint positions."""
    (seconds, *paths), parent = arguments, os.getppid()
    for model, qpos in zip(*(iter(paths),) * 2, strict=True):
        watch(mujoco.MjModel.from_binary_path(model), np.load(qpos), float(seconds), parent)


if __name__ == "__main__":
    main(sys.argv[1:])
    sys.stdout.flush()
    # The viewer's own thread may still hold the display, and nothing is left to clean up.
    os._exit(0)
