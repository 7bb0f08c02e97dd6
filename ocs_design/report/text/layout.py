"""Layout of terminal output: headings, facts, tables, notes and lists of files."""

import sys
import textwrap
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from rich import box
from rich import table as rich_table
from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from ocs_design.device.records.design import DESIGN_FILE
from ocs_design.export.folder import REPORT_FILE
from ocs_design.report.table import CellTable, Tone, Toned, cell_text, with_nonbreaking_units
from ocs_design.report.text.console import breaks_lines

INDENT = (0, 0, 0, 2)

_NARROWEST_COLUMN = 16
"""Minimum width of a column of words [characters]."""

_ASCII_BOX = box.Box("    \n    \n -- \n    \n    \n    \n    \n    \n", ascii=True)
"""Rule below the headings of a table, in ASCII for pipes."""

MOST_LISTED = 6
"""Number of files of one folder above which they are counted and not named."""

STYLES = {Tone.PLAIN: "dim", Tone.PASS: "green", Tone.FAIL: "bold red", Tone.OPEN: "yellow"}


def heading(console: Console, text: str) -> None:
    """Print the title of a section."""
    console.print()
    console.print(Text(text, style="bold"))


def wrapped(text: str, width: int) -> str:
    """Lines of a text, none of which ends between a number and its unit."""
    lines = textwrap.wrap(
        with_nonbreaking_units(text), width, break_long_words=False, break_on_hyphens=False
    )
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")


def note(console: Console, text: str, *, style: str = "dim") -> None:
    """Print a paragraph, indented like everything under a heading."""
    lines = wrapped(text, console.width - INDENT[-1])
    console.print(Padding(Text(lines, style=style), INDENT))


def warn(console: Console, warnings: Iterable[str]) -> None:
    """Print warnings, one line each."""
    for warning in warnings:
        note(console, f"warning: {warning}", style="yellow")


def items(console: Console, texts: Iterable[str], *, style: str = "dim") -> None:
    """Print a list; wrapped lines stay indented after the dash."""
    entries = list(texts)
    if not entries:
        return
    grid = rich_table.Table.grid(padding=(0, 1))
    for text in entries:
        lines = wrapped(text, console.width - len("  - "))
        grid.add_row(Text("  -", style=style), Text(lines, style=style))
    console.print(grid)


def facts(console: Console, rows: Iterable[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    entries = [(f"  {name}", value) for name, value in rows]
    room = console.width - 2 - max((len(name) for name, _ in entries), default=0)
    grid = rich_table.Table.grid(padding=(0, 2))
    grid.add_column(no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in entries:
        grid.add_row(Text(name, style="dim"), Text(wrapped(value, room)))
    console.print(grid)


def show(console: Console, table: CellTable, *, fewest: int = 0) -> None:
    """Print a table, indented like everything under a heading; with less padding if it is too wide.

    If the terminal is too narrow, words are wrapped, and if that is not enough, the last columns
    are left out and named in a note; a number is never broken. With `fewest`, columns are first
    left out down to that number, without a note, before words are wrapped.
    """
    room = console.width - INDENT[-1]
    for count in range(len(table.columns), 0, -1):
        shown = table.first(count)
        rendered = _rendered(shown, console)
        if _width(console, rendered) > room:
            rendered.padding = (0, 1, 0, 0)
        if _width(console, rendered) > room and count <= (fewest or count):
            rendered = _rendered(_narrowed(shown, _width(console, rendered) - room), console)
            rendered.padding = (0, 1, 0, 0)
        if _width(console, rendered) <= room:
            break
    console.print(Padding(rendered, INDENT))
    omitted = [column.name.replace("\n", " ") for column in table.columns[count:]]
    if omitted and not fewest:
        note(console, f"The terminal is too narrow for {'; '.join(omitted)}.")


def _rendered(table: CellTable, console: Console) -> rich_table.Table:
    """Table of rich, with names above units, words aligned left and numbers right."""
    rule = box.SIMPLE_HEAD if breaks_lines(console) else _ASCII_BOX
    rendered = rich_table.Table(box=rule, pad_edge=False, show_edge=False, padding=(0, 1))
    lines = max(column.name.count("\n") for column in table.columns)
    for column in table.columns:
        name = column.name
        if column.unit:
            name += "\n" * (1 + lines - name.count("\n")) + column.unit
        rendered.add_column(name, justify="left" if column.words else "right", overflow="fold")
    for row in table.rows:
        cells = (
            Text(cell.text, style=STYLES[cell.tone]) if isinstance(cell, Toned) else Text(cell)
            for cell in row
        )
        rendered.add_row(*cells)
    return rendered


def _narrowed(table: CellTable, excess: int) -> CellTable:
    """Table that is narrower by so many characters: the widest texts are wrapped between words."""
    widths = {}
    for index, column in enumerate(table.columns):
        texts = [*column.name.split("\n"), *(cell_text(row[index]) for row in table.rows)]
        if column.words:
            widths[index] = max(map(len, texts))
    for _ in range(excess if widths else 0):
        widest = max(widths, key=widths.__getitem__)
        widths[widest] = max(widths[widest] - 1, _NARROWEST_COLUMN)
    rows = []
    for row in table.rows:
        cells = list(row)
        for index, width in widths.items():
            text = cell_text(row[index])
            # A cell of several lines, such as a plot, is left as it is.
            if len(text) > width and "\n" not in text:
                lines, cell = wrapped(text, width), row[index]
                cells[index] = replace(cell, text=lines) if isinstance(cell, Toned) else lines
        rows.append(tuple(cells))
    return replace(table, rows=tuple(rows))


def _width(console: Console, rendered: rich_table.Table) -> int:
    """Width without line breaks [characters]."""
    return console.measure(rendered, options=console.options.update(max_width=sys.maxsize)).maximum


def files_written(
    console: Console, folder: str, files: Iterable[str], design_content: str = ""
) -> None:
    """Print the files written to a folder, by subfolder.

    `design_content` says what its design.json contains; empty if it has none.
    """
    heading(console, f"Written to {folder}/")
    rows = []
    if design_content:
        rows.append((DESIGN_FILE, f"{design_content}, and the hashes of the other files"))
    if (Path(folder) / REPORT_FILE).is_file():
        rows.append((REPORT_FILE, "the whole report to read, mail and sign: open it in a browser"))
    folders: dict[str, list[str]] = {}
    for name in files:
        if name != REPORT_FILE:
            folder_name, _, file = name.rpartition("/")
            folders.setdefault(folder_name, []).append(file)
    for name, names in sorted(folders.items()):
        entry = "  ".join(names) if len(names) <= MOST_LISTED else f"{len(names)} files"
        rows.append((f"{name or '.'}/", entry))
    facts(console, rows)
