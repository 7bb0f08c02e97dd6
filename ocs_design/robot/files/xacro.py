"""Expands xacro files through the optional package `xacro`."""

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from ocs_design.exceptions import MissingToolError, RobotError

FindPackage = Callable[[str], Path | None]


def expand_xacro(content: bytes, path: Path, find_package: FindPackage) -> bytes:
    """The URDF that a xacro file stands for.

    Args:
        content: of the file, unzipped.
        path: of the file; files that it includes are looked for beside it.
        find_package: from the name in `$(find name)` to the package's folder.
    """
    xacro = _import_xacro()
    try:
        with _package_index(find_package):
            xacro.init_stacks(str(path))
            document = xacro.parse(io.BytesIO(content), str(path))
            xacro.process_doc(document)
    except Exception as error:  # xacro evaluates expressions: whatever Python can raise
        reason = " ".join(str(error).split()) or type(error).__name__
        raise RobotError(
            f"xacro cannot expand the file: {reason}",
            hint="expand it where its packages are installed: xacro robot.urdf.xacro > robot.urdf; "
            "or say where they are with --package-path NAME=DIR",
        ) from error
    expanded: bytes = document.toxml(encoding="utf-8")
    return expanded


def _import_xacro() -> ModuleType:
    try:
        import xacro  # noqa: PLC0415 - optional
    except ImportError as error:
        raise MissingToolError(
            "the file is a xacro that has not been expanded, and xacro is not installed",
            hint="pip install 'ocs-design[xacro]', or: xacro robot.urdf.xacro > robot.urdf",
        ) from error
    module: ModuleType = xacro
    return module


@contextmanager
def _package_index(find_package: FindPackage) -> Iterator[None]:
    """Lets `$(find name)` work without ROS: stands in for ROS 2's package index meanwhile."""
    names = ("ament_index_python", "ament_index_python.packages")
    before = {name: sys.modules.get(name) for name in names}
    index = ModuleType(names[1])
    vars(index)["get_package_share_directory"] = _folder_of(find_package)
    sys.modules.update({names[0]: ModuleType(names[0]), names[1]: index})
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def _folder_of(find_package: FindPackage) -> Callable[[str], str]:
    def get_package_share_directory(name: str) -> str:
        """In place of ament's function of this name."""
        folder = find_package(name)
        if folder is None:
            raise LookupError(f"package {name!r} was not found")
        return str(folder)

    return get_package_share_directory
