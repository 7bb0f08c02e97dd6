"""Records: frozen values that are written to a file, made of live values with the same figures."""

from dataclasses import fields
from typing import Any, TypeVar

Record = TypeVar("Record")


def recorded(kind: type[Record], live: object, /, **other: object) -> Record:
    """Record of a live value: its figures of the same names, and `other` in place of the rest."""
    record: Any = kind
    names = {each.name for each in fields(record)} - set(other)
    same = {name: getattr(live, name) for name in names if hasattr(live, name)}
    return kind(**same, **other)
