"""A specification as the text of a file: what `read_specification` reads back, to the last bit."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.maneuver_table import MANEUVER_KINDS
from ocs_design.requirement.specification import SECTIONS, Specification, keys_of
from ocs_design.requirement.values import Quantities, Quantity, Value
from ocs_design.units import si_unit


def specification_to_toml(specification: Specification, comment: str = "") -> str:
    """Everything that is stated, in SI with units and full digits.

    Args:
        specification: what to write; what it does not state is left out.
        comment: for people, at the top; may have several lines.
    """
    lines = [f"# {line}".rstrip() for line in comment.splitlines()]
    for name, section in SECTIONS.items():
        stated = list(_section(getattr(specification, name), keys_of(section)))
        lines += ["", f"[{name}]", *stated] if stated else []
    for maneuver in specification.maneuvers:
        lines += ["", "[[maneuver]]", *_maneuver(maneuver)]
    return "\n".join(lines).lstrip("\n") + "\n"


def with_absolute_files(specification: Specification) -> Specification:
    """The same with the files that it names found from any folder."""
    robot, motor = specification.robot, specification.motor
    return replace(
        specification,
        robot=replace(robot, file=_absolute(robot.file)),
        motor=replace(motor, motors=_absolute(motor.motors), gears=_absolute(motor.gears)),
    )


def _absolute(file: str | None) -> str | None:
    """`-` is standard input."""
    return file if file is None or file == "-" else str(Path(file).absolute())


def _section(section: object, keys: Mapping[str, Any]) -> Iterator[str]:
    for name, key in keys.items():
        value = getattr(section, name)
        if value is not None:
            yield f"{name} = {_written(value, key.value)}"


def _maneuver(maneuver: Maneuver) -> Iterator[str]:
    word, kind = next(
        (word, kind) for word, kind in MANEUVER_KINDS.items() if kind.maneuver is type(maneuver)
    )
    yield f"kind = {_text(word)}"
    for name, how in kind.values.items():
        value = getattr(maneuver, name)
        if value is not None:
            yield f"{name} = {_written(value, how)}"


def _written(value: object, how: Value[Any]) -> str:
    """As TOML; a quantity with its unit, for some are not believed without."""
    match how:
        case Quantity():
            return _text(_quantity(value, how))
        case Quantities() if isinstance(value, Sequence):
            return f"[{', '.join(_text(_quantity(entry, how)) for entry in value)}]"
        case _:
            return _plain(value)


def _quantity(value: object, how: Quantity | Quantities) -> str:
    return f"{value!r} {si_unit(how.dimension)}"


def _plain(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _text(value)
        case Mapping():
            pairs = ", ".join(f"{_text(name)} = {_plain(entry)}" for name, entry in value.items())
            return f"{{ {pairs} }}"
        case _:
            return repr(value)


def _text(text: str) -> str:
    """A basic string; TOML escapes what JSON does, and the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
