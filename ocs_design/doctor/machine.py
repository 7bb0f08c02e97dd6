"""What the machine has: Python, processors, a folder to write to, OpenGL, a film maker."""

import platform
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from importlib import metadata
from pathlib import Path

from packaging.specifiers import SpecifierSet

from ocs_design.doctor.finding import Finding, State
from ocs_design.doctor.packages import DISTRIBUTION
from ocs_design.export.ffmpeg import FFMPEG_HINT, ffmpeg_program
from ocs_design.export.opengl import OPENGL_HINT, backends, failure_of
from ocs_design.processors import processors as usable

_TRIAL = "ocs_design.export.drawing_trial"


def machine_findings() -> tuple[Finding, ...]:
    """In the order in which they matter."""
    return (python(), working_folder(Path.cwd()), processors(), *opengl(), film_maker())


def python() -> Finding:
    """The interpreter."""
    found = platform.python_version()
    wanted = metadata.metadata(DISTRIBUTION)["Requires-Python"]
    fits = SpecifierSet(wanted).contains(found, prereleases=True)
    return Finding(
        name="Python",
        state=State.WORKS if fits else State.UNFIT,
        required=True,
        found=found,
        wanted=wanted,
        purpose="everything",
        cure="" if fits else "make a virtual environment with a newer Python",
    )


def working_folder(folder: Path) -> Finding:
    """Where output goes unless -o says otherwise."""
    reason = ""
    try:
        with tempfile.TemporaryDirectory(prefix=".ocs-design-", dir=folder):
            free = shutil.disk_usage(folder).free
    except OSError as error:
        reason = error.strerror or str(error)
    return Finding(
        name="this folder",
        state=State.BROKEN if reason else State.WORKS,
        required=True,
        found="" if reason else f"{free / 1e9:.0f} GB free",
        purpose="output without -o",
        cure="go to a folder that you may write to" if reason else "",
        reason=reason,
    )


def processors() -> Finding:
    """That this process may use."""
    return Finding(
        name="processors",
        state=State.WORKS,
        required=False,
        found=str(usable()),
        purpose="flights, several at once",
    )


def opengl() -> Iterator[Finding]:
    """Each way to draw without a screen, tried; one of them is enough."""
    ways = backends()
    with ThreadPoolExecutor() as pool:
        failures = list(pool.map(partial(failure_of, _TRIAL, ()), ways))
    one_works = None in failures
    for way, failure in zip(ways, failures, strict=True):
        yield Finding(
            name=f"OpenGL {way}".rstrip(),
            state=State.WORKS if failure is None else State.MISSING,
            required=False,
            purpose="pictures, one way is enough",
            cure="" if one_works else OPENGL_HINT,
            reason=failure or "",
        )


def film_maker() -> Finding:
    """Ffmpeg."""
    path = ffmpeg_program()
    found = "" if path is None else _ffmpeg_version(path)
    return Finding(
        name="ffmpeg",
        state=State.WORKS if found else State.MISSING,
        required=False,
        found=found,
        purpose="videos",
        cure="" if found else FFMPEG_HINT,
    )


def _ffmpeg_version(path: str) -> str:
    """Empty if it does not run."""
    try:
        said = subprocess.run(
            [path, "-version"], capture_output=True, text=True, check=True, timeout=20.0
        ).stdout
    except (OSError, subprocess.SubprocessError):
        return ""
    # "ffmpeg version 6.1.1-3 Copyright ..."
    return said.split()[2].partition("-")[0] if len(said.split()) > 2 else "unknown"
