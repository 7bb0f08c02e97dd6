"""Margins in the terminal."""

from collections.abc import Iterable

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ocs_design.report.layout import columns, heading, items, show
from ocs_design.report.quantities import degrees, grams, megapascals, millimetres, rpm
from ocs_design.sizing.margins.margin import Margin
from ocs_design.units import floored

COLUMNS = ("quantity", "demand", "capacity", "factor", "set by")

_SHOWN = {"rad/s": rpm, "Pa": megapascals, "m": millimetres, "kg": grams, "rad": degrees}


def print_margins(console: Console, margins: Iterable[Margin]) -> None:
    """Demand, capacity and factor of each, the maneuver that sets it, and notes below."""
    found = tuple(margins)
    heading(console, "Margins: the worst over all maneuvers")
    show(console, _table(found))
    items(console, (f"{margin.name}: {margin.note}" for margin in found if margin.note))


def _table(margins: Iterable[Margin]) -> Table:
    table = columns(*COLUMNS)
    table.columns[-1].justify = "left"
    for margin in margins:
        name, demand, capacity, factor, maneuver = margin_cells(margin)
        styled = Text(factor, style=_style(margin.factor))
        table.add_row(Text(name), demand, capacity, styled, Text(maneuver))
    return table


def margin_cells(margin: Margin) -> tuple[str, str, str, str, str]:
    """Name, demand, capacity, factor, and the maneuver that sets it."""
    factor = margin.factor
    return (
        margin.name,
        quantity(margin.demand, margin.unit),
        "-" if margin.capacity is None else quantity(margin.capacity, margin.unit),
        "-" if factor is None else floored(factor, 2),
        margin.maneuver,
    )


def quantity(value: float, unit: str) -> str:
    """A figure of a margin as people read it; a plain share in per cent."""
    if not unit:
        return f"{value:.0%}"
    return _SHOWN[unit](value) if unit in _SHOWN else f"{value:.3g} {unit}"


def _style(factor: float | None) -> str:
    return "" if factor is None or factor >= 1.0 else "yellow"
