"""OpenGL without a screen: which ways there are, and a process of its own to try each in.

Where OpenGL does not work, it may end the process. Nothing here needs MuJoCo.
"""

import os
import subprocess
import sys
from collections.abc import Sequence

TIME_LIMIT = 120.0
"""For all that one process draws [s]; a graphics driver may hang."""

OPENGL_HINT = (
    "install OpenGL without a screen, on Debian: apt install libegl1 libgl1-mesa-dri libosmesa6"
)


def backends() -> tuple[str, ...]:
    """Values of MUJOCO_GL to try: what the user chose, or what needs no screen."""
    chosen = os.environ.get("MUJOCO_GL")
    # The command line disables it for its own process, which draws nothing.
    if chosen == "disabled":
        chosen = None
    if chosen is not None or not sys.platform.startswith("linux"):
        return (chosen or "",)
    return ("egl", "osmesa")


def failure_of(module: str, arguments: Sequence[str], backend: str) -> str | None:
    """Run a module that draws in another process; what went wrong, or None."""
    environment = dict(os.environ)
    if backend:
        environment["MUJOCO_GL"] = environment["PYOPENGL_PLATFORM"] = backend
    try:
        done = subprocess.run(
            [sys.executable, "-m", module, *arguments],
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
