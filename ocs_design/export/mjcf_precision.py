"""MuJoCo's own XML with full double precision: by itself it prints six digits."""

from collections.abc import Iterator, Mapping, Sequence
from xml.etree import ElementTree as ET

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.export.templates import numbers

_PRINTED = 1e-5
"""Six digits agree with the number that they were printed from to this relative error."""

_NAMES = {"polycoef": "data"}
"""What attributes of XML are called in MuJoCo's objects, where that differs."""
_SINGLE_PRECISION = {"rgba"}
"""What MuJoCo itself keeps with fewer digits than a double prints."""
_INERTIAL_NAMES = {"pos": "ipos", "quat": "iquat", "diaginertia": "inertia"}


def precise_xml(spec: mujoco.MjSpec, model: mujoco.MjModel, *, assets: str) -> str:
    """The model as XML, each printed number that is one of the model's, rounded, made exact.

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
        sources = [source, *_compiled(model, element.tag, source)]
        _sharpen(element, sources)
        for inertial in element.findall("inertial"):
            _sharpen(inertial, sources[1:], _INERTIAL_NAMES)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _pairs(root: ET.Element, spec: mujoco.MjSpec) -> Iterator[tuple[ET.Element, object]]:
    """Each element that holds measures, with the object of the spec that it was printed from."""
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
            yield from _matched(elements, objects)


def _matched(
    elements: Sequence[ET.Element], objects: Sequence[object]
) -> Iterator[tuple[ET.Element, object]]:
    """By name where there is one, else by place."""
    named = {name: each for each in objects if (name := getattr(each, "name", ""))}
    for element, same_place in zip(elements, objects, strict=False):
        yield element, named.get(element.get("name", ""), same_place)


def _compiled(model: mujoco.MjModel, tag: str, source: object) -> Sequence[object]:
    """The compiled counterpart, which has angles in radians and unit vectors."""
    match source:
        case mujoco.MjsActuator():
            return [model.actuator(source.id)]
        case mujoco.MjsBody() | mujoco.MjsJoint() | mujoco.MjsGeom() | mujoco.MjsSite():
            return [getattr(model, tag)(source.id)]
    return []


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
            if exact.size == printed.size and _printed_from(exact, printed):
                if not np.array_equal(printed, exact):
                    element.set(attribute, numbers(exact))
                break


def _printed_from(exact: FloatArray, printed: FloatArray) -> bool:
    """Whether six digits of `exact` are `printed`; what is next to nothing is printed as zero."""
    nothing = _PRINTED**2 * float(np.abs(exact).max())
    return bool(np.allclose(printed, exact, rtol=_PRINTED, atol=nothing))


def _floats(values: object) -> FloatArray:
    """Values as numbers; empty if they are none."""
    try:
        return np.ravel(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        return np.empty(0)
