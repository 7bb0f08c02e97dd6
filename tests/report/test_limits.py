"""Margins, demands and alternatives in reports."""

import io
from dataclasses import replace

import pytest
from rich.console import Console
from stories import design

from ocs_design.common.wording import quantity
from ocs_design.device.records.flights import Margin
from ocs_design.device.records.selection import Alternative
from ocs_design.report.limits import (
    LIMIT_MEANINGS,
    active_limit_names,
    alternatives_table,
    assumption_rows,
    demand_table,
    margin_notes,
    margin_table,
    pause_remark,
    saving_changes,
    useless_changes_note,
    utilizations,
)
from ocs_design.report.table import cell_text
from ocs_design.report.text.layout import items, show
from ocs_design.report.text.size import print_solution
from ocs_design.sizing import lightest_module

MARGINS = (
    Margin("motor torque", 0.4, 1.0, "N m", scenario="drop"),
    Margin("rms current", 10.84, 3.469, "A", note="a pause of 8.8 s cools it", scenario="drop"),
    Margin("stored energy", 8.14, None, "J", note="both wheels", scenario="back-flip"),
)


def test_every_limit_without_a_key_is_explained():
    """The limits of a module by their names in the sizing."""
    constants = vars(lightest_module).items()
    names = {value for name, value in constants if name.isupper() and isinstance(value, str)}
    assert names == set(LIMIT_MEANINGS)


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


def test_demands_are_in_practical_units():
    sized = design()
    for demand, row in zip(sized.requirement.demands, demand_table(sized).rows, strict=True):
        shown = [float(cell) for cell in row[2:5]]
        exact = [1e3 * demand.roll_momentum, 1e3 * demand.pitch_momentum, 1e6 * demand.spin_inertia]
        assert row[0] == demand.source
        assert shown == pytest.approx(exact, rel=1e-3, abs=0.06)
    assert any(demand.roll_momentum > 1e-3 for demand in sized.requirement.demands)


def test_limits_without_a_key_are_named_in_words():
    sized = design()
    limited = replace(sized, sizing=replace(sized.sizing, binding=("r_max", "hoop_stress", "hub")))
    assert active_limit_names(limited) == ["r_max", "hoop stress", "hub"]


def test_quantities_are_in_practical_units():
    assert quantity(750.0, "rad/s") == "7,162 rpm"
    assert quantity(2.15e8, "Pa") == "215.0 MPa"
    assert quantity(0.873, "") == "87%"
    assert quantity(0.0123, "N m") == "0.0123 N m"


@pytest.mark.parametrize(
    ("factor", "shown"), [(0.996, "0.99"), (1.0 - 1e-9, "1.00"), (1.029, "1.02")]
)
def test_margins_are_rounded_down(factor, shown):
    margin = Margin("torque", 1.0, factor, "N m", scenario="drop")
    ((_, _, _, cell, _),) = margin_table((margin,)).rows
    assert cell_text(cell) == shown


def test_the_tightest_limits_come_first_with_equal_ones_together():
    margins = (
        Margin("power", 0.68, 1.0, "", scenario="flip", note="of the battery"),
        Margin("rms current", 2.4, 1.0, "", scenario="drop", note="a pause cools it"),
        Margin("torque", 0.999, 1.0, "", scenario="flip"),
        Margin("voltage", 0.998, 1.0, "", scenario="flip"),
        Margin("heat", 3.0, None, "", scenario="flip", note="not known"),
        Margin("height", 0.5, 1.0, ""),
    )
    sized = replace(design(), margins=margins)
    # A continuous rating with a pause is not an exceeded limit.
    assert pause_remark(sized) == "240% rms in drop (continuous rating 100%), a pause cools it"
    assert utilizations(sized) == (
        ("100%", "torque and voltage (flip)"),
        (" 68%", "power (flip)"),
        (" 50%", "height"),
    )


def test_only_assumptions_that_users_change_are_listed():
    listed = "Maneuvers: the paper's three.", "drop: falls from 1 m.", "Supply: 24 V.", "Edges: x."
    assert assumption_rows(listed) == (("drop", "falls from 1 m"), ("supply", "24 V"))


def test_alternatives_are_sorted_by_their_savings():
    sized = design()
    current, motor = sized.ocs.mass_total, sized.ocs.motor.name
    changes = tuple(
        Alternative(change=change, mass_total=mass, motor=name, note=note)
        for change, mass, name, note in (
            ("nothing", current, motor, "saves nothing"),
            ("more time", current - 0.01, "Other", ""),
            ("no device", None, "", ""),
            ("any material", current - 0.02, motor, "titanium"),
        )
    )
    with_changes = replace(sized, alternatives=changes)
    assert saving_changes(with_changes) == (
        ("-20.0 g", "any material; titanium"),
        ("-10.0 g", "more time; Other"),
    )
    assert [row[0] for row in alternatives_table(with_changes).rows] == [
        "more time", "no device", "any material"
    ]  # fmt: skip
    assert useless_changes_note(with_changes) == "These save nothing: nothing."


def test_a_price_says_that_it_is_of_one_module():
    """Below an objective of the whole device, 22 g per mm read like half of what a mm saves."""
    original = design()
    sizing = replace(original.sizing, binding=("r_max",), shadow_prices={"r_max": -20.0})
    console = Console(file=io.StringIO(), width=80)
    print_solution(console, replace(original, sizing=sizing))
    assert original.selection is not None
    assert "-20.00 g per mm more, each module" in console.file.getvalue()
