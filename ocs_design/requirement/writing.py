"""A specification as text: the same keys again, or a commented file to start from.

The meaning and the parser of a key, and when to set it, are with the key, in `sections` and
`device_sections`.
"""

import json
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from enum import Enum, auto
from functools import partial
from math import isclose
from pathlib import Path
from typing import Any

from ocs_design.common.units import Dimension, format_quantity, parse_quantity, si_unit
from ocs_design.requirement.keys import keys_of
from ocs_design.requirement.kinds import kind_of
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.phrases import About, Climb, Kick, Person, Pivot, Tilt
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys, with_files
from ocs_design.requirement.uncertainty import Distribution, Spread
from ocs_design.requirement.values import (
    ONE_TURN,
    JointValue,
    Quantities,
    Quantity,
    Several,
    Value,
    WordOr,
)

PEOPLE_UNITS: Mapping[Dimension, str] = {
    Dimension.LENGTH: "mm",
    Dimension.ANGLE: "deg",
    Dimension.ANGULAR_SPEED: "deg/s",
}
"""Customary units where they are not SI's; for angular speeds, that of the trunk."""

_SAME = 1e-12
"""Relative tolerance of a conversion; a degree is no finite number of radians."""


class Figures(Enum):
    """Format of numbers."""

    SI = auto()
    """In SI, with full precision."""
    EXACT = auto()
    """In customary units if no precision is lost, else in SI."""
    ROUNDED = auto()
    """In customary units, to four digits."""


def specification_to_toml(specification: Specification, comment: str = "") -> str:
    """TOML of everything that is specified, in SI with units and full precision.

    Args:
        specification: what to write; keys that are not specified are left out.
        comment: at the top; may have several lines.
    """
    lines = [f"# {line}".rstrip() for line in comment.splitlines()]
    for name, section in SECTIONS.items():
        how = {key_name: key.value for key_name, key in keys_of(section).items()}
        specified = list(_fields(getattr(specification, name), how))
        lines += ["", f"[{name}]", *specified] if specified else []
    for maneuver in specification.maneuvers:
        word, kind = kind_of(maneuver)
        lines += ["", "[[maneuver]]", f"kind = {_text(word)}", *_fields(maneuver, kind.values)]
    return "\n".join(lines).lstrip("\n") + "\n"


def with_absolute_files(specification: Specification) -> Specification:
    """Specification whose files are found from any folder: their paths are made absolute."""
    return with_files(specification, lambda file: str(Path(file).absolute()))


def with_files_from(specification: Specification, folder: Path) -> Specification:
    """Specification whose files are found from `folder`, even after both are moved together."""
    return with_files(specification, lambda file: os.path.relpath(file, folder))


def _fields(specified: object, values: Mapping[str, Value[Any]]) -> Iterator[str]:
    """Line of each field of a section or a maneuver that has a value."""
    for name, how in values.items():
        value = getattr(specified, name)
        if value is not None:
            yield f"{name} = {written(value, how)}"


def written(  # noqa: PLR0911
    value: object, how: Value[Any], figures: Figures = Figures.SI
) -> str:
    """Value as TOML, a quantity with its unit: some bare numbers would be refused."""
    match how, value:
        case WordOr(quantity=quantity), float() | int():
            return written(value, quantity, figures)
        case Quantity(dimension=Dimension.ANGULAR_SPEED, likely="rpm"), float() | int():
            return _text(_quantity_text(value, Dimension.ANGULAR_SPEED, "rpm", figures))
        case Quantity(dimension=dimension), float() | int():
            small = dimension is not Dimension.LENGTH or abs(value) < 1.0
            unit = PEOPLE_UNITS.get(dimension, si_unit(dimension)) if small else si_unit(dimension)
            return _text(_quantity_text(value, dimension, unit, figures))
        case Spread(dimension=dimension), Distribution():
            as_text = partial(_quantity_text, dimension=dimension, unit=how.unit, figures=figures)
            return _text(value.written(as_text))
        case Several(each=each), Sequence():
            return f"[{', '.join(written(entry, each, figures) for entry in value)}]"
        case Quantities(dimension=Dimension.RATIO), Sequence():
            return _plain(tuple(value))
        case Quantities(dimension=dimension), Sequence():
            return written(value, Several(Quantity(dimension)), figures)
        case _, float() if figures is Figures.ROUNDED:
            return f"{value:.4g}"
        case _:
            return _plain(value)


def _quantity_text(value: float, dimension: Dimension, unit: str, figures: Figures) -> str:
    """Quantity in `unit` or in SI, as `figures` says."""
    if figures is Figures.ROUNDED:
        return format_quantity(value, unit)
    text = format_quantity(value, unit, digits=12)
    if figures is Figures.EXACT and isclose(
        parse_quantity(text, dimension, ""), value, rel_tol=_SAME
    ):
        return text
    bare = _plain(value)
    return bare if dimension is Dimension.RATIO else f"{bare} {si_unit(dimension)}"


def _plain(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str() | Kick() | Person() | Tilt() | About() | Climb() | Pivot():
            return _text(str(value))
        case tuple():
            return f"[{', '.join(map(_plain, value))}]"
        case float():
            # NumPy's floats are floats too, but their `repr` includes the type.
            return repr(float(value))
        case Mapping():
            joints = {}
            for name, entry in value.items():
                dimension = entry.dimension if isinstance(entry, JointValue) else None
                # A bare number above one turn would be refused, as probably meant in degrees.
                bare = dimension is None and abs(entry) <= ONE_TURN
                unit = si_unit(dimension or Dimension.ANGLE)
                joints[name] = _plain(entry) if bare else _text(f"{float(entry)!r} {unit}")
            pairs = ", ".join(f"{_text(name)} = {entry}" for name, entry in joints.items())
            return f"{{ {pairs} }}"
        case _:
            return repr(value)


def _text(text: str) -> str:
    """Text in quotes; TOML escapes what JSON does, and the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


INTRODUCTION = """\
Every key that there is. A line such as `# h_max = "10 mm"` shows the default, or an example where
it says so: remove the `# ` to set the key. A quantity is a bare number in SI, or text with one of
the units in brackets. Keys that are left out get defaults for the robot; `size` prints them."""

_WIDTH = 40
"""Column at which the comment of a maneuver's line starts."""


def commented_toml(
    specified: Specification,
    default: Specification,
    *,
    title: str,
    chosen: Collection[str] = (),
    examples: tuple[Maneuver, ...] = (),
) -> str:
    """The text of the file; it reads back as `specified` with the chosen maneuvers.

    Args:
        specified: written with full precision.
        default: the defaults, to four digits, commented out.
        title: of the file; may have several lines.
        chosen: names of default maneuvers to include as well.
        examples: maneuvers that are not defaults, commented out, of kinds not written otherwise.
    """
    lines = [f"# {line}".rstrip() for line in (*title.splitlines(), "", *INTRODUCTION.splitlines())]
    for name, section in SECTIONS.items():
        lines += ["", f"[{name}]"]
        for key_name, key in keys_of(section).items():
            own, assumed = (getattr(getattr(one, name), key_name) for one in (specified, default))
            rounded = "" if assumed is None else written(assumed, key.value, Figures.ROUNDED)
            shown = rounded or key.example
            lines += ["", f"# {key.summary} [{key.value.takes}]", f"# {key.why}"]
            if own is not None:
                lines.append(f"# Default: {key.default or shown}")
                lines.append(f"{key_name} = {written(own, key.value, Figures.EXACT)}")
                continue
            if key.default:
                lines.append(f"# Default: {key.default}.{'' if rounded else ' Example:'}")
            lines.append(f"# {key_name} = {shown}")

    lines += [
        "",
        "# What the device must do, one table per maneuver. If any is given, they replace the",
        "# default ones, and requirement.maneuvers must be left out.",
    ]
    maneuvers = specified.maneuvers or default.maneuvers
    figures = Figures.EXACT if specified.maneuvers else Figures.ROUNDED
    for maneuver in maneuvers:
        is_specified = bool(specified.maneuvers) or maneuver.name in chosen
        lines += ["", *_commented_maneuver(maneuver, figures, "" if is_specified else "# ")]
    kinds = {kind_of(maneuver)[0] for maneuver in maneuvers}
    for maneuver in examples:
        if kind_of(maneuver)[0] not in kinds:
            lines += ["", "# An example, not a default:"]
            lines += _commented_maneuver(maneuver, Figures.ROUNDED, "# ")
    return "\n".join(lines) + "\n"


def rounded_text(specification: Specification, path: str) -> str:
    """The value of the key at `path`, as in `flywheel.r_max`, for display."""
    section, _, name = path.partition(".")
    value = getattr(getattr(specification, section), name)
    return written(value, all_keys()[path].value, Figures.ROUNDED).strip('"')


def _commented_maneuver(maneuver: Maneuver, figures: Figures, mark: str) -> Iterator[str]:
    """Table of a maneuver with a note on each field; `mark` comments it out."""
    word, kind = kind_of(maneuver)
    yield from (f"# {kind.note}", f"{mark}[[maneuver]]", f'{mark}kind = "{word}"')
    for name, how in kind.values.items():
        value = getattr(maneuver, name)
        if value is not None:
            line = f"{name} = {written(value, how, figures)}"
            yield f"{mark}{line:<{_WIDTH}} # {kind.notes[name]}"
