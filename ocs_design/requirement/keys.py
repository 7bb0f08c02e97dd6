"""Keys of a specification: what each one means, how it is parsed and when to set it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache
from typing import Any, TypeVar

from ocs_design.common.errors import OcsError
from ocs_design.requirement.values import Value, did_you_mean

T = TypeVar("T")


@dataclass(frozen=True)
class Key:
    """Meaning of a section's field for the user.

    Attributes:
        value: its parser.
        summary: what it is, for help and messages.
        option: its name on the command line; empty: the key's own, with dashes.
        why: when to set it, or what it changes, in one line.
        default: the default in words; empty: its value says it all, or an example is given of what
            is not required by default.
        assumed: default value for any robot; None: it depends on the robot, or is found.
        example: a value as written in TOML, for a key that has no default to show.
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
    """A field of a section that is a key, None where it is not specified (`Key`)."""
    default = default or ("not required" if example else "")
    key = Key(value, summary, option, why, default, assumed, example)
    return field(default=None, metadata={"key": key})


@cache
def keys_of(section: type) -> Mapping[str, Key]:
    """Every key of a section by name, in order."""
    return {item.name: item.metadata["key"] for item in fields(section)}


def assumed_section(section: type, **others: object) -> Any:  # noqa: ANN401 - of that type
    """A section filled with its defaults; `others` are those that depend on the robot."""
    return section(**{name: key.assumed for name, key in keys_of(section).items()} | others)


class Faults(list[str]):
    """One line per fault, each with the path of its key."""

    def read(self, value: Value[T], raw: object, where: str) -> T | None:
        """The value; None, and the fault recorded, if it is invalid."""
        try:
            return value.read(raw, where)
        except OcsError as error:
            self.append(error.sentence)
            return None

    def fields(
        self, table: Mapping[str, object], values: Mapping[str, Value[Any]], where: str
    ) -> dict[str, Any]:
        """Value of each field, None where invalid; faults and unknown keys are recorded."""
        parsed: dict[str, Any] = {}
        for name, raw in table.items():
            path = f"{where}.{name}"
            if name in values:
                parsed[name] = self.read(values[name], raw, path)
            else:
                self.unknown(path, name, tuple(values))
        return parsed

    def table(self, raw: object, where: str) -> Mapping[str, object]:
        """`raw` if it is a table; otherwise an empty one, and the fault recorded."""
        if isinstance(raw, Mapping):
            return raw
        self.append(f"{where}: must be a table")
        return {}

    def unknown(self, where: str, key: str, known: Sequence[str]) -> None:
        """Record that `key` is not among `known`, and suggest the closest of them."""
        hint = did_you_mean(key, tuple(known)) or f"Known: {', '.join(known)}."
        self.append(f"{where}: unknown key. {hint}")
