"""Margins as people read them."""

import io

import pytest
from rich.console import Console

from ocs_design.report.limits import margin_notes, margin_table
from ocs_design.report.quantities import quantity
from ocs_design.report.table import Toned
from ocs_design.report.text.layout import items, show
from ocs_design.sizing.margins import Margin

MARGINS = (
    Margin("motor torque", 0.4, 1.0, "N m", "", "drop"),
    Margin("rms current", 10.84, 3.469, "A", "a pause of 8.8 s cools it", "drop"),
    Margin("stored energy", 8.14, None, "J", "both wheels", "back-flip"),
)


def test_each_margin_is_a_row_and_each_note_a_line():
    file = io.StringIO()
    console = Console(file=file, width=80, color_system=None)
    show(console, margin_table(MARGINS))
    items(console, margin_notes(MARGINS))
    rows = file.getvalue().splitlines()
    table = [" ".join(row.split()) for row in rows]
    assert "motor torque 0.4 N m 1 N m 2.50 drop" in table
    assert "stored energy 8.14 J - - back-flip" in table
    assert any("rms current: a pause of 8.8 s cools it" in row for row in rows)
    assert max(map(len, rows)) <= 80


def test_units_of_the_bench():
    assert quantity(750.0, "rad/s") == "7,162 rpm"
    assert quantity(2.15e8, "Pa") == "215.0 MPa"
    assert quantity(0.873, "") == "87%"
    assert quantity(0.0123, "N m") == "0.0123 N m"


@pytest.mark.parametrize(
    ("factor", "shown"), [(0.996, "0.99"), (1.0 - 1e-9, "1.00"), (1.029, "1.02")]
)
def test_a_limit_that_is_exceeded_is_not_told_as_kept(factor, shown):
    margin = Margin("torque", 1.0, factor, "N m", "", "drop")
    ((_, _, _, cell, _),) = margin_table((margin,)).rows
    assert (cell.text if isinstance(cell, Toned) else cell) == shown
