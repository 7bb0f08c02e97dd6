"""Folders that a robot file may take other files from, and the mesh files that it names."""

import os
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path, PurePosixPath
from urllib.parse import unquote


def roots_of(file: Path) -> tuple[Path, ...]:
    """A robot file's own folder and the nearest ROS package or repository around it.

    A workspace may be installed by links: the folders of the file that a link leads to count too.
    """
    roots = []
    for folder in dict.fromkeys((file.absolute().parent, file.resolve().parent)):
        roots.append(folder)
        marked = (
            above
            for above in (folder, *folder.parents)
            if (above / "package.xml").is_file() or (above / ".git").exists()
        )
        roots.extend(islice(marked, 1))
    return tuple(roots)


def package_roots(folder: Path) -> tuple[Path, ...]:
    """A ROS package's folder and the one that its files are links to; none if it is no package."""
    manifest = folder / "package.xml"
    return (folder, manifest.resolve().parent) if manifest.is_file() else ()


def is_below(path: Path, roots: Iterable[Path]) -> bool:
    """Whether a file lies below one of several folders, links followed."""
    target = path.resolve()
    return any(target.is_relative_to(root.resolve()) for root in roots)


class MeshFinder:
    """Finds the file on disk that a mesh's name in a robot file stands for.

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
            try:
                if candidate.is_file():
                    return candidate
            except (OSError, ValueError):  # Names may be too long, or hold what no path can.
                continue
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
        elif scheme in {"package", "model"}:
            package, _, inside = unquote(rest).partition("/")
            for folder in self._package_folders(package):
                yield folder / PurePosixPath(inside)


def _environment_paths(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]
