"""Rows of a catalogue's file: from raw cells to values, and entries by name."""

import csv
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from enum import StrEnum
from functools import cache
from importlib.resources import as_file
from importlib.resources import files as resources
from pathlib import Path
from reprlib import repr as shortened
from types import MappingProxyType, UnionType
from typing import Any, NamedTuple, Protocol, TypeVar, Union, get_args, get_origin, get_type_hints

from ocs_design.common.errors import SpecificationError, closest
from ocs_design.common.files import TextKind
from ocs_design.common.ranges import Unit

# A thousand motors take a quarter of a MiB.
_FILE = TextKind("catalogue", 1 << 20, 5000, "Check the path.", "maker = 'maxon'")


@dataclass(frozen=True)
class Row:
    """One entry as read.

    Attributes:
        where: its place in the file, such as `line 3` or `motor[2]`.
        cells: column -> text of a CSV file or value of a TOML file; empty ones are omitted.
    """

    where: str
    cells: Mapping[str, object]


def read_rows(path: Path, kind: str, faults: list[str]) -> tuple[Row, ...]:
    """Every entry of the file, in order; structural faults are added to `faults`.

    Args:
        path: a `.csv` file with a line of column names, or a `.toml` file with one `[[kind]]` table
            per entry.
        kind: kind of entry: `motor` or `gear`.
        faults: list to which a line is added for each fault.

    Raises:
        SpecificationError: the file cannot be read or has another suffix.
    """
    suffix = path.suffix.lower()
    if suffix not in {".csv", ".toml"}:
        raise SpecificationError(
            f"{path}: is neither .csv nor .toml", hint="Save the catalogue as .csv or .toml."
        )
    text = _FILE.read(path)
    if suffix == ".csv":
        return tuple(_csv_rows(text, str(path), faults))
    content = _FILE.parse_toml(text, str(path))
    faults.extend(f"{key}: unknown key; known: {kind}" for key in content if key != kind)
    tables, rows = content.get(kind, []), []
    if not isinstance(tables, list):
        faults.append(f"{kind}: give each {kind} as a [[{kind}]] table")
        return ()
    for index, table in enumerate(tables, 1):
        if isinstance(table, Mapping):
            cells = {key: value for key, value in table.items() if value != ""}
            rows.append(Row(f"{kind}[{index}]", cells))
        else:
            faults.append(f"{kind}[{index}]: must be a table")
    return tuple(rows)


def _csv_rows(text: str, name: str, faults: list[str]) -> Iterator[Row]:
    """Row of each line except the first, which names the columns."""
    _FILE.check_lines(text, name)
    reader = csv.reader(text.splitlines(keepends=True), strict=True)
    try:
        columns = [column.strip() for column in next(reader, [])]
        if not any(columns):
            raise SpecificationError(
                f"{name}, line 1: has no column names", hint="Begin with a line of column names."
            )
        if len(columns) == 1 and (
            other := next((mark for mark in ";\t" if mark in columns[0]), "")
        ):
            between = "semicolons" if other == ";" else "tabs"
            raise SpecificationError(
                f"{name}, line 1: {between} separate the columns",
                hint="Save it with commas between the columns, and points in numbers.",
            )
        faults.extend(
            f"line 1: the column {column!r} occurs twice"
            for column in dict.fromkeys(columns)
            if columns.count(column) > 1
        )
        for line in reader:
            cells = [cell.strip() for cell in line]
            if not any(cells):
                continue
            where = f"line {reader.line_num}"
            if len(cells) > len(columns):
                faults.append(
                    f"{where}: has {len(cells)} cells for {len(columns)} columns; "
                    'put text with a comma in quotes, "like, this"'
                )
            pairs = zip(columns, cells, strict=False)
            yield Row(where, {column: cell for column, cell in pairs if cell})
    except csv.Error as error:
        raise SpecificationError(
            f"{name}, line {reader.line_num}: is not CSV: {error}",
            hint='Put text with a comma in quotes, "like, this".',
        ) from error


Reader = Callable[[object], object]
"""Function from a cell to its value; raises ValueError with what is wrong."""

C = TypeVar("C", bound=StrEnum)


def text(raw: object) -> str:
    """Text, unchanged."""
    if not isinstance(raw, str):
        raise ValueError(f"{shortened(raw)} is not text; write it in quotes")  # noqa: TRY004  a Reader raises one kind
    return raw


def positive(raw: object) -> float:
    """A positive, finite number."""
    number = _number(raw)
    if not 0.0 < number < math.inf:
        raise ValueError(f"{shortened(raw)} is not positive and finite")
    return number


def positive_integer(raw: object) -> int:
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
    """A `Reader` of an enumeration's values."""

    def read(raw: object) -> C:
        """One of these values."""
        if not isinstance(raw, str) or raw not in set(words):
            raise ValueError(f"{shortened(raw)} is not one of {', '.join(words)}")
        return words(raw)

    return read


def numbers(raw: object) -> tuple[float, ...]:
    """Positive numbers: a TOML array, or text separated by spaces."""
    listed = raw.split() if isinstance(raw, str) else raw if isinstance(raw, list) else [raw]
    return tuple(sorted({positive(number) for number in listed}))


def tooth_counts(raw: object) -> tuple[int, ...]:
    """Positive whole numbers, in the form of `numbers`."""
    return tuple(map(positive_integer, numbers(raw)))


_READERS: Mapping[object, Reader] = {
    str: text,
    float: positive,
    int: positive_integer,
    bool: switch,
    tuple[float, ...]: numbers,
    tuple[int, ...]: tooth_counts,
}


class Column(NamedTuple):
    """A column of a file: the field that it fills, and how its cells are read."""

    field: str
    read: Reader


@cache
def columns_of(sheet: type) -> Mapping[str, Column]:
    """Columns for the fields of a dataclass, by name, each read by its type.

    A field that states its unit, `Annotated[float | None, Unit("kg")]`, has the column `mass_kg`;
    others have columns of their own names. Where the type is not specific enough, the field names
    its reader: `Annotated[float, fraction]`. None means an omitted cell.
    """
    kinds, columns = get_type_hints(sheet), {}
    for name, hint in get_type_hints(sheet, include_extras=True).items():
        kind, metadata = kinds[name], getattr(hint, "__metadata__", ())
        if get_origin(kind) in {Union, UnionType}:
            kind = get_args(kind)[0]
        is_words = isinstance(kind, type) and issubclass(kind, StrEnum)
        readers = [*filter(callable, metadata), choice(kind) if is_words else _READERS[kind]]
        units = [mark.suffix for mark in metadata if isinstance(mark, Unit)]
        columns["_".join([name, *units])] = Column(name, readers[0])
    return columns


def _number(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, (int, float, str)):
        raise ValueError(f"{shortened(raw)} is not a number")  # noqa: TRY004  a Reader raises one kind
    try:
        return float(raw)
    except (ValueError, OverflowError):
        raise ValueError(f"{shortened(raw)} is not a number") from None


T = TypeVar("T")

MOST_SUGGESTED = 3
# Similarity of names above which they may be the same model: one letter of five or more may be
# wrong.
_SAME_MODEL = 0.8

MOST_LISTED = 12
"""Largest number of names listed in a hint; otherwise it refers to the catalogue."""


def entry(known: Mapping[str, T], name: str, kind: str, also: Mapping[str, T] | None = None) -> T:
    """The entry called `name`, ignoring case, spaces and dashes.

    Args:
        known: entries by name.
        name: name to find.
        kind: of the entries, for messages.
        also: entries by alternative names, which hints do not show.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    if name in known:
        return known[name]
    for names in (known, also or {}):
        matches = [
            row for known_name, row in names.items() if _letters(known_name) == _letters(name)
        ]
        if len(matches) == 1:
            return matches[0]
    if close := _closest(known, name):
        hint = f"Did you mean {' or '.join(close)}?"
    elif len(known) <= MOST_LISTED:
        hint = f"Known: {', '.join(known)}."
    else:
        hint = f"`ocs-design catalogue {kind}s` lists all {len(known)}."
    raise SpecificationError(f"there is no {kind} {name!r}", hint=hint)


def _letters(name: str) -> str:
    """Letters and digits of a name, in lower case."""
    return "".join(filter(str.isalnum, name.casefold()))


def _closest(known: Iterable[str], name: str) -> Sequence[str]:
    """Names that may be meant, at most three, the likeliest first.

    People name a motor by its model without the winding, or with its maker, possibly misspelt.
    """
    words = [word for part in name.replace("-", " ").split() if (word := _letters(part))]
    # The maker's name may accompany the model's, which contains a digit.
    for query in (words, [word for word in words if any(map(str.isdigit, word))][:1]):
        containing = [
            known_name
            for known_name in known
            if all(word in _letters(known_name) for word in query)
        ]
        if query and containing:
            return containing[:MOST_SUGGESTED]
    if close := closest(name, known, most=MOST_SUGGESTED):
        return close
    models = {known_name[: len(name)].casefold() for known_name in known}
    close_models = closest(name, models, most=MOST_SUGGESTED, cutoff=_SAME_MODEL)
    beginning = [
        known_name
        for model in close_models
        for known_name in known
        if known_name.casefold().startswith(model)
    ]
    return beginning[:MOST_SUGGESTED]


class Named(Protocol):
    """An entry of a catalogue."""

    @property
    def name(self) -> str:
        """Name, unique in its catalogue."""


E = TypeVar("E", bound=Named)


def load_entries(
    path: Path,
    kind: str,
    sheet: type[E],
    faults_of: Callable[[E], Iterable[str]] = lambda _: (),
    lacks: Callable[[E], str] = lambda _: "",
) -> Mapping[str, E]:
    """Every entry of a CSV or TOML file by name, sorted (docs/catalogue.md has the columns).

    Args:
        path: of the file.
        kind: kind of entry: `motor` or `gear`.
        sheet: dataclass whose fields are the columns.
        faults_of: faults of an entry whose cells can be read, one line each.
        lacks: what else an entry needs to be useful, reported together with faults.

    Raises:
        SpecificationError: it cannot be read, or has faults, which are all listed.
    """
    faults: list[str] = []
    by_name: dict[str, E] = {}
    first: dict[str, str] = {}
    duplicates: list[str] = []
    lacking: dict[str, str] = {}
    rows = read_rows(path, kind, faults)
    for row in rows:
        name = row.cells.get("name")
        where = f"{row.where} ({name})" if isinstance(name, str) else row.where
        if isinstance(name, str) and first.setdefault(name, row.where) != row.where:
            duplicates.append(f"{row.where}: {name!r} is already the name of {first[name]}")
        fault_count = len(faults)
        values, unread = _read_cells(row, where, sheet, faults)
        item = sheet(**values)
        if len(faults) == fault_count:
            faults.extend(f"{where}: {fault}" for fault in faults_of(item))
        # An invalid number is reported as such, and not as missing too.
        lacking[where] = lacks(sheet(**values | dict.fromkeys(unread, 1)))
        by_name[item.name] = item
    faults += duplicates
    if faults:
        count = "a fault" if len(faults) == 1 else f"{len(faults)} faults"
        faults += [f"{where}: {what}" for where, what in lacking.items() if what]
        raise SpecificationError(f"{path} has {count}:", problems=faults)
    return _by_name(by_name)


def _read_cells(
    row: Row, where: str, sheet: type, faults: list[str]
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """The value of each readable column, and the number columns that cannot be read.

    Required texts are empty where they cannot be read.
    """
    columns, values, unread = columns_of(sheet), {}, []
    for column, raw in row.cells.items():
        if column not in columns:
            close = [
                known_column for known_column in columns if known_column.startswith(f"{column}_")
            ][:1]
            close = close or closest(column, columns)
            hint = f"Did you mean {close[0]}?" if close else f"Known: {', '.join(columns)}."
            faults.append(f"{where}, {column}: unknown column. {hint}")
            continue
        try:
            values[columns[column].field] = columns[column].read(raw)
        except ValueError as error:
            faults.append(f"{where}, {column}: {error}")
            if columns[column].read in {positive, positive_integer}:
                unread.append(columns[column].field)
    required = {item.name for item in fields(sheet) if item.default is MISSING}
    needed = {name for name, column in columns.items() if column.field in required}
    faults.extend(f"{where}, {name}: is missing" for name in sorted(needed - row.cells.keys()))
    return {**dict.fromkeys(required, ""), **values}, tuple(unread)


def catalogue(
    name: str, load: Callable[[Path], Mapping[str, E]], file: Path | None = None
) -> Mapping[str, E]:
    """Every entry of a file that comes with the package, read and checked on the first call.

    Entries of a user's file replace ones of the same name.
    """
    packaged = _packaged(name, load)
    return packaged if file is None else _by_name({**packaged, **load(file)})


@cache
def _packaged(name: str, load: Callable[[Path], Any]) -> Any:  # noqa: ANN401
    with as_file(resources("ocs_design.catalogue").joinpath(name)) as path:
        return load(path)


def _by_name(entries: Mapping[str, E]) -> Mapping[str, E]:
    return MappingProxyType(dict(sorted(entries.items())))
