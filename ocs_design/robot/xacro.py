"""Expands xacro files with the optional package `xacro`, in a sandboxed process.

A xacro file contains Python expressions, so it is a program. xacro's own check for names with two
underscores covers only an expression's outermost code, `$(eval ...)` has all built-in functions,
and both can read and write any file. So in that process each expression is parsed and refused if it
accesses an object's internals, time and memory are limited, and Python's audit events block
everything but reading below the robot's folders.
"""

import ast
import errno
import io
import json
import os
import subprocess
import sys
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from ocs_design.common.errors import MissingToolError, RobotError, extra_command
from ocs_design.robot.packages import MeshFinder, is_below, package_roots, roots_of

SECONDS = 5.0
"""Longest processor time of an expansion, half its longest duration [s]; large robots take 1 s."""

# Isolated: the current folder may hold a file named like a module.
_START = (
    "import json, sys; job = json.load(sys.stdin); sys.path[:] = job.pop('path'); "
    "from ocs_design.robot.xacro import expand_job; expand_job(**job)"
)


_MISSING_ARGUMENT = ("Undefined substitution argument", "xacro:arg: missing attribute 'default'")
"""xacro's messages about an `<xacro:arg>` that is only set on its command line."""


def expand_xacro(content: bytes, path: Path, package_paths: Mapping[str, Path]) -> bytes:
    """The URDF that a xacro file expands to.

    Args:
        content: of the file, unzipped.
        path: of the file; included files are relative to it.
        package_paths: folder of each package, for `$(find name)`; others are found as in
            `MeshFinder`.
    """
    # None there hides a module, as in tests; `find_spec` would raise an error.
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
        process = subprocess.run(
            [sys.executable, "-I", "-c", _START],
            input=json.dumps(job).encode(),
            capture_output=True,
            timeout=2.0 * SECONDS,
            check=False,
        )
        answer: Mapping[str, str] = json.loads(process.stdout)
    except (subprocess.TimeoutExpired, ValueError):
        # Killed at one of its limits, before it could answer.
        endless = f"it takes more than {SECONDS:.0f} s or 1 GiB: is there an endless expression?"
        answer = {"error": endless}
    if "error" in answer:
        if any(word in answer["error"] for word in _MISSING_ARGUMENT):
            raise RobotError(
                f"xacro cannot expand the file, an argument has no value: {answer['error']}",
                hint="set it: xacro robot.urdf.xacro NAME:=VALUE > robot.urdf, and give robot.urdf",
            )
        raise RobotError(
            f"xacro cannot expand the file: {answer['error']}",
            hint="expand it where its packages are installed: "
            "xacro robot.urdf.xacro > robot.urdf; "
            "or say where they are with --package-path NAME=DIR",
        )
    return answer["urdf"].encode()


MEMORY = 1 << 30
"""Largest memory of the process [bytes]."""

LARGEST = 64 << 20
"""Largest URDF that it may produce [bytes]."""

_FUNCTIONS = (list, dict, map, str, float, int, bool, len, min, max, abs, round)

_PYTHON = Path(os.__file__).parent
"""Folder of Python's own modules, which are imported on demand."""

# These lead to the code, frames and globals of the running program.
_HIDDEN = ("_", "gi_", "cr_", "ag_", "f_", "tb_", "co_", "func_")
_REFUSED_ATTRIBUTES = {"format", "format_map", "mro"}
_REFUSED_FUNCTIONS = ("vars", "type")

_SECRET = ("TOKEN", "SECRET", "PASSW", "CREDENTIAL", "KEY", "AUTH")

# Importing Python's own modules needs the first of these, includes with wildcards `glob.glob`.
_HARMLESS_EVENTS = {
    "import",
    "marshal.loads",
    "compile",
    "exec",
    "os.listdir",
    "os.scandir",
    "glob.glob",
    "builtins.id",
}


def expand_job(*, content: str, file: str, packages: Mapping[str, str], seconds: float) -> None:
    """Expand a file and print the answer, `urdf` or `error`, as JSON.

    Args:
        content: of the file, as Latin-1. file: its path. packages: folders by name.
        seconds: limit of processor time.
    """
    _limit(seconds)
    answer, path = {}, Path(file)
    try:
        import xacro  # noqa: PLC0415 - optional

        finder = MeshFinder(path.parent, {name: Path(folder) for name, folder in packages.items()})
        roots = [*roots_of(path), *finder.package_paths.values()]
        _restrict(xacro, finder, roots)
        _guard(roots)
        sys.stdout = io.StringIO()
        xacro.init_stacks(str(path))
        document = xacro.parse(io.BytesIO(content.encode("latin-1")), str(path))
        xacro.process_doc(document)
        expanded = str(document.toxml())
        if len(expanded) <= LARGEST:
            answer["urdf"] = expanded
        else:
            answer["error"] = f"it expands to more than {LARGEST >> 20} MiB"
    except Exception as error:  # xacro evaluates expressions: whatever Python can raise
        answer["error"] = " ".join(str(error).split()) or type(error).__name__
    sys.__stdout__.write(json.dumps(answer))  # type: ignore[union-attr]  # a pipe of our own


def _limit(seconds: float) -> None:
    """Limit the time and memory of this process, and keep it from writing files."""
    try:
        import resource  # noqa: PLC0415 - not on Windows
    except ImportError:
        return
    for limit, value in (
        (resource.RLIMIT_CPU, int(seconds)),
        (resource.RLIMIT_AS, MEMORY),
        (resource.RLIMIT_FSIZE, LARGEST * 2),
    ):
        _, hard = resource.getrlimit(limit)
        resource.setrlimit(limit, (value, hard))


def _restrict(xacro: ModuleType, finder: MeshFinder, roots: list[Path]) -> None:
    """Replace xacro's evaluation and search for packages by checked ones."""
    from xacro import substitution_args  # noqa: PLC0415 - optional

    evaluate = xacro.safe_eval

    def safe_eval(expression: str, symbols: Any, inner: Any = None) -> Any:  # noqa: ANN401 - xacro's
        """Value of an expression that xacro would evaluate unchecked."""
        check_expression(expression)
        return evaluate(expression, symbols, inner)

    def evaluate_argument(expression: str, _: object, names: Any) -> Any:  # noqa: ANN401 - xacro's
        """Value of an expression in `$(eval ...)`, with a few harmless functions."""
        check_expression(expression)
        known = {function.__name__: function for function in _FUNCTIONS}
        return eval(expression, {"__builtins__": known}, names)

    def find(name: str) -> str:
        """Folder of a package, in place of ROS 2's package index."""
        folder = finder.package_folder(name)
        if folder is None:
            raise LookupError(f"package {name!r} was not found")
        if is_below(finder.folder, [folder]):
            roots.append(folder)
        roots.extend(package_roots(folder))
        return str(folder)

    def environment(name: str) -> str:
        """Value of an environment variable that holds no secret."""
        check_variable(name)
        return os.environ[name]

    def optional(name: str, default: str = "") -> str:
        """Value of an environment variable that holds no secret, if there is one."""
        check_variable(name)
        return os.environ.get(name, default)

    vars(xacro).update(safe_eval=safe_eval)
    vars(substitution_args).update(eval=evaluate_argument, _eval_find=find, _eval_env=environment)
    substitution_args._eval_dict.update(find=find, env=environment, optenv=optional)
    substitution_args._eval_optenv = optional
    for name in _REFUSED_FUNCTIONS:
        xacro._global_symbols["python"].pop(name, None)


def check_expression(expression: str) -> None:
    """Refuse an expression that accesses Python's internals.

    Raises:
        ValueError: the expression does.
    """
    for node in ast.walk(ast.parse(expression.strip(), mode="eval")):
        name = node.attr if isinstance(node, ast.Attribute) else ""
        if isinstance(node, ast.Name) and node.id.startswith("__"):
            name = node.id
        if name.startswith(_HIDDEN) or name in _REFUSED_ATTRIBUTES:
            raise ValueError(f"the expression {expression!r} is refused for its {name!r}")


def check_variable(name: str) -> None:
    """Refuse environment variables that may hold a secret.

    Raises:
        ValueError: its name says so.
    """
    if any(word in name.upper() for word in _SECRET):
        raise ValueError(f"the environment variable {name} may be secret and is not read")


def _guard(roots: list[Path]) -> None:
    """Block, for the rest of this process, everything but reading files below `roots`."""

    def refuse(event: str, arguments: tuple[Any, ...]) -> None:
        """Refuse an audit event, which Python raises before the action."""
        if event == "open":
            path, mode, flags = arguments
            writes = mode not in {"r", "rb", None} or (flags or 0) & (os.O_WRONLY | os.O_RDWR)
            if not writes and isinstance(path, (str, bytes, os.PathLike)):
                target = Path(os.fsdecode(path))
                if is_below(target, (*roots, _PYTHON)):
                    return
                # xacro's message takes the file name from the error.
                raise PermissionError(
                    errno.EACCES,
                    "outside the robot's folder and packages; add one with --package-path NAME=DIR",
                    str(target),
                )
        if event not in _HARMLESS_EVENTS:
            raise PermissionError(f"xacro files may not do {event!r}")

    sys.addaudithook(refuse)
