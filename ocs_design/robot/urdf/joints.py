"""Joints of a URDF.

Format: http://wiki.ros.org/urdf/XML/joint.
"""

from xml.etree import ElementTree as ET

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import RobotError
from ocs_design.robot.files.links import Connection
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.tree import Joint, JointKind
from ocs_design.robot.urdf.links import read_origin
from ocs_design.robot.urdf.xml import number, numbers, required, text

_MOVING = {
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
}
_FREE_TYPES = ("floating", "planar")
_TYPES = (*_MOVING, "fixed", *_FREE_TYPES)


def read_connection(element: ET.Element, remarks: Remarks) -> Connection:
    """One `<joint>`."""
    name = text(element, "name", "a joint")
    where = f"joint {name!r}"
    kind = text(element, "type", where)
    if kind not in _TYPES:
        raise RobotError(
            f"{where} has the unknown type {kind!r}", hint=f"known types: {', '.join(_TYPES)}"
        )
    return Connection(
        name,
        text(required(element, "parent", where), "link", where),
        text(required(element, "child", where), "link", where),
        read_origin(element, where),
        _read_joint(element, name, kind, remarks) if kind in _MOVING else None,
        held=kind if kind in _FREE_TYPES else "",
    )


def _read_joint(element: ET.Element, name: str, kind: str, remarks: Remarks) -> Joint:
    where = f"joint {name!r}"
    limit = element.find("limit")
    lower, upper = _range(limit, kind, name, remarks)
    dynamics = element.find("dynamics")
    return Joint(
        name,
        _MOVING[kind],
        _unit_axis(element, where),
        lower,
        upper,
        effort=_stated(limit, "effort", where),
        velocity=_stated(limit, "velocity", where),
        damping=0.0 if dynamics is None else number(dynamics, "damping", where, default=0.0),
        friction=0.0 if dynamics is None else number(dynamics, "friction", where, default=0.0),
        mimic=_read_mimic(element, where),
    )


def _unit_axis(element: ET.Element, where: str) -> FloatArray:
    axis = numbers(element.find("axis"), "xyz", where, (1.0, 0.0, 0.0))
    length = np.linalg.norm(axis)
    if length == 0.0:
        raise RobotError(
            f"{where} has an axis of zero length",
            hint='give a direction, as in <axis xyz="0 1 0"/>',
        )
    return axis / length


def _range(limit: ET.Element | None, kind: str, name: str, remarks: Remarks) -> tuple[float, float]:
    if limit is None or kind == "continuous":
        return -np.inf, np.inf
    where = f"joint {name!r}"
    lower = number(limit, "lower", where, default=0.0)
    upper = number(limit, "upper", where, default=0.0)
    if lower < upper:
        return lower, upper
    remarks.add("joints whose lower limit is not below the upper, read as without limits", name)
    return -np.inf, np.inf


def _stated(limit: ET.Element | None, attribute: str, where: str) -> float:
    """A limit of effort or velocity; exporters write 0 where they know none."""
    value = 0.0 if limit is None else number(limit, attribute, where, default=0.0)
    return value if value > 0.0 else np.inf


def _read_mimic(element: ET.Element, where: str) -> tuple[str, float, float] | None:
    mimic = element.find("mimic")
    if mimic is None:
        return None
    return (
        text(mimic, "joint", where),
        number(mimic, "multiplier", where, default=1.0),
        number(mimic, "offset", where, default=0.0),
    )
