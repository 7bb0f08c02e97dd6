"""External programs for pictures and films: OpenGL without a screen, and ffmpeg.

OpenGL runs in a separate process, which it may end if it does not work. Nothing here needs MuJoCo.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from importlib.util import find_spec

from ocs_design.common.errors import MissingToolError, extra_command

PROGRAM = "ocs_design.export.offscreen"
"""Module that renders in a separate process."""

TIME_LIMIT = 120.0
"""Time limit of a rendering process [s]; a graphics driver may hang."""

OPENGL_HINT = (
    "install OpenGL without a screen, on Debian: apt install libegl1 libgl1-mesa-dri libosmesa6"
)

FFMPEG_HINT = f"{extra_command('video')}, or on Debian: apt install ffmpeg"


def backends() -> tuple[str, ...]:
    """Values of MUJOCO_GL to try: the user's choice, or those that need no screen."""
    chosen = os.environ.get("MUJOCO_GL")
    # The command line disables OpenGL for its own process, which renders nothing.
    if chosen == "disabled":
        chosen = None
    if chosen is not None or not sys.platform.startswith("linux"):
        return (chosen or "",)
    return ("egl", "osmesa")


def failure_of(arguments: Sequence[str], backend: str) -> str | None:
    """Run the rendering program in another process; returns the reason of a failure, or None."""
    environment = dict(os.environ)
    if backend:
        environment["MUJOCO_GL"] = environment["PYOPENGL_PLATFORM"] = backend
    try:
        process = subprocess.run(
            [sys.executable, "-m", PROGRAM, *arguments],
            env=environment,
            capture_output=True,
            check=False,
            timeout=TIME_LIMIT,
            stdin=subprocess.DEVNULL,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"{backend or 'OpenGL'}: {error}"
    if process.returncode == 0:
        return None
    lines = process.stderr.decode(errors="replace").strip().splitlines()
    return f"{backend or 'OpenGL'}: {lines[-1] if lines else f'exit code {process.returncode}'}"


def draw(arguments: Sequence[str], what: str) -> None:
    """Run the rendering program for `what` with the first OpenGL backend that works.

    Raises:
        MissingToolError: OpenGL does not work here; the message says why.
    """
    failures = []
    for backend in backends():
        failure = failure_of(arguments, backend)
        if failure is None:
            return
        failures.append(failure)
    raise MissingToolError(f"no {what}, because {'; '.join(failures)}", hint=OPENGL_HINT)


def ffmpeg_program() -> str | None:
    """Path of the system's ffmpeg, else of imageio-ffmpeg's; None if there is neither."""
    path = shutil.which("ffmpeg")
    if path is not None or find_spec("imageio_ffmpeg") is None:
        return path
    # An optional dependency.
    import imageio_ffmpeg  # noqa: PLC0415

    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError:
        return None
