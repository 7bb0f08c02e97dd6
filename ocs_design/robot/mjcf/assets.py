"""Files that an MJCF model refers to: read into the model, or what needs them left out."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeAlias

import mujoco

from ocs_design.bounded_files import read_plain_file
from ocs_design.exceptions import RobotError
from ocs_design.robot.mjcf.inertials import require_inertial
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.spec.unused_name import unused_name

Asset: TypeAlias = "mujoco.MjsMesh | mujoco.MjsTexture | mujoco.MjsHField | mujoco.MjsSkin"

LARGEST_ASSET = 128 << 20
"""[bytes]."""


def embed_assets(spec: mujoco.MjSpec, folder: Path, remarks: Remarks) -> None:
    """Read every file that the model refers to, so that it compiles anywhere.

    Files then have names without folders in the model.

    Args:
        spec: parsed, not compiled yet.
        folder: of the model's file.
        remarks: takes the names of files that are not there.
    """
    names: dict[Path, str] = {}
    for assets, subfolder, drop in _kinds(spec):
        for asset in list(assets):
            missing = _embed(spec, asset, folder / subfolder, names)
            if missing is not None:
                remarks.add("files not found, what needs them is left out", missing)
                drop(spec, asset)
    spec.meshdir = spec.texturedir = ""
    spec.strippath = False


def _kinds(
    spec: mujoco.MjSpec,
) -> Iterator[tuple[list[Asset], str, Callable[[mujoco.MjSpec, Asset], None]]]:
    """Assets of each kind, the folder that they lie in, and what to do without one."""
    yield spec.meshes, spec.meshdir, _drop_mesh
    yield spec.skins, spec.meshdir, _drop
    yield spec.hfields, spec.meshdir, _drop_height_field
    yield spec.textures, spec.texturedir, _drop_texture


def _embed(spec: mujoco.MjSpec, asset: Asset, folder: Path, names: dict[Path, str]) -> str | None:
    """Read an asset's files into the model; the first that is not there, or None."""
    sides = list(getattr(asset, "cubefiles", ()))
    for file in filter(None, (asset.file, *sides)):
        path = folder / (Path(file).name if spec.strippath else file)
        if not path.is_file():
            return str(file)
        if path not in names:
            names[path] = unused_name(path.stem, path.suffix, spec.assets)
            spec.assets[names[path]] = _content(path)
        asset.file = names[path] if asset.file == file else asset.file
        sides = [names[path] if side == file else side for side in sides]
    if any(sides):
        asset.cubefiles = sides
    return None


def _content(path: Path) -> bytes:
    try:
        return read_plain_file(path, LARGEST_ASSET)
    except OSError as error:
        raise RobotError(
            f"the file {path} cannot be read: {error.strerror}",
            hint="reduce its size, or take it out of the model",
        ) from error


def _drop(spec: mujoco.MjSpec, asset: Asset) -> None:
    spec.delete(asset)


def _drop_mesh(spec: mujoco.MjSpec, mesh: mujoco.MjsMesh) -> None:
    for geom in [geom for geom in spec.geoms if geom.meshname == mesh.name]:
        require_inertial(spec, geom, mesh.file)
        delete_geom(spec, geom)
    spec.delete(mesh)


def _drop_height_field(spec: mujoco.MjSpec, field: mujoco.MjsHField) -> None:
    for geom in [geom for geom in spec.geoms if geom.hfieldname == field.name]:
        delete_geom(spec, geom)
    spec.delete(field)


def _drop_texture(spec: mujoco.MjSpec, texture: mujoco.MjsTexture) -> None:
    for material in spec.materials:
        material.textures = ["" if used == texture.name else used for used in material.textures]
    spec.delete(texture)


def delete_geom(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> None:
    """Delete a geom with the contact pairs and sensors that name it, which could not compile."""
    if geom.name:
        for pair in [p for p in spec.pairs if geom.name in {p.geomname1, p.geomname2}]:
            spec.delete(pair)
        for sensor in [s for s in spec.sensors if _measures(s, geom.name)]:
            spec.delete(sensor)
    spec.delete(geom)


def _measures(sensor: mujoco.MjsSensor, geom: str) -> bool:
    kind = mujoco.mjtObj.mjOBJ_GEOM
    return (kind, geom) in {(sensor.objtype, sensor.objname), (sensor.reftype, sensor.refname)}
