"""Keys of a specification: what each one is, how it is read and why one would state it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache
from typing import Any, TypeVar

from ocs_design.common.errors import OcsError
from ocs_design.requirement.values import Value, did_you_mean

T = TypeVar("T")


@dataclass(frozen=True)
class Key:
    """What a field of a section means outside the program.

    Attributes:
        value: how it is read.
        summary: what it is, for help and for messages.
        option: its name on the command line; empty: the key's own, with dashes.
        why: one line, when to state it, or what it changes.
        default: what holds where nothing is stated, in words; empty: the value says it all.
        assumed: the value that holds then, whatever the robot; None: it depends, or is found.
        example: a value as it is written in TOML, where there is no default to show.
    """

    value: Value[Any]
    summary: str
    option: str = ""
    why: str = ""
    default: str = ""
    assumed: Any = None
    example: str = ""


def keyed(
    value: Value[T],
    summary: str,
    *,
    why: str,
    option: str = "",
    default: str = "",
    assumed: T | None = None,
    example: str = "",
) -> T | None:
    """A field of a section that is a key, None where it is not stated (`Key`)."""
    key = Key(value, summary, option, why, default, assumed, example)
    return field(default=None, metadata={"key": key})


@cache
def keys_of(section: type) -> Mapping[str, Key]:
    """Every key of a section by name, in order."""
    return {item.name: item.metadata["key"] for item in fields(section)}


def assumed_section(section: type, **others: object) -> Any:  # noqa: ANN401 - of that type
    """A section with what holds where nothing is stated; `others` depend on the robot."""
    return section(**{name: key.assumed for name, key in keys_of(section).items()} | others)


class Faults(list[str]):
    """One line per fault, each with the path of its key."""

    def read(self, value: Value[T], raw: object, where: str) -> T | None:
        """The value, or None with the fault kept."""
        try:
            return value.read(raw, where)
        except OcsError as error:
            self.append(f"{error.message}. {error.hint}" if error.hint else error.message)
            return None

    def fields(
        self, table: Mapping[str, object], values: Mapping[str, Value[Any]], where: str
    ) -> dict[str, Any]:
        """Value of each field of a table, None with the fault kept; unknown ones are faults."""
        found: dict[str, Any] = {}
        for name, raw in table.items():
            path = f"{where}.{name}"
            if name in values:
                found[name] = self.read(values[name], raw, path)
            else:
                self.unknown(path, name, tuple(values))
        return found

    def table(self, raw: object, where: str) -> Mapping[str, object]:
        """A table as it is; an empty one, with the fault kept, for anything else."""
        if isinstance(raw, Mapping):
            return raw
        self.append(f"{where}: must be a table")
        return {}

    def unknown(self, where: str, key: str, known: Sequence[str]) -> None:
        """Keep that `key` is none of `known`, with the closest of them."""
        hint = did_you_mean(key, tuple(known)) or f"Known: {', '.join(known)}."
        self.append(f"{where}: unknown key. {hint}")
