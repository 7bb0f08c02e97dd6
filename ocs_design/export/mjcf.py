"""Whole robot with its device as a MJCF model, in full double precision.

MuJoCo by itself prints six digits.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from xml.etree import ElementTree as ET

import mujoco
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.robot_model import RobotModel
from ocs_design.export.templates import numbers
from ocs_design.export.visuals import WHEEL_MESH

_MESHES = PurePath(WHEEL_MESH).parent

_PRINTED = 1e-5
"""Relative error of six printed digits."""

_NAMES = {"polycoef": "data"}
"""Names of XML's attributes in MuJoCo's objects, where they differ."""

_SINGLE_PRECISION = {"rgba"}
"""Attributes that MuJoCo itself keeps with fewer digits than a double has."""

_INERTIAL_NAMES = {"pos": "ipos", "quat": "iquat", "diaginertia": "inertia"}


def write(subject: Subject, folder: Path) -> Notes:
    """Write `<name>_ocs.xml` with its meshes and textures."""
    export_robot_mjcf(subject.model, folder / f"{subject.name}_ocs.xml")
    return subject.model.warnings


def export_robot_mjcf(model: RobotModel, path: Path) -> Path:
    """Write the robot with the flywheels on its trunk, its meshes and textures beside it.

    The model refers to nothing outside its folder, which can be moved. It has no floor.

    Args:
        model: to write.
        path: of the MJCF.
    """
    text = precise_xml(model.spec, model.compiled, assets=str(_MESHES))
    path.write_bytes(text.encode("utf-8"))
    folder = path.parent / _MESHES
    for name, content in model.spec.assets.items():
        folder.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    return path


def precise_xml(spec: mujoco.MjSpec, model: mujoco.MjModel, *, assets: str) -> str:
    """XML of the model in which each printed number that is a rounded one of the model is exact.

    Args:
        spec: just compiled.
        model: that it was compiled to.
        assets: folder of meshes and textures, relative to the XML file.
    """
    root = ET.fromstring(spec.to_xml())
    for compiler in root.iter("compiler"):
        compiler.attrib.update(meshdir=assets, texturedir=assets)
    for option in root.iter("option"):
        _sharpen(option, [model.opt])
    for element, source in _pairs(root, spec):
        sources = [source]
        # The compiled counterpart has angles in radians and unit vectors.
        match source:
            case mujoco.MjsActuator():
                sources.append(model.actuator(source.id))
            case mujoco.MjsBody() | mujoco.MjsJoint() | mujoco.MjsGeom() | mujoco.MjsSite():
                sources.append(getattr(model, element.tag)(source.id))
        _sharpen(element, sources)
        for inertial in element.findall("inertial"):
            _sharpen(inertial, sources[1:], _INERTIAL_NAMES)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _pairs(root: ET.Element, spec: mujoco.MjSpec) -> Iterator[tuple[ET.Element, object]]:
    """Elements that hold measures, each with the object of the spec that it was printed from."""
    for section, tags, objects in (
        ("worldbody", ("body",), spec.bodies[1:]),
        ("worldbody", ("frame",), spec.frames),
        ("worldbody", ("joint",), spec.joints),
        ("worldbody", ("geom",), spec.geoms),
        ("worldbody", ("site",), spec.sites),
        ("asset", ("mesh",), spec.meshes),
        ("equality", (), spec.equalities),
        ("actuator", (), spec.actuators),
        ("keyframe", (), spec.keys),
    ):
        top = root.find(section)
        if top is not None:
            elements = [e for e in top.iter() if e is not top and (e.tag in tags or not tags)]
            # Matched by name where there is one, else by place.
            named = {name: each for each in objects if (name := getattr(each, "name", ""))}
            for element, same_place in zip(elements, objects, strict=False):
                yield element, named.get(element.get("name", ""), same_place)


def _sharpen(
    element: ET.Element, sources: Sequence[object], names: Mapping[str, str] = _NAMES
) -> None:
    """Replace printed numbers by those of the first source that agrees with them."""
    for attribute, text in element.attrib.items():
        if attribute in _SINGLE_PRECISION:
            continue
        printed = _floats(text.split())
        for source in sources if printed.size else ():
            exact = _floats(getattr(source, names.get(attribute, attribute), ()))[: printed.size]
            if exact.size != printed.size:
                continue
            # Tiny numbers are printed as zero.
            nothing = _PRINTED**2 * float(np.abs(exact).max())
            if np.allclose(printed, exact, rtol=_PRINTED, atol=nothing):
                if not np.array_equal(printed, exact):
                    element.set(attribute, numbers(exact))
                break


def _floats(values: object) -> FloatArray:
    """Values as numbers; empty if they are none."""
    try:
        return np.ravel(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        return np.empty(0)
