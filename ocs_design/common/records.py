"""Records: frozen values that are written to a file, made from live values."""

from dataclasses import fields
from typing import Any, TypeVar

Record = TypeVar("Record")


def recorded(kind: type[Record], live: object, /, **other: object) -> Record:
    """Record of a live value: its attributes of the same names, and `other` for the rest.

    Raises:
        AttributeError: a field is in neither, whether it has a default or not: a figure that is
            renamed in one of the two must not become the default in the file.
    """
    record: Any = kind
    names = {field.name for field in fields(record) if field.init} - set(other)
    return kind(**{name: getattr(live, name) for name in names}, **other)
