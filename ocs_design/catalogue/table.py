"""A catalogue's file, CSV or TOML, as rows of raw cells."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ocs_design.exceptions import SpecificationError
from ocs_design.text_files import TextKind

# A thousand motors take a quarter of a mebibyte.
_FILE = TextKind("catalogue", 1 << 20, 5000, "Check the path.", "maker = 'maxon'")


@dataclass(frozen=True)
class Row:
    """What one entry states.

    Attributes:
        where: for people, as in `line 3` or `motor[2]`.
        cells: column -> text of a CSV file or value of a TOML file; empty ones are left out.
    """

    where: str
    cells: Mapping[str, object]


def read_rows(path: Path, kind: str, faults: list[str]) -> tuple[Row, ...]:
    """Every entry of the file, in its order; what is wrong with its shape goes into `faults`.

    Args:
        path: of a `.csv` file with a line of column names, or of a `.toml` file with one
            `[[kind]]` table per entry.
        kind: of entry: `motor` or `gear`.
        faults: one line is added for each fault.

    Raises:
        SpecificationError: the file cannot be read or is neither.
    """
    suffix = path.suffix.lower()
    if suffix not in {".csv", ".toml"}:
        raise SpecificationError(
            f"{path}: is neither .csv nor .toml", hint="A catalogue is one of these two."
        )
    text = _FILE.read(path)
    if suffix == ".csv":
        return tuple(_csv_rows(text, str(path), faults))
    return tuple(_toml_rows(text, str(path), kind, faults))


def _csv_rows(text: str, name: str, faults: list[str]) -> Iterator[Row]:
    _FILE.check_lines(text, name)
    reader = csv.reader(text.splitlines(keepends=True), strict=True)
    try:
        columns = [column.strip() for column in next(reader, [])]
        if not any(columns):
            raise SpecificationError(
                f"{name}, line 1: has no column names", hint="Begin with a line of column names."
            )
        faults.extend(
            f"line 1: the column {column!r} stands there twice"
            for column in dict.fromkeys(columns)
            if columns.count(column) > 1
        )
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield _csv_row(columns, cells, reader.line_num, faults)
    except csv.Error as error:
        raise SpecificationError(
            f"{name}, line {reader.line_num}: is not CSV: {error}",
            hint='Text with a comma stands in quotes, "like, this".',
        ) from error


def _csv_row(columns: Sequence[str], cells: Sequence[str], line: int, faults: list[str]) -> Row:
    where = f"line {line}"
    if len(cells) > len(columns):
        faults.append(
            f"{where}: has {len(cells)} cells for {len(columns)} columns; "
            'text with a comma stands in quotes, "like, this"'
        )
    pairs = zip(columns, (cell.strip() for cell in cells), strict=False)
    return Row(where, {column: cell for column, cell in pairs if cell})


def _toml_rows(text: str, name: str, kind: str, faults: list[str]) -> Iterator[Row]:
    content = _FILE.parse_toml(text, name)
    faults.extend(f"{key}: unknown key; known: {kind}" for key in content if key != kind)
    tables = content.get(kind, [])
    if not isinstance(tables, list):
        faults.append(f"{kind}: write each {kind} as a [[{kind}]] table")
        return
    for index, table in enumerate(tables, 1):
        if isinstance(table, Mapping):
            yield Row(
                f"{kind}[{index}]", {key: value for key, value in table.items() if value != ""}
            )
        else:
            faults.append(f"{kind}[{index}]: must be a table")


def refuse(path: Path, faults: Sequence[str]) -> None:
    """Raises what was found wrong with the file, if anything.

    Raises:
        SpecificationError: with one problem for each fault.
    """
    if faults:
        count = "a fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise SpecificationError(f"{path} has {count}:", problems=faults)
