"""Expands xacro files through the optional package `xacro`, in a process that may do little.

A xacro file holds Python expressions, so it is a program. `xacro_child` says what it may do.
"""

import json
import subprocess
import sys
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from ocs_design.common.errors import MissingToolError, RobotError, extra_command

SECONDS = 5.0
"""Longest processor time of an expansion, half of its longest duration; large robots take one."""

# Isolated: the current folder may hold a file named like a module.
_START = (
    "import json, sys; job = json.load(sys.stdin); sys.path[:] = job.pop('path'); "
    "from ocs_design.robot.xacro_child import expand_job; expand_job(**job)"
)


_MISSING_ARGUMENT = ("Undefined substitution argument", "xacro:arg: missing attribute 'default'")
"""What xacro says of an `<xacro:arg>` that is only set on its command line."""


def expand_xacro(content: bytes, path: Path, package_paths: Mapping[str, Path]) -> bytes:
    """The URDF that a xacro file stands for.

    Args:
        content: of the file, unzipped.
        path: of the file; files that it includes are looked for beside it.
        package_paths: folder of each package that `$(find name)` names; more are looked for as
            `MeshFinder` does.
    """
    # What is None there is hidden, as in tests; `find_spec` would raise an error.
    hidden = "xacro" in sys.modules and sys.modules["xacro"] is None
    if hidden or find_spec("xacro") is None:
        raise MissingToolError(
            "the file is a xacro that has not been expanded, and xacro is not installed",
            hint=f"{extra_command('xacro')}, or: xacro robot.urdf.xacro > robot.urdf",
        )
    job = {
        "path": sys.path,
        "content": content.decode("latin-1"),
        "file": str(path),
        "packages": {name: str(folder) for name, folder in package_paths.items()},
        "seconds": SECONDS,
    }
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-c", _START],
            input=json.dumps(job).encode(),
            capture_output=True,
            timeout=2.0 * SECONDS,
            check=False,
        )
        answer: Mapping[str, str] = json.loads(done.stdout)
    except (subprocess.TimeoutExpired, ValueError):
        # Killed at one of its limits, it had no time to answer.
        endless = f"it takes more than {SECONDS:.0f} s or 1 GiB: is there an endless expression?"
        answer = {"error": endless}
    if "error" in answer:
        if any(word in answer["error"] for word in _MISSING_ARGUMENT):
            raise RobotError(
                f"xacro cannot expand the file, an argument has no value: {answer['error']}",
                hint="state it: xacro robot.urdf.xacro NAME:=VALUE > robot.urdf, "
                "and give robot.urdf",
            )
        raise RobotError(
            f"xacro cannot expand the file: {answer['error']}",
            hint="expand it where its packages are installed: "
            "xacro robot.urdf.xacro > robot.urdf; "
            "or say where they are with --package-path NAME=DIR",
        )
    return answer["urdf"].encode()
