"""What is wrong with a specification, collected while reading goes on."""

from collections.abc import Mapping, Sequence
from typing import TypeVar

from ocs_design.exceptions import OcsError
from ocs_design.requirement.values import Value, did_you_mean

T = TypeVar("T")


class Faults(list[str]):
    """One line per fault, each with the path of its key."""

    def read(self, value: Value[T], raw: object, where: str) -> T | None:
        """The value, or None with the fault kept."""
        try:
            return value.read(raw, where)
        except OcsError as error:
            self.append(_line(error))
            return None

    def table(self, raw: object, where: str) -> Mapping[str, object]:
        """A table as it is; an empty one, with the fault kept, for anything else."""
        if isinstance(raw, Mapping):
            return raw
        self.append(f"{where}: must be a table")
        return {}

    def unknown(self, where: str, key: str, known: Sequence[str]) -> None:
        """Keeps that `key` is none of `known`."""
        hint = did_you_mean(key, tuple(known)) or f"Known: {', '.join(known)}."
        self.append(f"{where}: unknown key. {hint}")


def _line(error: OcsError) -> str:
    return f"{error.message}. {error.hint}" if error.hint else error.message
