"""Extents of meshes, and from them those of a robot's shapes and bodies."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.common.errors import RobotError
from ocs_design.robot.tree import Body, Shape, ShapeKind, Tree

if TYPE_CHECKING:
    import trimesh

MESHES = (".stl", ".obj", ".dae", ".ply", ".off", ".glb", ".gltf")
"""Suffixes that are read. Archives are not: they grow without bound when unpacked."""

LARGEST_MESH, LARGEST_BINARY_STL = 28 << 20, 128 << 20
"""Largest files [bytes]: reading a .dae takes 25 times its size in memory, a binary STL 3 times."""

LARGEST_MESH_LENGTH = 1e30
"""Largest coordinate in the mesh's own unit; a mesh with a larger one, or no number, is broken."""

_STL_HEADER, _STL_FACET = 84, 50
"""Sizes of a binary STL's header and of each of its facets [bytes]."""

_QUICK_STL, _QUICK_OBJ = 8 << 20, 1 << 16
"""Largest binary STL and OBJ that can be read in about ten milliseconds [bytes]."""


def mesh_bounds(path: Path, scale: tuple[float, ...], *, quick: bool = False) -> FloatArray | None:
    """Lower and upper corner of a mesh [m] in its own frame, shape (2, 3); None if unreadable.

    Args:
        path: of its file. scale: factors along its axes.
        quick: whether to skip meshes that take longer than milliseconds; they give None.
    """
    bounds = unscaled_bounds(path, quick=True)
    if bounds is None and not quick:
        bounds = unscaled_bounds(path, quick=False)
    if bounds is None:
        return None
    corners = bounds * np.asarray(scale)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


@cache
def unscaled_bounds(path: Path, *, quick: bool) -> FloatArray | None:
    """Corners in the mesh's own unit, shape (2, 3); None if it is broken (`mesh_bounds`)."""
    try:
        check_mesh_file(path)
        bounds: FloatArray | None = None
        length = path.stat().st_size
        if binary_stl_facets(path) and (length <= _QUICK_STL or not quick):
            # Along rows this takes a thirtieth of the time.
            coordinates = np.ascontiguousarray(binary_stl_corners(path).reshape(-1, 3).T)
            bounds = np.array([coordinates.min(axis=1), coordinates.max(axis=1)])
        elif path.suffix.lower() == ".obj" and (length <= _QUICK_OBJ or not quick):
            bounds = _obj_bounds(path)
        elif not quick:
            bounds = load_with_trimesh(path).bounds
    except Exception:  # A mesh reader fails in as many ways as there are broken meshes.
        return None
    if bounds is None or np.shape(bounds) != (2, 3):
        return None
    return frozen(bounds) if (np.abs(bounds) < LARGEST_MESH_LENGTH).all() else None


def check_mesh_file(path: Path) -> None:
    """Refuse a mesh that would take too much memory or time.

    Raises:
        RobotError: it is too large, or of a kind that cannot be read.
    """
    if path.suffix.lower() not in MESHES:
        raise RobotError(
            f"{path.name} is not a mesh that can be read",
            hint=f"convert it to one of {', '.join(MESHES)}",
        )
    largest = LARGEST_BINARY_STL if binary_stl_facets(path) else LARGEST_MESH
    if path.stat().st_size > largest:
        raise RobotError(
            f"{path.name} is larger than {largest >> 20} MiB",
            hint="reduce its number of facets, or export it as binary STL",
        )


def binary_stl_facets(path: Path) -> int:
    """Number of facets of a binary STL; 0 for every other file.

    It is binary if its length matches its number of facets.
    """
    if path.suffix.lower() != ".stl":
        return 0
    with path.open("rb") as stream:
        header = stream.read(_STL_HEADER)
    facets = int.from_bytes(header[80:], "little")
    return facets if path.stat().st_size == _STL_HEADER + _STL_FACET * facets else 0


def binary_stl_corners(path: Path) -> NDArray[np.float32]:
    """Corners of each facet of a binary STL in its own unit, shape (n, 3, 3).

    They are read without trimesh, whose import takes longer than reading a whole robot.
    """
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    content, count = path.read_bytes(), binary_stl_facets(path)
    return np.asarray(np.frombuffer(content, facet, count, offset=_STL_HEADER)["corners"])


def _obj_bounds(path: Path) -> FloatArray:
    """Corners of the box around the vertices that faces use: files contain others, too."""
    vertices: list[list[str]] = []
    used: set[int] = set()
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        keyword, *words = line.split() or [""]
        if keyword == "v":
            vertices.append(words[:3])
        elif keyword == "f":
            corners = [int(word.partition("/")[0]) for word in words]
            # Indices count from one, or backwards from the last vertex so far.
            used.update(i - 1 if i > 0 else len(vertices) + i for i in corners)
    points = np.array([vertices[index] for index in used], dtype=np.float64)
    return np.array([points.min(axis=0), points.max(axis=0)])


def load_with_trimesh(path: Path) -> "trimesh.Trimesh":
    """A mesh of any kind without its colours, in metres if the file specifies its unit."""
    import trimesh  # noqa: PLC0415 - takes 1.7 s, and only few meshes need it

    scene = trimesh.load_scene(path)
    for part in scene.geometry.values():
        # Textures of several parts would be packed into one, which takes most of the time.
        part.visual = trimesh.visual.ColorVisuals()
    mesh: trimesh.Trimesh = scene.to_mesh()
    if mesh.units is not None:
        mesh.convert_units("meters")
    return mesh


Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Rotation of a mesh from y up to z up."""

_Y_UP_BODIES = 3
"""Least number of bodies with such meshes: one or two may be round and tell nothing."""

_NEARER_RATIO = 2.0 / 3.0
"""Largest ratio of distances from the centres of mass for which turned meshes fit better."""

_ASSET_LENGTH = 1 << 16
"""Length of the start of a .dae that contains its asset [bytes]."""


def with_y_up(tree: Tree) -> Tree:
    """The tree with its COLLADA meshes turned to z up, if they are meant to be.

    Files may declare y as up. RViz and Gazebo do not turn them, three.js and programs that use
    Assimp do, and there are robots for either: meshes are turned if their middles are then much
    nearer to their bodies' centres of mass, and a warning says so.
    """
    meshes = [
        (body, shape, off, turned)
        for body in tree.bodies
        for shape in body.shapes
        if shape.mesh is not None and _declares_y_up(shape.mesh)
        for x, y, z in (shape.size,)
        for turned in (replace(shape, size=(x, z, y), rotation=frozen(shape.rotation @ Y_UP)),)
        if (off := _off_centre(shape, body)) is not None
    ]
    if len({body.name for body, *_ in meshes}) < _Y_UP_BODIES:
        return tree
    before = sum(off for _, _, off, _ in meshes) / len(meshes)
    after = sum(_off_centre(turned, body) or 0.0 for body, _, _, turned in meshes) / len(meshes)
    if after > _NEARER_RATIO * before:
        return tree
    millimetres = (f"{1e3 * off:.0f} mm" for off in (after, before))
    sentence = (
        f"{len(meshes)} .dae meshes declare y as up and are turned accordingly: on average they "
        f"are then {' and not '.join(millimetres)} off their links' centres of mass; RViz does not "
        "turn them"
    )
    other = {id(shape): turned for _, shape, _, turned in meshes}
    bodies = (
        replace(body, shapes=tuple(other.get(id(shape), shape) for shape in body.shapes))
        for body in tree.bodies
    )
    return replace(tree, bodies=tuple(bodies), warnings=(*tree.warnings, sentence))


@cache
def _declares_y_up(path: Path) -> bool:
    if path.suffix.lower() != ".dae":
        return False
    with path.open("rb") as stream:
        return b"<up_axis>Y_UP" in stream.read(_ASSET_LENGTH)


def _off_centre(shape: Shape, body: Body) -> float | None:
    """Distance of the middle of a mesh's box from its body's centre of mass [m]."""
    bounds = None if shape.mesh is None else mesh_bounds(shape.mesh, shape.size)
    if bounds is None:
        return None
    middle = shape.position + shape.rotation @ bounds.mean(axis=0)
    return float(np.linalg.norm(middle - body.mass_properties.com))


_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])


def extent(shape: Shape, direction: FloatArray) -> float | None:
    """Support function of a shape: its farthest point along a unit vector of its body's frame [m].

    Exact for primitives. A mesh counts as its bounding box in its own frame; None if its file is
    missing or cannot be read.
    """
    local = shape.rotation.T @ direction
    if shape.kind is ShapeKind.MESH:
        bounds = None if shape.mesh is None else mesh_bounds(shape.mesh, shape.size)
        if bounds is None:
            return None
        reach = float((np.where(_CORNERS, bounds[1], bounds[0]) @ local).max())
    else:
        reach = _primitive_extent(shape, local)
    return float(direction @ shape.position + reach)


def half_extents(shape: Shape) -> FloatArray:
    """Half the sides of the box around a primitive along the axes of its own frame [m], (3,)."""
    return np.array([_primitive_extent(shape, axis) for axis in np.eye(3)])


def _primitive_extent(shape: Shape, direction: FloatArray) -> float:
    """Farthest point of a primitive along a unit vector of its own frame [m]."""
    size = shape.size
    match shape.kind:
        case ShapeKind.BOX:
            return float(np.abs(direction) @ np.array(size))
        case ShapeKind.SPHERE:
            return size[0]
        case ShapeKind.CYLINDER:
            return float(size[0] * np.hypot(*direction[:2]) + size[1] * abs(direction[2]))
        case ShapeKind.CAPSULE:
            return float(size[0] + size[1] * abs(direction[2]))
    raise ValueError(f"a {shape.kind} is not a primitive")


def extent_of(shapes: Iterable[Shape], direction: FloatArray) -> float | None:
    """Farthest point of several shapes along `direction` [m]; None if none can be measured."""
    reaches = [reach for shape in shapes if (reach := extent(shape, direction)) is not None]
    return max(reaches, default=None)


def solid_shapes(body: Body) -> tuple[Shape, ...]:
    """Collision shapes of a body that can be measured, else its visual ones."""
    up = np.array([0.0, 0.0, 1.0])
    for collides in (True, False):
        # Visual meshes are large: they are opened only if there is nothing else.
        shapes = [shape for shape in body.shapes if shape.collides is collides]
        known = tuple(shape for shape in shapes if extent(shape, up) is not None)
        if known:
            return known
    return ()


def unmeasured(body: Body) -> bool:
    """Whether the mesh of a shape that counts for the body's extent cannot be read."""
    known = solid_shapes(body)
    if not known:
        return bool(body.shapes)
    return len(known) < sum(shape.collides is known[0].collides for shape in body.shapes)


def lacks_mesh(body: Body) -> bool:
    """Whether the file of any of its meshes, collision or visual, was not found."""
    return any(shape.kind is ShapeKind.MESH and shape.mesh is None for shape in body.shapes)


def reach_of_body(body: Body, direction: FloatArray) -> float:
    """Farthest point of a body along `direction` of its frame [m].

    Without a shape that can be measured: the farthest of its link origins and its centre of mass.
    """
    reach = extent_of(solid_shapes(body), direction)
    points = (*(place.position for place in body.links.values()), body.mass_properties.com)
    return max(float(direction @ point) for point in points) if reach is None else reach


def trunk_top(tree: Tree, trunk: str) -> float:
    """Highest z in B of the trunk body's shapes, where the device stands [m].

    Without shapes: the height of the trunk body's centre of mass.
    """
    return trunk_extent(tree, trunk, np.array([0.0, 0.0, 1.0]))


def trunk_extent(tree: Tree, trunk: str, direction: FloatArray) -> float:
    """Farthest point of the trunk body's shapes along a unit vector of B [m].

    Without shapes: its centre of mass.
    """
    body = tree.bodies[tree.body_of_link[trunk]]
    base = body.links[trunk]
    along = base.rotation @ direction
    reach = extent_of(solid_shapes(body), along)
    farthest = float(along @ body.mass_properties.com) if reach is None else reach
    return farthest - float(along @ base.position)


def longest_side(tree: Tree, posture: Mapping[str, float], trunk: str) -> float:
    """Longest side of the box along B's axes that holds the robot at `posture` [m]."""
    placements = tree.placements_from(trunk, posture)

    def farthest(direction: FloatArray) -> float:
        """Farthest point of all bodies [m]."""
        return max(
            float(direction @ place.position) + reach_of_body(body, place.rotation.T @ direction)
            for body, place in zip(tree.bodies, placements, strict=True)
        )

    return max(farthest(axis) + farthest(-axis) for axis in np.eye(3))
