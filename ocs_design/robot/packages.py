"""Folders from which a robot file may load other files, and the mesh files that it names."""

import os
import shlex
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, islice
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

UPWARDS, DOWNWARDS, MOST_FOLDERS = 4, 2, 3000
"""Limits of the search for missing meshes: levels above the robot file, levels below each of those,
and folders in all; it takes 50 ms."""

MOST_PACKAGES = 3
"""Most packages whose folders are searched for."""


def roots_of(file: Path) -> tuple[Path, ...]:
    """A robot file's own folder, and the ROS package, repository and Python package around it.

    A workspace may be installed by symbolic links: the folders of the linked file count, too.
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
        roots += [above for above in folder.parents if (above / "__init__.py").is_file()][-1:]
    return tuple(roots)


def package_roots(folder: Path) -> tuple[Path, ...]:
    """A ROS package's folder, and the one that its files link to; empty if it is no package."""
    manifest = folder / "package.xml"
    return (folder, manifest.resolve().parent) if manifest.is_file() else ()


def is_below(path: Path, roots: Iterable[Path]) -> bool:
    """Whether a file is below one of several folders, following links."""
    target = path.resolve()
    return any(target.is_relative_to(root.resolve()) for root in roots)


_PACKAGED = ("package", "model")
"""Schemes of a mesh's address that starts with a package's name."""


class MeshFinder:
    """Finds the file on disk for a mesh named in a robot file.

    A package is searched for in `package_paths`, then where ROS looks (ROS_PACKAGE_PATH,
    AMENT_PREFIX_PATH and CMAKE_PREFIX_PATH), then beside each folder above the robot file. Meshes
    that are not found are recorded in `missing`, and `cure` says where they may be.
    """

    def __init__(self, folder: Path, package_paths: Mapping[str, Path]) -> None:
        self.folder = folder
        self.package_paths = package_paths
        self.missing: dict[str, None] = {}

    def __call__(self, name: str) -> Path | None:
        """The file, or None if it is not there."""
        address = _forward(name)
        scheme, separator, rest = address.partition("://")
        candidates: list[Path] = []
        if not separator:
            candidates = [self.folder / address]
        elif scheme == "file":
            candidates = [self.folder / unquote(rest)]
        elif scheme in _PACKAGED:
            package, _, inside = unquote(rest).partition("/")
            folders = self._package_folders(package)
            candidates = [folder / PurePosixPath(inside) for folder in folders]
        for candidate in candidates:
            try:
                if candidate.is_file():
                    return candidate
            except (OSError, ValueError):  # Names may be too long, or hold what no path can.
                continue
        self.missing[name] = None
        return None

    def package_folder(self, package: str) -> Path | None:
        """The package's folder, or None if it is not found."""
        return next(filter(Path.is_dir, self._package_folders(package)), None)

    def cure(self) -> str:
        """How to make the missing meshes found, naming nearby folders that contain them.

        A nearby file may belong to another package, so it is suggested, not used.
        """
        first: dict[str, str] = {}
        for name in self.missing:
            scheme, _, rest = _forward(name).rpartition("://")
            package, _, inside = rest.partition("/") if scheme in _PACKAGED else ("", "", rest)
            first.setdefault(package, unquote(inside))
        cures = []
        for package, inside in islice(first.items(), MOST_PACKAGES):
            nearby = self._nearby_folder(inside)
            if package:
                folder = "DIR" if nearby is None else shlex.quote(str(nearby))
                cures.append(f"give --package-path {package}={folder}")
            elif nearby is None:
                cures.append(f"put them where the file names them, below {self.folder}")
            else:
                cures.append(f"put the robot's file into {nearby}, where they are")
        return "; ".join(cures)

    def _nearby_folder(self, inside: str) -> Path | None:
        """The nearest folder that contains this file, among a bounded number."""
        levels = islice((self.folder, *self.folder.parents), UPWARDS + 1)
        near = (_folders_below(above, DOWNWARDS) for above in levels if above.name)
        site = Path(sysconfig.get_path("purelib"), "cmeel.prefix", "share")
        ros = (*_environment_paths("ROS_PACKAGE_PATH"), *_share_folders(), site)
        installed = (_folders_below(folder, 1) for folder in ros)
        for folders in (near, installed):
            for folder in islice(chain.from_iterable(folders), MOST_FOLDERS):
                try:
                    if (folder / PurePosixPath(inside)).is_file():
                        return folder
                except (OSError, ValueError):
                    continue
        return None

    def _package_folders(self, package: str) -> Iterator[Path]:
        """Folders that may be the package, best first."""
        if package in self.package_paths:
            yield self.package_paths[package]
        for entry in _environment_paths("ROS_PACKAGE_PATH"):
            yield entry / package
            if entry.name == package:
                yield entry
        for share in _share_folders():
            yield share / package
        for above in (self.folder, *self.folder.parents):
            yield above / package
            if above.name == package:
                yield above


def _forward(name: str) -> str:
    """A mesh's name with forward slashes."""
    return name.strip().replace("\\", "/")


def _environment_paths(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]


def _share_folders() -> list[Path]:
    """Folders of the packages installed by ROS or in a CMake prefix."""
    variables = ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH")
    return [entry / "share" for variable in variables for entry in _environment_paths(variable)]


def _folders_below(folder: Path, levels: int) -> Iterator[Path]:
    """A folder and its subfolders down to some level, without hidden ones."""
    yield folder
    if levels == 0:
        return
    try:
        inner = sorted(Path(entry) for entry in os.scandir(folder) if entry.is_dir())
    except OSError:
        return
    for subfolder in inner:
        if not subfolder.name.startswith("."):
            yield from _folders_below(subfolder, levels - 1)
