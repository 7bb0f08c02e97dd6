"""Runs to be looked at in MuJoCo's viewer, where a display exists."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ocs_design.exceptions import MissingToolError
from ocs_design.export.film import Take, written_take

DISPLAY_HINT = (
    "run it where there is a screen, or film the flights by `ocs-design size ROBOT --video`; a "
    "virtual screen comes with: apt install xvfb"
)


def watch_takes(takes: Sequence[Take], seconds: float) -> None:
    """A window for each take, one after the other as they are closed.

    Args:
        takes: to be shown.
        seconds: from one pose to the next [s].

    Raises:
        MissingToolError: there is no display, or no window can be opened on it.
    """
    check_display()
    with tempfile.TemporaryDirectory() as folder:
        paths = [written_take(take, Path(folder) / f"{i}") for i, take in enumerate(takes)]
        files = [str(path) for pair in paths for path in pair]
        command = [sys.executable, "-m", "ocs_design.export.watch_frames", str(seconds), *files]
        # The command line disables OpenGL for its own process.
        environment = {**os.environ, "MUJOCO_GL": "glfw"}
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
    if done.returncode != 0:
        said = done.stderr.strip().splitlines()
        why = said[-1].removeprefix("ERROR: ") if said else f"exit code {done.returncode}"
        raise MissingToolError(f"no window of MuJoCo's viewer: {why}", hint=DISPLAY_HINT)


def check_display() -> None:
    """Refuse early what would be refused after all the work.

    Raises:
        MissingToolError: X11 and Wayland are not there.
    """
    displays = map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY"))
    if sys.platform == "linux" and not any(displays):
        raise MissingToolError("--view needs a display, and there is none", hint=DISPLAY_HINT)
