"""Finds the mesh files that a robot file names, and how large they are."""

import os
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

import numpy as np

from ocs_design.arrays import FloatArray, frozen

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


def mesh_bounds(path: Path, scale: tuple[float, ...]) -> FloatArray | None:
    """Lower and upper corner of a mesh [m] in its own frame, shape (2, 3); None if unreadable."""
    vertices = _raw_bounds(path)
    if vertices is None:
        return None
    corners = vertices * np.asarray(scale)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


@cache
def _raw_bounds(path: Path) -> FloatArray | None:
    try:
        if path.suffix.lower() == ".stl":
            bounds = _binary_stl_bounds(path)
        elif path.suffix.lower() == ".obj":
            bounds = _obj_bounds(path)
        else:
            bounds = None
        if bounds is None:
            bounds = _trimesh_bounds(path)
    except Exception:  # A mesh reader fails in as many ways as there are broken meshes.
        return None
    return frozen(bounds) if bounds is not None and np.isfinite(bounds).all() else None


def _binary_stl_bounds(path: Path) -> FloatArray | None:
    """Without trimesh, whose import takes longer than reading a whole robot; None if ASCII."""
    raw = path.read_bytes()
    count = int.from_bytes(raw[80:84], "little")
    if count == 0 or len(raw) != 84 + 50 * count:
        return None
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(raw, facet, count, offset=84)["corners"].reshape(-1, 3)
    return np.array([corners.min(axis=0), corners.max(axis=0)], dtype=np.float64)


def _obj_bounds(path: Path) -> FloatArray:
    """Of the vertices that a face names: files hold others too."""
    vertices: list[list[str]] = []
    used: set[int] = set()
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        keyword, *words = line.split() or [""]
        if keyword == "v":
            vertices.append(words[:3])
        elif keyword == "f":
            corners = [int(word.partition("/")[0]) for word in words]
            # Counted from one, or backwards from the last vertex so far.
            used.update(i - 1 if i > 0 else len(vertices) + i for i in corners)
    points = np.array([vertices[index] for index in used], dtype=np.float64)
    return np.array([points.min(axis=0), points.max(axis=0)])


def _trimesh_bounds(path: Path) -> FloatArray | None:
    import trimesh  # noqa: PLC0415 - takes 1.7 s, and only few meshes need it

    mesh = trimesh.load_mesh(path)
    if mesh.units is not None:
        mesh.convert_units("meters")
    return None if mesh.bounds is None else np.array(mesh.bounds, dtype=np.float64)


def _environment_paths(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False
