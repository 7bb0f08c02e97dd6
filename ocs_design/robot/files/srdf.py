"""Named postures from a SRDF, the semantic description that MoveIt keeps beside a URDF.

Format: https://wiki.ros.org/srdf/review, `<group_state>`.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

from ocs_design.exceptions import RobotError
from ocs_design.robot.files.source import read_source
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.urdf.xml import numbers, parse_xml, text

Postures = Mapping[str, Mapping[str, float]]


def read_group_states(content: bytes) -> Postures:
    """Joint values [rad or m] of each `<group_state>`; states of one name are joined.

    Joints with several values, such as the pose of a floating base, are left out.
    """
    root = parse_xml(content, Remarks())
    if root.tag != "robot":
        raise RobotError(f"not a SRDF: its root element is <{root.tag}>")
    postures: dict[str, dict[str, float]] = {}
    for state in root.iter("group_state"):
        name = text(state, "name", "a group_state")
        postures.setdefault(name, {}).update(_joint_values(state, f"group_state {name!r}"))
    return {name: values for name, values in postures.items() if values}


def find_srdfs(folder: Path, stem: str, robot_name: str) -> list[Path]:
    """SRDFs in `folder` or its sister `srdf`: the one named like the robot file, else all that
    name the same robot."""
    named = sorted([*folder.glob("*.srdf"), *folder.glob("../srdf/*.srdf")])
    # A pipe of that name would be waited for without end.
    found = [path for path in named if path.is_file()]
    same_stem = [path for path in found if path.stem == stem]
    return same_stem[:1] or [path for path in found if _robot_name(path) == robot_name]


def postures_beside(folder: Path, stem: str, robot_name: str, remarks: Remarks) -> Postures:
    """Named postures of the SRDFs that belong to a robot file."""
    postures: dict[str, Mapping[str, float]] = {}
    for path in find_srdfs(folder, stem, robot_name):
        try:
            states = read_group_states(read_source(path).content)
        except RobotError as error:
            remarks.add(f"{path.name} was not read: {error.message}")
            continue
        postures = {**states, **postures}
    return postures


def _joint_values(state: ET.Element, where: str) -> Iterator[tuple[str, float]]:
    for joint in state.findall("joint"):
        words = text(joint, "value", where).split()
        if len(words) == 1:
            yield text(joint, "name", where), float(numbers(joint, "value", where, (0.0,))[0])


def _robot_name(path: Path) -> str | None:
    try:
        return parse_xml(read_source(path).content, Remarks()).get("name")
    except RobotError:
        return None
