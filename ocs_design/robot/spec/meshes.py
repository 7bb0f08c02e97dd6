"""Mesh files as MuJoCo takes them: binary STL or OBJ, as bytes."""

from collections.abc import Set
from pathlib import Path

import mujoco

from ocs_design.robot.files.mesh_bounds import check_mesh_file
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.spec.unused_name import unused_name
from ocs_design.robot.tree import Shape

_STL_HEADER = 84
_STL_FACET = 50
_STL_MOST_FACETS = 200_000


class MeshLibrary:
    """The meshes of a model: each file and scale once, whatever cannot be read left out.

    Attributes:
        unreadable: files that could not be read, in the order met.
    """

    def __init__(self, spec: mujoco.MjSpec, left_out: Set[Path] = frozenset()) -> None:
        """Fill `spec`; files in `left_out` are not looked at."""
        self.unreadable: dict[Path, str] = {}
        self._left_out = left_out
        self._spec = spec
        self._assets: dict[Path, str] = {}
        self._meshes: dict[tuple[Path, tuple[float, ...]], str] = {}

    def name_of(self, shape: Shape) -> str | None:
        """Name in the model of a shape's mesh; None if there is none that MuJoCo could take."""
        if shape.mesh is None or shape.mesh in self._left_out or shape.mesh in self.unreadable:
            return None
        key = (shape.mesh, shape.size)
        if key not in self._meshes:
            asset = self._asset(shape.mesh)
            if asset is None:
                return None
            self._meshes[key] = self._add(asset, shape.size)
        return self._meshes[key]

    def _asset(self, path: Path) -> str | None:
        if path not in self._assets:
            try:
                suffix, content = read_mesh(path)
            except Exception as error:  # Mesh readers fail in as many ways as meshes are broken.
                self.unreadable[path] = str(error) or type(error).__name__
                return None
            name = unused_name(path.stem, suffix, self._spec.assets)
            self._spec.assets[name] = content
            self._assets[path] = name
        return self._assets[path]

    def _add(self, asset: str, scale: tuple[float, ...]) -> str:
        name = unused_name(Path(asset).stem, "", self._meshes.values())
        # Bodies carry explicit inertials, and a shell asks for no closed surface.
        self._spec.add_mesh(
            name=name, file=asset, scale=scale, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        )
        return name


def read_mesh(path: Path) -> tuple[str, bytes]:
    """Suffix and bytes of a mesh that MuJoCo reads; other formats become STL or OBJ in metres."""
    check_mesh_file(path)
    suffix = path.suffix.lower()
    content = path.read_bytes()
    if suffix == ".obj" or (suffix == ".stl" and _is_binary_stl(content)):
        return suffix, content
    return _converted(path)


def _is_binary_stl(content: bytes) -> bool:
    """Whether the length is what the number of facets says: only then is it no text."""
    facets = int.from_bytes(content[_STL_HEADER - 4 : _STL_HEADER], "little")
    return len(content) == _STL_HEADER + _STL_FACET * facets and facets <= _STL_MOST_FACETS


def _converted(path: Path) -> tuple[str, bytes]:
    import trimesh  # noqa: PLC0415 - half a second, and most robots' meshes need no conversion

    mesh = trimesh.load_mesh(path)
    if mesh.units is not None:
        mesh.convert_units("meters")
    if len(mesh.faces) > _STL_MOST_FACETS:
        return ".obj", str(mesh.export(file_type="obj", include_normals=False)).encode()
    content = mesh.export(file_type="stl")
    assert isinstance(content, bytes)
    return ".stl", content


def drop_refused_meshes(spec: mujoco.MjSpec, remarks: Remarks) -> None:
    """Take out each mesh that MuJoCo cannot compile, with its geoms."""
    for mesh in list(spec.meshes):
        trial = mujoco.MjSpec()
        trial.assets[mesh.file] = spec.assets[mesh.file]
        trial.add_mesh(name=mesh.name, file=mesh.file, scale=mesh.scale, inertia=mesh.inertia)
        trial.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name)
        try:
            trial.compile()
        except ValueError:
            remarks.add("meshes that MuJoCo refuses, left out", mesh.file)
            for geom in [geom for geom in spec.geoms if geom.meshname == mesh.name]:
                spec.delete(geom)
            spec.delete(mesh)
