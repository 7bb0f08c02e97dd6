"""How everything that people read is laid out: headings, facts, tables and notes."""

import sys
from collections.abc import Iterable, Sequence

from rich import box
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

INDENT = (0, 0, 0, 2)


def print_warnings(console: Console, warnings: Sequence[str]) -> None:
    """One line each."""
    for warning in warnings:
        note(console, f"warning: {warning}", style="yellow")


def heading(console: Console, text: str) -> None:
    """A section of the report."""
    console.print()
    console.print(Text(text, style="bold"))


def note(console: Console, text: str, *, style: str = "dim") -> None:
    """A paragraph, indented like everything under a heading."""
    console.print(Padding(Text(text, style=style), INDENT))


def items(console: Console, texts: Iterable[str], *, style: str = "dim") -> None:
    """A list; what wraps stays indented behind its dash."""
    table = Table.grid(padding=(0, 1))
    for text in texts:
        table.add_row(Text("  -", style=style), Text(text, style=style))
    console.print(table)


def facts(console: Console, rows: Iterable[tuple[str, str]]) -> None:
    """Names and values in two columns."""
    table = Table.grid(padding=(0, 2))
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in rows:
        table.add_row(Text(f"  {name}", style="dim"), Text(value))
    console.print(table)


def columns(*names: str, left: int = 1) -> Table:
    """An empty table: the first `left` columns are text, the others numbers."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1))
    for index, name in enumerate(names):
        table.add_column(name, justify="left" if index < left else "right", overflow="fold")
    return table


def fits(console: Console, table: Table) -> bool:
    """Whether a table can be shown without breaking a line, its columns closer if need be."""
    if not _has_room(console, table):
        table.padding = (0, 1, 0, 0)
    return _has_room(console, table)


def _has_room(console: Console, table: Table) -> bool:
    whole = console.options.update(max_width=sys.maxsize)
    return console.measure(table, options=whole).maximum <= console.width - INDENT[-1]


def show(console: Console, table: Table) -> None:
    """A table, indented like everything under a heading; closer where it would break a line."""
    fits(console, table)
    console.print(Padding(table, INDENT))
