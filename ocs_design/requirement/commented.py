"""A specification as a file to start from: every key explained, those not stated commented out."""

from collections.abc import Collection, Iterator, Mapping
from itertools import chain

from ocs_design.requirement.key import Key
from ocs_design.requirement.key_notes import KEY_NOTES, MANEUVER_NOTES, KeyNote, field_note
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.maneuver_table import kind_of
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys, keys_of
from ocs_design.requirement.values import Value
from ocs_design.requirement.writing import Figures, written

INTRODUCTION = """\
Every key that there is. A line such as `# h_max = "10 mm"` shows what holds anyway, or an example
where it says so: take away the `# ` to state it. A quantity is SI if it is a bare number, or text
with one of the units in brackets. Whatever is left out is assumed for the robot, and `size` prints
what it assumed."""

_WIDTH = 40
"""Columns from the start of a maneuver's line to its comment."""


def commented_toml(
    stated: Specification,
    default: Specification,
    *,
    title: str,
    chosen: Collection[str] = (),
    examples: tuple[Maneuver, ...] = (),
) -> str:
    """The text of the file; it is read back as `stated` with the chosen maneuvers.

    Args:
        stated: is written as it is, to the last digit.
        default: what holds where nothing is stated, to four digits, behind a `#`.
        title: of the file, for people; may have several lines.
        chosen: names of default maneuvers to state as well.
        examples: maneuvers that are not assumed, shown behind a `#` where none of the kind is.
    """
    blocks = [
        *(f"# {line}".rstrip() for line in (*title.splitlines(), "", *INTRODUCTION.splitlines())),
        *chain.from_iterable(
            _section(name, getattr(stated, name), getattr(default, name)) for name in SECTIONS
        ),
        *_maneuvers(stated.maneuvers, default.maneuvers, chosen),
        *_examples(stated.maneuvers or default.maneuvers, examples),
    ]
    return "\n".join(blocks) + "\n"


def rounded_text(specification: Specification, path: str) -> str:
    """The value of the key at `path`, as in `flywheel.r_max`, for people."""
    section, _, name = path.partition(".")
    value = getattr(getattr(specification, section), name)
    return written(value, all_keys()[path].value, Figures.ROUNDED).strip('"')


def _section(name: str, stated: object, default: object) -> Iterator[str]:
    yield from ("", f"[{name}]")
    for key_name, key in keys_of(SECTIONS[name]).items():
        note = KEY_NOTES[f"{name}.{key_name}"]
        yield from _key(key_name, key, note, getattr(stated, key_name), getattr(default, key_name))


def _key(name: str, key: Key, note: KeyNote, stated: object, default: object) -> Iterator[str]:
    """Comment and line of one key."""
    shown = note.example if default is None else written(default, key.value, Figures.ROUNDED)
    yield from ("", f"# {key.summary} [{key.value.takes}]", f"# {note.why}")
    if stated is not None:
        yield f"# Default: {note.default or shown}"
        yield f"{name} = {written(stated, key.value, Figures.EXACT)}"
        return
    if note.default:
        yield f"# Default: {note.default}.{' Example:' if default is None else ''}"
    yield f"# {name} = {shown}"


def _maneuvers(
    stated: tuple[Maneuver, ...], default: tuple[Maneuver, ...], chosen: Collection[str]
) -> Iterator[str]:
    """Those stated, or else the default ones, of which the chosen ones are stated too."""
    yield ""
    yield "# What the device must do in the air, a table for each. As soon as one is stated, none"
    yield "# is assumed any more; requirement.maneuvers must then be left out."
    for maneuver in stated or default:
        is_stated = bool(stated) or maneuver.name in chosen
        figures = Figures.EXACT if stated else Figures.ROUNDED
        yield ""
        yield from _maneuver(maneuver, figures, "" if is_stated else "# ")


def _examples(shown: tuple[Maneuver, ...], examples: tuple[Maneuver, ...]) -> Iterator[str]:
    """Of kinds that are not shown yet; nothing of them is assumed."""
    kinds = {kind_of(maneuver)[0] for maneuver in shown}
    for maneuver in examples:
        if kind_of(maneuver)[0] not in kinds:
            yield from ("", "# Not assumed, an example:")
            yield from _maneuver(maneuver, Figures.ROUNDED, "# ")


def _maneuver(maneuver: Maneuver, figures: Figures, mark: str) -> Iterator[str]:
    word, values = kind_of(maneuver)
    yield from (f"# {MANEUVER_NOTES[word]}", f"{mark}[[maneuver]]", f'{mark}kind = "{word}"')
    yield from (f"{mark}{line}" for line in _fields(maneuver, word, values, figures))


def _fields(
    maneuver: Maneuver, kind: str, values: Mapping[str, Value[object]], figures: Figures
) -> Iterator[str]:
    for name, how in values.items():
        value = getattr(maneuver, name)
        if value is not None:
            line = f"{name} = {written(value, how, figures)}"
            yield f"{line:<{_WIDTH}} # {field_note(kind, name)}"
