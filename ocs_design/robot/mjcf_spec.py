"""A user's MJCF model as an MjSpec that needs no other file: includes expanded, assets inside."""

import math
import re
import warnings as python_warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree as ET

import mujoco

from ocs_design.common.errors import RobotError
from ocs_design.common.files import read_plain_file
from ocs_design.robot.links import Warnings, unused_name
from ocs_design.robot.packages import is_below, roots_of
from ocs_design.robot.source import MAX_BYTES
from ocs_design.robot.xml import parse_xml


@contextmanager
def mujoco_warnings_to(warnings: Warnings) -> Iterator[None]:
    """Add MuJoCo's warnings while parsing and compiling to `warnings`.

    By default MuJoCo prints some of them and writes MUJOCO_LOG.TXT into the current folder; its
    bindings turn the others into Python warnings.
    """

    def add(text: str) -> None:
        """Add a warning as one line."""
        warnings.add(f"MuJoCo: {' '.join(text.split())}")

    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(add)
    try:
        with python_warnings.catch_warnings(record=True) as caught:
            python_warnings.simplefilter("always")
            yield
    finally:
        mujoco.set_mju_user_warning(before)
    for warning in caught:
        add(str(warning.message))


def require_inertial(spec: mujoco.MjSpec, geom: mujoco.MjsGeom, file: str) -> None:
    """Refuse a model in which a body's inertia would come from the missing mesh `file`."""
    body, compiler = geom.parent, spec.compiler
    # Visual geoms declare that they have no mass.
    massless = geom.mass == 0.0 or (math.isnan(geom.mass) and geom.density == 0.0)
    first, last = compiler.inertiagrouprange
    if body == spec.worldbody or massless or not first <= geom.group <= last:
        return
    always_from_geoms = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    if body.explicitinertial and compiler.inertiafromgeom != always_from_geoms:
        return
    depth = 0
    while not body.name:
        body, depth = body.parent, depth + 1
    nameless = "a body without a name below " * depth
    raise RobotError(
        f"{nameless}body {body.name!r} takes its inertia from the mesh {file}, which was not found",
        hint="put the mesh where the model expects it, or give the body an <inertial>",
    )


Asset: TypeAlias = "mujoco.MjsMesh | mujoco.MjsTexture | mujoco.MjsHField | mujoco.MjsSkin"

LARGEST_ASSET = 128 << 20
"""Largest file that a model may refer to [bytes]."""


MissingGeoms: TypeAlias = list[tuple[mujoco.MjsBody, bool]]
"""Bodies that lose a geom because its mesh is missing, and whether that geom collides."""


def embed_assets(spec: mujoco.MjSpec, folder: Path, warnings: Warnings) -> MissingGeoms:
    """Read every file that the model refers to, so that it compiles anywhere.

    The files' names in the model then have no folders.

    Args:
        spec: parsed, not compiled yet.
        folder: of the model's file.
        warnings: receives the names of missing files.

    Returns:
        Geoms left out because of them.
    """
    missing_geoms: MissingGeoms = []
    mesh_assets: list[Asset] = [*spec.meshes, *spec.skins, *spec.hfields]
    assets = [(asset, asset.compiler.meshdir) for asset in mesh_assets]
    assets += [(texture, texture.compiler.texturedir) for texture in spec.textures]
    # Assets of an attached model follow that model's rules.
    compilers = [spec.compiler, *(asset.compiler for asset, _ in assets)]
    names: dict[Path, str] = {}
    for asset, subfolder in assets:
        missing = _embed(spec, asset, folder / subfolder, names)
        if missing is None:
            continue
        warnings.add("files not found; elements that need them are left out", missing)
        if isinstance(asset, mujoco.MjsTexture):
            for material in spec.materials:
                material.textures = [
                    "" if used == asset.name else used for used in material.textures
                ]
        elif isinstance(asset, mujoco.MjsMesh):
            for geom in [geom for geom in spec.geoms if geom.meshname == asset.name]:
                require_inertial(spec, geom, asset.file)
                missing_geoms.append((geom.parent, bool(geom.contype or geom.conaffinity)))
                delete_geom(spec, geom)
        elif isinstance(asset, mujoco.MjsHField):
            for geom in [geom for geom in spec.geoms if geom.hfieldname == asset.name]:
                delete_geom(spec, geom)
        spec.delete(asset)
    for compiler in compilers:
        compiler.meshdir = compiler.texturedir = ""
    spec.strippath = False
    return missing_geoms


def _embed(spec: mujoco.MjSpec, asset: Asset, folder: Path, names: dict[Path, str]) -> str | None:
    """Read an asset's files into the model; returns the first missing one, or None."""
    sides = list(getattr(asset, "cubefiles", ()))
    for file in filter(None, (asset.file, *sides)):
        path = folder / (Path(file).name if spec.strippath else file)
        if not path.is_file():
            return str(file)
        if path not in names:
            try:
                content = read_plain_file(path, LARGEST_ASSET)
            except OSError as error:
                raise RobotError(
                    f"the file {path} cannot be read: {error.strerror}",
                    hint="reduce its size, or remove it from the model",
                ) from error
            names[path] = unused_name(path.stem, path.suffix, spec.assets)
            spec.assets[names[path]] = content
        asset.file = names[path] if asset.file == file else asset.file
        sides = [names[path] if side == file else side for side in sides]
    if any(sides):
        asset.cubefiles = sides
    return None


def delete_geom(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> None:
    """Delete a geom with the contact pairs and sensors that name it, which could not compile."""
    if geom.name:
        for pair in [p for p in spec.pairs if geom.name in {p.geomname1, p.geomname2}]:
            spec.delete(pair)
        measured = (mujoco.mjtObj.mjOBJ_GEOM, geom.name)
        for sensor in list(spec.sensors):
            if measured in {(sensor.objtype, sensor.objname), (sensor.reftype, sensor.refname)}:
                spec.delete(sensor)
    spec.delete(geom)


def parse_mjcf(
    content: bytes, folder: Path, warnings: Warnings
) -> tuple[mujoco.MjSpec, MissingGeoms]:
    """The model of an MJCF file; its bodies, joints and actuators all have names.

    Args:
        content: the file, unzipped, in any encoding that XML supports.
        folder: to which its includes and assets are relative.
        warnings: receives the names of missing files; elements that need them are left out.

    Returns:
        The model, and the geoms left out.
    """
    root = parse_xml(content, warnings)
    _expand_includes(root, folder, seen=set())
    models: dict[str, bytes] = {}
    _read_models(root, folder, models)
    try:
        with mujoco_warnings_to(warnings):
            spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"), include=models)
    except ValueError as error:
        raise mujoco_refusal(error) from error
    # Fused bodies lose their names, and the trunk may be one of them.
    spec.compiler.fusestatic = False
    lost = embed_assets(spec, folder, warnings)
    _name(spec.bodies, "body")
    _name(spec.joints, "joint")
    _name(spec.actuators, "actuator")
    return spec, lost


def _name(elements: Sequence["mujoco.MjsBody | mujoco.MjsJoint"], kind: str) -> None:
    """Name elements without a name, so that a tree and a model from the same file agree."""
    names = {element.name for element in elements}
    for number, element in enumerate(elements):
        if not element.name:
            element.name = unused_name(f"{kind}{number}", "", names)


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """The compiled model; a refusal by MuJoCo is an error in the robot's file."""
    try:
        # The reader has already compiled the user's model and passed on the warnings.
        with mujoco_warnings_to(Warnings()):
            return spec.compile()
    except ValueError as error:
        raise mujoco_refusal(error) from error


def mujoco_refusal(error: ValueError) -> RobotError:
    """Error that quotes MuJoCo on why it does not compile a model."""
    # Its line numbers refer to the model with includes expanded, not to the user's file.
    reason = re.sub(r",? line \d+", "", " ".join(str(error).split()))
    return RobotError(
        f"MuJoCo refuses the model: {reason}",
        hint="open it in MuJoCo's viewer (python -m mujoco.viewer --mjcf FILE) and correct it",
    )


def _expand_includes(
    parent: ET.Element, folder: Path, seen: set[Path], parent_folder: Path | None = None
) -> None:
    """Replace each `<include>` by the contents of its file.

    Args:
        parent: of the model, or of a file that it includes.
        folder: of the model's file. beside: of that included file.
        seen: files that were included; more are added.
    """
    for child in list(parent):
        if child.tag != "include":
            _expand_includes(child, folder, seen, parent_folder)
            continue
        path = folder / child.get("file", "")
        if parent_folder is not None and not path.exists():
            # As MuJoCo does.
            path = parent_folder / child.get("file", "")
        included = _read_part(path, folder, "included file")
        if path.resolve() in seen:
            raise RobotError(
                f"{path} is included twice", hint="MJCF allows each file to be included once"
            )
        seen.add(path.resolve())
        _expand_includes(included, folder, seen, path.parent)
        place = list(parent).index(child)
        parent[place : place + 1] = list(included)


def _read_models(root: ET.Element, folder: Path, models: dict[str, bytes]) -> None:
    """Read the models that a model attaches, and name them as in `models`.

    Their own files are named with folders, as they are not relative to the whole model's.
    """
    for asset in root.findall("asset/model"):
        path = folder / asset.get("file", "")
        attached = _read_part(path, folder, "attached model")
        name = unused_name(path.stem, path.suffix, models)
        models[name] = b""
        if len(models) > _MOST_ATTACHED:
            raise RobotError(
                f"more than {_MOST_ATTACHED} models are attached: does {path.name} contain itself?",
                hint="no <model> may name a file that it is part of",
            )
        _expand_includes(attached, path.parent, seen=set())
        _read_models(attached, path.parent, models)
        for rules in attached.findall("compiler"):
            for kind in {"assetdir", "meshdir", "texturedir"} & set(rules.attrib):
                rules.set(kind, str(path.parent / rules.get(kind, "")))
        attached.insert(0, ET.Element("compiler", assetdir=str(path.parent)))
        models[name] = ET.tostring(attached)
        asset.set("file", name)


_MOST_ATTACHED = 100
"""Largest number of models that a model may attach."""


def _read_part(path: Path, folder: Path, what: str) -> ET.Element:
    """The root element of a file that a model in `folder` names."""
    if not is_below(path, roots_of(folder / "model.xml")):
        raise RobotError(
            f"the {what} {path} is outside the model's folder and repository",
            hint="move it into the model's folder",
        )
    try:
        return parse_xml(read_plain_file(path, MAX_BYTES))
    except OSError as error:
        raise RobotError(
            f"the {what} {path} cannot be read: {error.strerror}",
            hint="keep the model's files together; a model from standard input "
            "finds its includes in the current folder",
        ) from error
    except RobotError as error:
        raise RobotError(f"the {what} {path}: {error.message}", hint=error.hint) from error
