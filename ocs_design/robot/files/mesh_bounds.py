"""How large meshes are, read in milliseconds where that can be."""

from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

import numpy as np

from ocs_design.arrays import FloatArray, frozen
from ocs_design.exceptions import RobotError

BoundsReader = Callable[[Path], FloatArray | None]
"""Lower and upper corner of a mesh, shape (2, 3); None if it is of a kind for another reader."""

MESHES = (".stl", ".obj", ".dae", ".ply", ".off", ".glb", ".gltf")
"""Kinds that are read. Those in archives are not: they grow without bound when unpacked."""

LARGEST_MESH, LARGEST_BINARY_STL = 28 << 20, 128 << 20
"""[bytes]; a .dae takes 25 times its size of memory while it is read, a binary STL three times."""

LARGEST_MESH_LENGTH = 1e30
"""In the mesh's own unit; whatever is larger, or no number, is broken."""

_STL_HEADER, _STL_FACET = 84, 50
"""[bytes]."""

_QUICK_STL, _QUICK_OBJ = 8 << 20, 1 << 16
"""Largest binary STL and OBJ that are read in some ten milliseconds [bytes]."""


def mesh_bounds(path: Path, scale: tuple[float, ...]) -> FloatArray | None:
    """Lower and upper corner of a mesh [m] in its own frame, shape (2, 3); None if unreadable."""
    return _scaled(_raw_bounds(path), scale)


def quick_mesh_bounds(path: Path, scale: tuple[float, ...]) -> FloatArray | None:
    """As `mesh_bounds`, of what is read in milliseconds; None for every other mesh."""
    return _scaled(_quick_bounds(path), scale)


def check_mesh_file(path: Path) -> None:
    """Refuse a mesh that would take more memory or time than any robot is worth.

    Raises:
        RobotError: it is too large, or of a kind that is not read.
    """
    if path.suffix.lower() not in MESHES:
        raise RobotError(
            f"{path.name} is no mesh that can be read",
            hint=f"convert it to one of {', '.join(MESHES)}",
        )
    largest = LARGEST_BINARY_STL if _is_binary_stl(path) else LARGEST_MESH
    if path.stat().st_size > largest:
        raise RobotError(
            f"{path.name} is larger than {largest >> 20} MiB",
            hint="reduce its number of facets, or export it as binary STL",
        )


def _is_binary_stl(path: Path) -> bool:
    """Whether the length is what the number of facets says."""
    if path.suffix.lower() != ".stl":
        return False
    with path.open("rb") as stream:
        header = stream.read(_STL_HEADER)
    facets = int.from_bytes(header[80:], "little")
    return facets > 0 and path.stat().st_size == _STL_HEADER + _STL_FACET * facets


def _scaled(bounds: FloatArray | None, scale: tuple[float, ...]) -> FloatArray | None:
    if bounds is None:
        return None
    corners = bounds * np.asarray(scale)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


@cache
def _raw_bounds(path: Path) -> FloatArray | None:
    quick = _quick_bounds(path)
    readers = (_binary_stl_bounds, _obj_bounds, _trimesh_bounds)
    return _read_bounds(path, readers) if quick is None else quick


@cache
def _quick_bounds(path: Path) -> FloatArray | None:
    return _read_bounds(path, (_small_stl_bounds, _small_obj_bounds))


def _read_bounds(path: Path, readers: Iterable[BoundsReader]) -> FloatArray | None:
    """What the first reader that can tell says."""
    try:
        check_mesh_file(path)
        told = (read(path) for read in readers)
        bounds = next((each for each in told if each is not None), None)
    except Exception:  # A mesh reader fails in as many ways as there are broken meshes.
        return None
    if bounds is None or bounds.shape != (2, 3):
        return None
    return frozen(bounds) if (np.abs(bounds) < LARGEST_MESH_LENGTH).all() else None


def _binary_stl_bounds(path: Path) -> FloatArray | None:
    """Without trimesh, whose import takes longer than reading a whole robot; None if ASCII."""
    if not _is_binary_stl(path):
        return None
    raw = path.read_bytes()
    count = (len(raw) - _STL_HEADER) // _STL_FACET
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(raw, facet, count, offset=_STL_HEADER)["corners"].reshape(-1, 3)
    # Along rows it takes a thirtieth of the time.
    coordinates = np.ascontiguousarray(corners.T)
    return np.array([coordinates.min(axis=1), coordinates.max(axis=1)], dtype=np.float64)


def _small_stl_bounds(path: Path) -> FloatArray | None:
    return _binary_stl_bounds(path) if path.stat().st_size <= _QUICK_STL else None


def _small_obj_bounds(path: Path) -> FloatArray | None:
    return _obj_bounds(path) if path.stat().st_size <= _QUICK_OBJ else None


def _obj_bounds(path: Path) -> FloatArray | None:
    """Of the vertices that a face names: files hold others too."""
    if path.suffix.lower() != ".obj":
        return None
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
