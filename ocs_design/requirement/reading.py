"""Reads specification files strictly, and reports all faults at once, each with its key's path."""

import os
from collections.abc import Mapping
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

import numpy as np

from ocs_design.common.errors import SpecificationError
from ocs_design.common.files import AnyPath, TextKind, comparable_name
from ocs_design.common.units import STANDARD_GRAVITY
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.keys import Faults, keys_of
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.specification import SECTIONS, Specification, with_files
from ocs_design.requirement.values import Text

# A specification is a few thousand bytes long.
_FILE = TextKind(
    "specification", 1 << 16, 1000, "check the path given with --spec", "r_max = '30mm'"
)


def read_specification(path: AnyPath) -> Specification:
    """The specification in a TOML file; paths in it are relative to its own folder.

    Raises:
        SpecificationError: it cannot be read, is not TOML, or has faults, all of which are listed.
    """
    path = Path(path)
    content = _FILE.read(path)
    if content.lstrip().startswith("<"):
        raise SpecificationError(
            f"{path} is a robot or other XML, not a specification",
            hint=f"give the robot without --spec: ocs-design size {path} --spec mine.toml",
        )
    specification = parse_specification(content, str(path))
    return with_files(specification, lambda file: str(path.parent / file))


def parse_specification(text: str, name: str) -> Specification:
    """The specification in `text`; messages call it `name`.

    Raises:
        SpecificationError: see `read_specification`.
    """
    return _checked(_FILE.parse_toml(text, name), name)


def specify(robot: AnyPath | None = None, /, **tables: object) -> Specification:
    """The specification that a file with these tables would give.

    Paths in it are relative to the working directory.

    Args:
        robot: its file; None: the table `robot` has the file, or mass and inertia.
        tables: sections as dictionaries and `maneuver` as a list of them, with the keys and values
            of the specification file: `flywheel={"r_max": "30mm"}`.

    Raises:
        SpecificationError: all faults, each with its key's path.
    """
    content = {name: _plain(value) for name, value in tables.items()}
    own = content.setdefault("robot", {})
    if robot is not None and isinstance(own, dict):
        content["robot"] = {**own, "file": os.fspath(robot)}
    return _checked(content, "the specification")


def specification_of(source: Specification | AnyPath) -> Specification:
    """`source` itself, the specification in a TOML file, or one with a robot file alone.

    Raises:
        SpecificationError: the file of a specification cannot be read, or has faults.
    """
    if isinstance(source, Specification):
        return source
    is_toml = Path(source).suffix.lower() == ".toml"
    return read_specification(source) if is_toml else specify(source)


def _plain(value: object) -> object:
    """Value as a TOML file would have it: paths as text, tuples as lists, NumPy's as Python's."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {name: _plain(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _checked(content: Mapping[str, object], name: str) -> Specification:
    """The specification with this content; messages call it `name`."""
    faults, known = Faults(), (*SECTIONS, "maneuver")
    for key in content:
        if key not in known:
            faults.unknown(key, key, known)
    motor, supply = content.get("motor"), content.get("supply", {})
    if isinstance(motor, Mapping) and isinstance(supply, Mapping) and "bus_voltage" in motor:
        # Older files have `motor.bus_voltage`.
        kept = {key: value for key, value in motor.items() if key != "bus_voltage"}
        renamed = {"voltage": motor["bus_voltage"], **supply}
        content = {**content, "motor": kept, "supply": renamed}
    sections: dict[str, Any] = {}
    for title, section in SECTIONS.items():
        table = faults.table(content.get(title, {}), title)
        values = {name: key.value for name, key in keys_of(section).items()}
        sections[title] = section(**faults.fields(table, values, title))
    tables, maneuvers = content.get("maneuver", []), []
    if not isinstance(tables, list):
        faults.append("maneuver: write each maneuver as a [[maneuver]] table")
        tables = []
    specified_gravity = sections["requirement"].gravity
    gravity = STANDARD_GRAVITY if specified_gravity is None else specified_gravity
    for index, entry in enumerate(tables):
        table = faults.table(entry, f"maneuver[{index}]")
        maneuver = _maneuver(table, index, gravity, faults)
        if maneuver is not None:
            maneuvers.append(maneuver)

    # Maneuvers that would be written to the same files.
    of_file: dict[str, list[str]] = {}
    for maneuver in maneuvers:
        of_file.setdefault(comparable_name(maneuver.name), []).append(maneuver.name)
    for same in of_file.values():
        if len(set(same)) > 1:
            names = ", ".join(map(repr, same))
            faults.append(f"maneuver: {names} would write the same files; rename one of them")
        elif len(same) > 1:
            faults.append(f"maneuver: two are named {same[0]!r}")
    specification = Specification(**sections, maneuvers=tuple(maneuvers))
    faults.extend(contradictions(specification))
    if faults:
        count = "a fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise SpecificationError(
            f"{name} has {count}:",
            problems=faults,
            hint="`ocs-design init` writes a file that has every key",
        )
    return specification


def _maneuver(
    table: Mapping[str, object], index: int, gravity: float, faults: Faults
) -> Maneuver | None:
    """One maneuver, or None with its faults recorded; they cite its name, if it has one."""
    name = table.get("name")
    where = f"maneuver.{name}" if isinstance(name, str) else f"maneuver[{index}]"
    word = table.get("kind")
    kind = MANEUVER_KINDS.get(word) if isinstance(word, str) else None
    if kind is None:
        what = "is missing" if word is None else f"{shortened(word)} is unknown"
        faults.append(f"{where}.kind: {what}; one of {', '.join(MANEUVER_KINDS)}")
        return None
    before = len(faults)
    values = faults.fields(table, {"kind": Text(), **kind.values}, where)
    del values["kind"]
    faults.extend(f"{where}.{name}: is missing" for name in kind.required if name not in table)
    values.setdefault("gravity", gravity)
    return kind.maneuver(**values) if len(faults) == before else None
