"""Answer of `doctor`: the state of the machine and of every package that is used.

The requirements are read from pyproject.toml alone.
"""

import json
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from importlib import metadata
from pathlib import Path
from types import MappingProxyType

from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

from ocs_design.common.errors import DISTRIBUTION, MissingToolError, install_command
from ocs_design.common.files import processors
from ocs_design.device.findings import Examination, Finding, State
from ocs_design.export.programs import (
    FFMPEG_HINT,
    OPENGL_HINT,
    backends,
    failure_of,
    ffmpeg_program,
)

PURPOSES: Mapping[str, str] = MappingProxyType(
    {
        "numpy": "arrays",
        "scipy": "roots and small optimisations",
        "threadpoolctl": "the same design on any number of threads",
        "cvxpy": "wheels by the bound alone: --motor none",
        "clarabel": "wheels by the bound alone: its solver",
        "casadi": "maneuvers by optimal control",
        "typer": "the command line",
        "rich": "tables and progress",
        "msgspec": "design.json in and out",
        "packaging": "this check",
        "trimesh": "robots with meshes other than STL and OBJ",
        "manifold3d": "holes in parts as meshes",
        "reportlab": "drawing and instructions as PDF",
        "mujoco": "robots, flights and pictures",
        "pycollada": "robots with .dae meshes",
        "gymnasium": "the robot as an environment for learning",
        "xacro": "robots in .xacro files",
        "resvg-py": "figures as PNG",
        "dask": "Monte Carlo on many machines",
        "distributed": "Monte Carlo on many machines",
        "mujoco-warp": "Monte Carlo on an NVIDIA GPU",
        "pyarrow": "samples as Parquet",
        "pillow": "PDF, words on videos",
        "imageio-ffmpeg": "videos if the system has no ffmpeg",
        "cadquery-ocp-novtk": "parts in STEP for CAD",
        "ezdxf": "the wheel in DXF for CAD",
    }
)
"""Purpose of each package, by name."""

_MODULES = {"pycollada": "collada", "pillow": "PIL", "cadquery-ocp-novtk": "OCP"}
"""Modules of packages that have another name."""

DEVELOPMENT = frozenset({"test", "dev", "docs"})
"""Extras for developers."""

TIME_LIMIT = 120.0
"""Longest time to import everything [s]."""

# Output printed by the modules themselves must not mix with the answers.
_IMPORT_SCRIPT = """
import importlib, json, os, sys
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
for name in sys.argv[1:]:
    try:
        importlib.import_module(name)
        error = ""
    except BaseException as failure:
        error = f"{type(failure).__name__}: {failure}".splitlines()[0]
    print(json.dumps([name, error]), file=answers, flush=True)
"""


def package_requirements() -> tuple[tuple[Requirement, str], ...]:
    """All packages that users may need, each with the extra that needs it; required ones first.

    The extra of a required package is empty.

    Raises:
        importlib.metadata.PackageNotFoundError: this package itself is not installed.
    """
    requirements = [Requirement(line) for line in metadata.requires(DISTRIBUTION) or ()]
    extras = metadata.metadata(DISTRIBUTION).get_all("Provides-Extra") or ()
    required = [(requirement, "") for requirement in requirements if requirement.marker is None]
    optional = [
        (requirement, extra)
        for extra in extras
        if extra not in DEVELOPMENT
        for requirement in requirements
        if requirement.marker is not None and requirement.marker.evaluate({"extra": extra})
    ]
    return (*sorted(required, key=lambda package: package[0].name), *optional)


def package_findings(packages: Sequence[tuple[Requirement, str]]) -> Iterator[Finding]:
    """Findings about packages with their extras, each imported in a process of its own."""
    names = [canonicalize_name(requirement.name) for requirement, _ in packages]
    modules = {name: _MODULES.get(name) or name.replace("-", "_") for name in names}
    versions = {}
    for name in modules:
        with suppress(metadata.PackageNotFoundError):
            versions[name] = metadata.version(name)
    failures = import_failures([modules[name] for name in versions])
    for name, (requirement, extra) in zip(names, packages, strict=True):
        installed, reason = versions.get(name, ""), failures.get(modules[name], "")
        wanted = str(requirement.specifier)
        state = State.WORKS
        cure = install_command(f"{DISTRIBUTION}[{extra}]" if extra else f"{name}{wanted}")
        if not installed:
            state = State.MISSING
        elif reason:
            state = State.BROKEN
            cure = install_command(f"{name}{wanted}", options="--force-reinstall")
        elif not requirement.specifier.contains(installed, prereleases=True):
            state = State.UNFIT
        yield Finding(
            name=name,
            state=state,
            required=not extra,
            found=installed,
            wanted=wanted,
            purpose=PURPOSES.get(name, f"the extra {extra}"),
            extra=extra,
            cure="" if state is State.WORKS else cure,
            reason=reason,
        )


def import_failures(modules: Sequence[str]) -> Mapping[str, str]:
    """Reason for each module that cannot be imported; others are left out."""
    command = [sys.executable, "-c", _IMPORT_SCRIPT, *modules]
    try:
        process = subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=TIME_LIMIT
        )
        printed, fallback = process.stdout, f"the process ended with code {process.returncode}"
    except subprocess.TimeoutExpired as error:
        printed = (error.stdout or b"").decode() if isinstance(error.stdout, bytes) else ""
        fallback = f"not done within {TIME_LIMIT:g} s"
    answers = dict(json.loads(line) for line in printed.splitlines())
    return {name: answers.get(name, fallback) for name in modules if answers.get(name, fallback)}


def python_finding() -> Finding:
    """Finding about the Python interpreter."""
    installed = platform.python_version()
    required = metadata.metadata(DISTRIBUTION)["Requires-Python"]
    is_supported = SpecifierSet(required).contains(installed, prereleases=True)
    return Finding(
        name="Python",
        state=State.WORKS if is_supported else State.UNFIT,
        required=True,
        found=installed,
        wanted=required,
        purpose="everything",
        cure="" if is_supported else "make a virtual environment with a newer Python",
    )


def folder_finding(folder: Path) -> Finding:
    """Finding about the folder to which output goes without -o."""
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


def _machine_finding(name: str, purpose: str, found: str, cure: str = "") -> Finding:
    """Finding about a part of the machine, which is missing if nothing was found."""
    state = State.WORKS if found else State.MISSING
    return Finding(name=name, state=state, found=found, purpose=purpose, cure="" if found else cure)


def processors_finding() -> Finding:
    """Finding about the processors that this process may use."""
    return _machine_finding("processors", "flights, several at once", str(processors()))


def opengl_findings() -> Iterator[Finding]:
    """Findings about each way to render without a screen; one is enough."""
    tried_backends = backends()
    with ThreadPoolExecutor() as pool:
        failures = list(pool.map(partial(failure_of, ("trial",)), tried_backends))
    one_works = None in failures
    for backend, failure in zip(tried_backends, failures, strict=True):
        yield Finding(
            name=f"OpenGL {backend}".rstrip(),
            state=State.WORKS if failure is None else State.MISSING,
            purpose="pictures, one way is enough",
            cure="" if one_works else OPENGL_HINT,
            reason=failure or "",
        )


def ffmpeg_finding() -> Finding:
    """Finding about ffmpeg, which makes videos."""
    path, installed = ffmpeg_program(), ""
    if path is not None:
        # An ffmpeg that does not run counts as missing.
        with suppress(OSError, subprocess.SubprocessError):
            words = subprocess.run(
                [path, "-version"], capture_output=True, text=True, check=True, timeout=20.0
            ).stdout.split()
            # "ffmpeg version 6.1.1-3 Copyright ..."
            installed = words[2].partition("-")[0] if len(words) > 2 else "unknown"
    return _machine_finding("ffmpeg", "videos", installed, FFMPEG_HINT)


def compiler_finding() -> Finding:
    """Finding about a C compiler, under the names that `make` and Python's own builds try."""
    program = next((name for name in ("cc", "gcc", "clang") if shutil.which(name)), "")
    cure = "install a C compiler, on Debian: apt install gcc"
    return _machine_finding("C compiler", "the exported controller", program, cure)


SCHEMA_VERSION = 1
"""Version of the document; that of `design_file` is unavailable if a package is missing."""


def examine() -> Examination:
    """Examination of this machine and of every package.

    Raises:
        MissingToolError: this program is not installed as a package, which lists its needs.
    """
    try:
        requirements = package_requirements()
    except metadata.PackageNotFoundError as error:
        raise MissingToolError(
            f"{DISTRIBUTION} runs from its source and is not installed: its needs are unknown",
            hint="pip install .",
        ) from error
    folder, packages = folder_finding(Path.cwd()), tuple(package_findings(requirements))
    # In the order in which they matter.
    machine = (
        python_finding(),
        folder,
        processors_finding(),
        *opengl_findings(),
        ffmpeg_finding(),
        compiler_finding(),
    )
    return Examination(metadata.version(DISTRIBUTION), machine, packages)


def examination_to_json(examination: Examination) -> str:
    """Examination as indented JSON."""
    document: Mapping[str, object] = {
        "schema_version": SCHEMA_VERSION,
        "healthy": examination.exit_code == 0,
        **asdict(examination),
    }
    return json.dumps(document, indent=2) + "\n"
