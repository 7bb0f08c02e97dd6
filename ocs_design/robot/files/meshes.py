"""Finds the mesh files that a robot file names."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

_PACKAGE_SCHEMES = ("package", "model")


class MeshFinder:
    """From the name in the file to the file on disk.

    A package is looked for in `package_paths`, then where ROS looks (ROS_PACKAGE_PATH and
    AMENT_PREFIX_PATH), then beside each folder above the robot file. What is not found is noted
    in `missing`: sizing needs no meshes.
    """

    def __init__(self, folder: Path, package_paths: Mapping[str, Path]) -> None:
        self.folder = folder
        self.package_paths = package_paths
        self.missing: dict[str, None] = {}

    def __call__(self, name: str) -> Path | None:
        """The file, or None if it is not there."""
        for candidate in self._candidates(name.strip()):
            if _is_file(candidate):
                return candidate
        self.missing[name] = None
        return None

    def package_folder(self, package: str) -> Path | None:
        """The package's folder, or None if it is nowhere."""
        return next(filter(Path.is_dir, self._package_folders(package)), None)

    def _package_folders(self, package: str) -> Iterator[Path]:
        """Folders that may be the package, best first."""
        if package in self.package_paths:
            yield self.package_paths[package]
        for entry in _environment_paths("ROS_PACKAGE_PATH"):
            yield entry / package
            if entry.name == package:
                yield entry
        for entry in _environment_paths("AMENT_PREFIX_PATH"):
            yield entry / "share" / package
        for above in (self.folder, *self.folder.parents):
            yield above / package
            if above.name == package:
                yield above

    def _candidates(self, name: str) -> Iterator[Path]:
        scheme, separator, rest = name.partition("://")
        if not separator:
            yield self.folder / name
        elif scheme == "file":
            yield self.folder / unquote(rest)
        elif scheme in _PACKAGE_SCHEMES:
            package, _, inside = unquote(rest).partition("/")
            for folder in self._package_folders(package):
                yield folder / PurePosixPath(inside)


def _environment_paths(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
