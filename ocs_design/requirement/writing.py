"""A specification as the text of a file: what `read_specification` reads back, to the last bit."""

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import Enum, auto
from functools import partial
from math import isclose
from pathlib import Path
from typing import Any

from ocs_design.requirement.distributions import Distribution
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.maneuver_table import kind_of
from ocs_design.requirement.specification import SECTIONS, Specification, keys_of
from ocs_design.requirement.spread import Spread
from ocs_design.requirement.values import ONE_TURN, Quantities, Quantity, Value
from ocs_design.units import Dimension, format_quantity, parse_quantity, si_unit

PEOPLE_UNITS: Mapping[Dimension, str] = {
    Dimension.LENGTH: "mm",
    Dimension.ANGLE: "deg",
    Dimension.ANGULAR_SPEED: "rpm",
}
"""Units that people think in, where they are not SI's."""

_SAME = 1e-12
"""Relative; a degree is no finite number of radians."""


class Figures(Enum):
    """How numbers are written."""

    SI = auto()
    """In SI, to the last bit."""
    EXACT = auto()
    """In units that people think in if nothing is lost by it, else in SI."""
    ROUNDED = auto()
    """In units that people think in, to four digits."""


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
    return _with_files(specification, lambda file: str(Path(file).absolute()))


def with_files_from(specification: Specification, folder: Path) -> Specification:
    """The same with the files that it names found from `folder`, and after both were moved."""
    return _with_files(specification, lambda file: os.path.relpath(file, folder))


def _with_files(specification: Specification, renamed: Callable[[str], str]) -> Specification:
    """`-` is standard input."""

    def path(file: str | None) -> str | None:
        """Under its new name."""
        return file if file is None or file == "-" else renamed(file)

    robot, motor = specification.robot, specification.motor
    return replace(
        specification,
        robot=replace(robot, file=path(robot.file)),
        motor=replace(motor, motors=path(motor.motors), gears=path(motor.gears)),
    )


def _section(section: object, keys: Mapping[str, Any]) -> Iterator[str]:
    for name, key in keys.items():
        value = getattr(section, name)
        if value is not None:
            yield f"{name} = {written(value, key.value)}"


def _maneuver(maneuver: Maneuver) -> Iterator[str]:
    word, values = kind_of(maneuver)
    yield f"kind = {_text(word)}"
    for name, how in values.items():
        value = getattr(maneuver, name)
        if value is not None:
            yield f"{name} = {written(value, how)}"


def written(value: object, how: Value[Any], figures: Figures = Figures.SI) -> str:
    """As TOML; a quantity with its unit, for some are not believed without."""
    match how, value:
        case Quantity(dimension=dimension), float() | int():
            return _text(_quantity(value, dimension, figures))
        case Spread(dimension=dimension), Distribution():
            told = partial(_told, dimension=dimension, unit=how.unit, figures=figures)
            return _text(value.written(told))
        case Quantities(dimension=dimension), Sequence():
            entries = (_text(_quantity(entry, dimension, figures)) for entry in value)
            return f"[{', '.join(entries)}]"
        case _, float() if figures is Figures.ROUNDED:
            return f"{value:.4g}"
        case _:
            return _plain(value)


def _quantity(value: float, dimension: Dimension, figures: Figures) -> str:
    small = dimension is not Dimension.LENGTH or abs(value) < 1.0
    unit = PEOPLE_UNITS.get(dimension, si_unit(dimension)) if small else si_unit(dimension)
    return _told(value, dimension, unit, figures)


def _told(value: float, dimension: Dimension, unit: str, figures: Figures) -> str:
    """In `unit` or in SI, as `figures` wants."""
    if figures is Figures.ROUNDED:
        return format_quantity(value, unit)
    told = format_quantity(value, unit, digits=12)
    if figures is Figures.EXACT and isclose(
        parse_quantity(told, dimension, ""), value, rel_tol=_SAME
    ):
        return told
    bare = _plain(value)
    return bare if dimension is Dimension.RATIO else f"{bare} {si_unit(dimension)}"


def _plain(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _text(value)
        case float():
            # NumPy's own floats are floats too, and call themselves by their type.
            return repr(float(value))
        case Mapping():
            pairs = ", ".join(f"{_text(name)} = {_joint(entry)}" for name, entry in value.items())
            return f"{{ {pairs} }}"
        case _:
            return repr(value)


def _joint(value: float) -> str:
    """A bare number beyond a turn would be taken for degrees, and refused."""
    return _plain(value) if abs(value) <= ONE_TURN else _text(f"{float(value)!r} rad")


def _text(text: str) -> str:
    """A basic string; TOML escapes what JSON does, and the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
