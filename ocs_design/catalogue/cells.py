"""From raw cells to values: every fault of a row at once, each with its place."""

import math
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from enum import StrEnum
from reprlib import repr as shortened
from typing import Any, TypeVar

from ocs_design.catalogue.table import Row

Reader = Callable[[object], object]
"""From a cell to its value; raises ValueError with what is wrong."""

C = TypeVar("C", bound=StrEnum)


def text(raw: object) -> str:
    """Text as it is."""
    if not isinstance(raw, str):
        raise ValueError(f"{shortened(raw)} is not text; write it in quotes")  # noqa: TRY004  a Reader raises one kind
    return raw


def positive(raw: object) -> float:
    """A positive, finite number."""
    number = _number(raw)
    if not 0.0 < number < math.inf:
        raise ValueError(f"{shortened(raw)} is not positive and finite")
    return number


def whole(raw: object) -> int:
    """A positive whole number."""
    number = positive(raw)
    if number != int(number):
        raise ValueError(f"{shortened(raw)} is not a whole number")
    return int(number)


def fraction(raw: object) -> float:
    """A number above 0 and up to 1."""
    number = _number(raw)
    if not 0.0 < number <= 1.0:
        raise ValueError(f"{shortened(raw)} is not above 0 and at most 1")
    return number


def switch(raw: object) -> bool:
    """Yes or no."""
    if isinstance(raw, bool):
        return raw
    words = {"yes": True, "true": True, "no": False, "false": False}
    if not isinstance(raw, str) or raw.lower() not in words:
        raise ValueError(f"{shortened(raw)} is neither yes nor no")
    return words[raw.lower()]


def choice(words: type[C]) -> Callable[[object], C]:
    """One of an enumeration's values."""

    def read(raw: object) -> C:
        """A `Reader` of these words."""
        if not isinstance(raw, str) or raw not in set(words):
            raise ValueError(f"{shortened(raw)} is none of {', '.join(words)}")
        return words(raw)

    return read


def numbers(raw: object) -> tuple[float, ...]:
    """Positive numbers: a TOML array, or text with a space between them."""
    listed = raw.split() if isinstance(raw, str) else raw if isinstance(raw, list) else [raw]
    return tuple(sorted({positive(number) for number in listed}))


def tooth_counts(raw: object) -> tuple[int, ...]:
    """Whole positive numbers, as `numbers`."""
    counts = numbers(raw)
    if any(count != int(count) for count in counts):
        raise ValueError(f"{shortened(raw)} are not whole numbers")
    return tuple(int(count) for count in counts)


def read_cells(
    row: Row, columns: Mapping[str, Reader], required: frozenset[str], faults: list[str]
) -> dict[str, Any] | None:
    """The value of each stated column; None, with every fault kept, if there is any."""
    before = len(faults)
    where = _where(row)
    values: dict[str, Any] = {}
    for column, raw in row.cells.items():
        if column not in columns:
            faults.append(f"{where}, {column}: unknown column. {_close(column, columns)}")
            continue
        try:
            values[column] = columns[column](raw)
        except ValueError as error:
            faults.append(f"{where}, {column}: {error}")
    missing = sorted(required - row.cells.keys())
    faults.extend(f"{where}, {column}: is missing" for column in missing)
    return values if len(faults) == before else None


def _where(row: Row) -> str:
    name = row.cells.get("name")
    return f"{row.where} ({name})" if isinstance(name, str) else row.where


def _close(column: str, columns: Mapping[str, Reader]) -> str:
    close = get_close_matches(column, columns, n=1)
    return f"Did you mean {close[0]}?" if close else f"Known: {', '.join(columns)}."


def _number(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, (int, float, str)):
        raise ValueError(f"{shortened(raw)} is not a number")  # noqa: TRY004  a Reader raises one kind
    try:
        return float(raw)
    except (ValueError, OverflowError):
        raise ValueError(f"{shortened(raw)} is not a number") from None
