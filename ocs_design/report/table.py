"""Plain data types for facts: names with values, tables, words with a tone.

Each renderer formats them in its own way.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Self, TypeAlias, TypeVar


class Tone(StrEnum):
    """Meaning of a word, from which renderers take its colour."""

    PLAIN = "plain"
    PASS = "pass"
    FAIL = "fail"
    OPEN = "open"


@dataclass(frozen=True)
class Toned:
    """A short text with its tone."""

    text: str
    tone: Tone


Cell: TypeAlias = str | Toned
Entry = TypeVar("Entry")


def cell_text(cell: Cell) -> str:
    """The text of a cell."""
    return cell.text if isinstance(cell, Toned) else cell


Rows: TypeAlias = tuple[tuple[str, str], ...]
"""Names and their values, in the order in which they are shown."""


@dataclass(frozen=True)
class Heading:
    """Heading of one column.

    Attributes:
        name: name of the content; may have several lines in a narrow heading.
        unit: unit of all values; empty if there is none or each value has its own.
        words: whether it holds words, which are aligned left.
    """

    name: str
    unit: str = ""
    words: bool = False


_HEADING = re.compile(r"(<?)(.*?)(?: \[(.*)\])?", re.DOTALL)


def columns(*headings: str) -> tuple[Heading, ...]:
    """Columns from headings such as `mass [g]`; a leading `<` marks a column of words."""
    matches = (_HEADING.fullmatch(heading) for heading in headings)
    return tuple(Heading(match[2], match[3] or "", bool(match[1])) for match in matches if match)


@dataclass(frozen=True)
class CellTable:
    """Columns and rows of cells, as many in each row as there are columns."""

    columns: tuple[Heading, ...]
    rows: tuple[tuple[Cell, ...], ...]

    @classmethod
    def of(cls, entries: Iterable[Entry], cells: Mapping[str, Callable[[Entry], Cell]]) -> Self:
        """Table with a row for each entry, and for each heading a column made by its function."""
        rows = (tuple(cell(entry) for cell in cells.values()) for entry in entries)
        return cls(columns(*cells), tuple(rows))

    def first(self, columns: int) -> "CellTable":
        """Table of the first columns alone."""
        return CellTable(self.columns[:columns], tuple(row[:columns] for row in self.rows))


_UNITS = "mm|um|m|kg|g|[mu]?N|s|ms|deg|rad|rpm|V|A|W|kW|J|MPa|ohm|Hz"
_UNIT_SPACE = re.compile(
    rf"(?<=\d) (?=(?:{_UNITS})\b)|(?<=N) (?=m\b)|(?<=N m) (?=s\b)|(?<=\bkg) (?=m+2\b)"
)
"""Spaces between a number and its unit, and within a unit."""


def with_nonbreaking_units(text: str) -> str:
    """Text with non-breaking spaces between numbers and their units."""
    return _UNIT_SPACE.sub("\N{NO-BREAK SPACE}", text)
