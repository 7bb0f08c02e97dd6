"""Layout of what people read: headings, facts, tables, notes and lists of files."""

import re
import sys
import textwrap
from collections.abc import Iterable
from pathlib import Path

from rich import box
from rich import table as rich_table
from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from ocs_design.export.folder import DESIGN_FILE, REPORT_FILE
from ocs_design.report.table import Cell, Table, Tone, Toned

INDENT = (0, 0, 0, 2)

MOST_LISTED = 6
"""Files of one folder that are named; more are counted."""

STYLES = {Tone.PLAIN: "dim", Tone.PASS: "green", Tone.FAIL: "bold red", Tone.OPEN: "yellow"}


def heading(console: Console, text: str) -> None:
    """Title of a section."""
    console.print()
    console.print(Text(text, style="bold"))


_UNITS = "mm|um|m|kg|g|N|s|ms|deg|rad|rpm|V|A|W|kW|J|MPa|ohm|Hz"
_TIED = re.compile(rf"(?<=\d) (?=(?:{_UNITS})\b)|(?<=\bN) (?=m\b)|(?<=\bkg) (?=m+2\b)")
"""Spaces between a number and its unit, and within a unit."""


def wrapped(text: str, width: int) -> str:
    """Lines of a text, none of which ends between a number and its unit."""
    tied = _TIED.sub("\N{NO-BREAK SPACE}", text)
    lines = textwrap.wrap(tied, width, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")


def note(console: Console, text: str, *, style: str = "dim") -> None:
    """A paragraph, indented like everything under a heading."""
    lines = wrapped(text, console.width - INDENT[-1])
    console.print(Padding(Text(lines, style=style), INDENT))


def warn(console: Console, warnings: Iterable[str]) -> None:
    """Warnings, one line each."""
    for warning in warnings:
        note(console, f"warning: {warning}", style="yellow")


def items(console: Console, texts: Iterable[str], *, style: str = "dim") -> None:
    """A list; what wraps stays indented behind its dash."""
    found = list(texts)
    if not found:
        return
    grid = rich_table.Table.grid(padding=(0, 1))
    for text in found:
        lines = wrapped(text, console.width - len("  - "))
        grid.add_row(Text("  -", style=style), Text(lines, style=style))
    console.print(grid)


def facts(console: Console, rows: Iterable[tuple[str, str]]) -> None:
    """Names and values in two columns."""
    grid = rich_table.Table.grid(padding=(0, 2))
    grid.add_column(no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in rows:
        grid.add_row(Text(f"  {name}", style="dim"), Text(value))
    console.print(grid)


def show(console: Console, table: Table, *, fewest: int = 0) -> None:
    """A table, indented like everything under a heading; closer where it would break a line.

    Args:
        console: to print on.
        table: to show.
        fewest: columns that are always shown; the last ones are left out where the terminal is too
            narrow for all. 0: all are shown, and long cells are broken.
    """
    for count in range(len(table.columns), (fewest or len(table.columns)) - 1, -1):
        drawn = _drawn(table.first(count))
        if not _fits(console, drawn):
            drawn.padding = (0, 1, 0, 0)
        if _fits(console, drawn):
            break
    console.print(Padding(drawn, INDENT))


def _drawn(table: Table) -> rich_table.Table:
    """Table of rich: names over units, words at the left, numbers at the right."""
    drawn = rich_table.Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1))
    lines = max(column.name.count("\n") for column in table.columns)
    for column in table.columns:
        name = column.name
        if column.unit:
            name += "\n" * (1 + lines - name.count("\n")) + column.unit
        drawn.add_column(name, justify="left" if column.words else "right", overflow="fold")
    for row in table.rows:
        drawn.add_row(*map(cell_text, row))
    return drawn


def cell_text(cell: Cell) -> Text:
    """Text of a cell in the colour of its tone."""
    return Text(cell.text, style=STYLES[cell.tone]) if isinstance(cell, Toned) else Text(cell)


def _fits(console: Console, drawn: rich_table.Table) -> bool:
    whole = console.options.update(max_width=sys.maxsize)
    return console.measure(drawn, options=whole).maximum <= console.width - INDENT[-1]


def files_written(console: Console, folder: str, files: Iterable[str], held: str = "") -> None:
    """Files that a folder got, by the folders in it.

    Args:
        console: to print on.
        folder: that it was written to.
        files: paths in that folder, without a design.json.
        held: what its design.json holds; empty: it has none.
    """
    heading(console, f"Written to {folder}/")
    rows = [(DESIGN_FILE, f"{held}, and the hashes of the other files")] if held else []
    if (Path(folder) / REPORT_FILE).is_file():
        rows.append((REPORT_FILE, "everything to look at, to mail and to sign: for a browser"))
    folders: dict[str, list[str]] = {}
    for name in files:
        if name != REPORT_FILE:
            folder_name, _, file = name.rpartition("/")
            folders.setdefault(folder_name, []).append(file)
    for name, names in sorted(folders.items()):
        listed = "  ".join(names) if len(names) <= MOST_LISTED else f"{len(names)} files"
        rows.append((f"{name or '.'}/", listed))
    facts(console, rows)
