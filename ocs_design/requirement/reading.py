"""Reads specification files, strictly: all faults at once, each with its key's path."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.contradictions import contradictions
from ocs_design.requirement.faults import Faults
from ocs_design.requirement.maneuver import STANDARD_GRAVITY, Maneuver
from ocs_design.requirement.maneuver_table import MANEUVER_KINDS, ManeuverKind
from ocs_design.requirement.specification import SECTIONS, Specification, keys_of
from ocs_design.text_files import TextKind, safe_name

# A specification takes a few thousand bytes.
_FILE = TextKind(
    "specification", 1 << 16, 1000, "check the path given with --spec", "r_max = '30mm'"
)


def read_specification(path: Path) -> Specification:
    """The specification in a TOML file; files that it names are taken from its own folder.

    Raises:
        SpecificationError: it cannot be read, is not TOML, or has faults, all of which are listed.
    """
    specification = parse_specification(_FILE.read(path), str(path))
    robot, motor = specification.robot, specification.motor
    return replace(
        specification,
        robot=replace(robot, file=_beside(path, robot.file)),
        motor=replace(motor, motors=_beside(path, motor.motors), gears=_beside(path, motor.gears)),
    )


def _beside(path: Path, file: str | None) -> str | None:
    """A file that the specification at `path` names; `-` is standard input."""
    return file if file is None or file == "-" else str(path.parent / file)


def parse_specification(text: str, name: str) -> Specification:
    """The specification in `text`; `name` says whose text it is.

    Raises:
        SpecificationError: see `read_specification`.
    """
    content = _FILE.parse_toml(text, name)
    faults = Faults()
    specification = _specification(content, faults)
    faults.extend(contradictions(specification))
    if faults:
        count = "a fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise SpecificationError(
            f"{name} has {count}:", problems=faults, hint="for every key see docs/specification.md"
        )
    return specification


def _specification(content: Mapping[str, object], faults: Faults) -> Specification:
    known = (*SECTIONS, "maneuver")
    for name in content:
        if name not in known:
            faults.unknown(name, name, known)
    sections: dict[str, Any] = {}
    for name, section in SECTIONS.items():
        table = faults.table(content.get(name, {}), name)
        sections[name] = section(**_stated(section, table, name, faults))
    gravity = sections["requirement"].gravity or STANDARD_GRAVITY
    maneuvers = _maneuvers(content.get("maneuver", []), gravity, faults)
    return Specification(**sections, maneuvers=maneuvers)


def _stated(
    section: type, table: Mapping[str, object], where: str, faults: Faults
) -> dict[str, Any]:
    """Each field of a section that its table states."""
    keys = keys_of(section)
    found: dict[str, Any] = {}
    for name, raw in table.items():
        path = f"{where}.{name}"
        if name in keys:
            found[name] = faults.read(keys[name].value, raw, path)
        else:
            faults.unknown(path, name, tuple(keys))
    return found


def _maneuvers(raw: object, gravity: float, faults: Faults) -> tuple[Maneuver, ...]:
    if not isinstance(raw, list):
        faults.append("maneuver: write each maneuver as a [[maneuver]] table")
        return ()
    found = [
        _maneuver(faults.table(entry, f"maneuver[{index}]"), index, gravity, faults)
        for index, entry in enumerate(raw)
    ]
    known = tuple(maneuver for maneuver in found if maneuver is not None)
    faults.extend(_same_files([maneuver.name for maneuver in known]))
    return known


def _same_files(names: Sequence[str]) -> Iterator[str]:
    """Faults of maneuvers whose figures would be written to the same files."""
    of_file: dict[str, list[str]] = {}
    for name in names:
        # Some disks do not tell capitals apart.
        of_file.setdefault(safe_name(name).casefold(), []).append(name)
    for same in of_file.values():
        if len(set(same)) > 1:
            told = ", ".join(map(repr, same))
            yield f"maneuver: {told} would have the same files, give each a name of its own"
        elif len(same) > 1:
            yield f"maneuver: two are named {same[0]!r}"


def _maneuver(
    table: Mapping[str, object], index: int, gravity: float, faults: Faults
) -> Maneuver | None:
    """One maneuver, or None with its faults kept; people know it by its name, if it has one."""
    name = table.get("name")
    where = f"maneuver.{name}" if isinstance(name, str) else f"maneuver[{index}]"
    word = table.get("kind")
    kind = MANEUVER_KINDS.get(word) if isinstance(word, str) else None
    if kind is None:
        what = "is missing" if word is None else f"{shortened(word)} is unknown"
        faults.append(f"{where}.kind: {what}; one of {', '.join(MANEUVER_KINDS)}")
        return None
    before = len(faults)
    values = _maneuver_values(table, kind, where, faults)
    values.setdefault("gravity", gravity)
    return kind.maneuver(**values) if len(faults) == before else None


def _maneuver_values(
    table: Mapping[str, object], kind: ManeuverKind, where: str, faults: Faults
) -> dict[str, Any]:
    """Each field that the table states."""
    found: dict[str, Any] = {}
    for name, raw in table.items():
        path = f"{where}.{name}"
        if name in kind.values:
            found[name] = faults.read(kind.values[name], raw, path)
        elif name != "kind":
            faults.unknown(path, name, ("kind", *kind.values))
    faults.extend(f"{where}.{name}: is missing" for name in kind.required if name not in table)
    return found
