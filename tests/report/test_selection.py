"""The selection of a motor in reports, also with the longest names of the catalogues."""

import io
import re
from dataclasses import replace

import pytest
from rich.console import Console
from stories import design

from ocs_design.device.records.requirement import ManeuverRecord
from ocs_design.device.records.selection import (
    CoDesignRecord,
    PriceRecord,
    RankedRecord,
    RejectionRecord,
    SelectionRecord,
    TaskDemand,
)
from ocs_design.report.limits import saving_notes, saving_table
from ocs_design.report.selection import rejection_details, task_note
from ocs_design.report.text.size import print_selection

LONGEST = ("Antigravity MN6007 II KV320", "GT3 5 mm x 15 mm 18:48", "tungsten-alloy-class-4")


def ranked(motor, gear, material, mass):
    return RankedRecord(
        motor=motor, gear=gear, gear_ratio=1.0, material=material, incidence=0.1543, mass=mass,
        wheels_mass=0.4 * mass, motors_mass=0.4 * mass, gears_mass=0.0, housings_mass=0.2 * mass,
        spin_inertia=5e-5, outer_radius=0.0413, height=0.0031,
    )  # fmt: skip


RANKING = (
    ranked("AT2814 KV1200", "direct", "tungsten-alloy-class-4", 0.3367),
    ranked("AT2814 KV1050", "direct", "tungsten-alloy-class-4", 0.3412),
    ranked("AT2814 KV1200", "direct", "stainless-304", 0.3413),
    ranked("AT2814 KV1200", "GT3 2 mm x 6 mm 24:36", "stainless-304", 0.3414),
    ranked("AT2814 KV1050", "direct", "steel-a36", 0.3415),
)
TASKS = (
    TaskDemand("drop", 0.154, 4.964e-5, 0.385, 0.385, 1615.8, 0.4),
    TaskDemand("rate change, pitch", 0.154, 4.1e-5, None, None, 1615.8, None),
)
REJECTIONS = tuple(
    RejectionRecord(motor=f"motor {i}", reason=reason, detail=f"detail {i}")
    for i, reason in enumerate(("torque", "heavier", "torque"))
)
SELECTION = SelectionRecord(
    bus_voltage=24.0, reserve=0.95, candidates=2_952_000, binding_maneuver="drop",
    binding=("r_max",), tasks=TASKS, ranking=RANKING, rejections=REJECTIONS, co_design=None,
)  # fmt: skip


def printed(selection=SELECTION, width=80):
    file = io.StringIO()
    console = Console(file=file, width=width, color_system=None, highlight=False)
    print_selection(console, selection)
    return [line.rstrip() for line in file.getvalue().splitlines()]


def drive_rows(lines):
    """Rows of the table of drives as cells."""
    start = next(i for i, line in enumerate(lines) if line.lstrip().startswith("lightest drives"))
    end = next(i for i, line in enumerate(lines) if "ruled out" in line)
    return [re.split(r"\s{2,}", line.strip()) for line in lines[start + 2 : end]]


@pytest.mark.parametrize(("width", "shown"), [(60, 2), (80, 3), (110, 6)])
def test_each_drive_is_one_line_with_its_lightest_rim(width, shown):
    lines, sizes = printed(width=width), ["41.3", "3.1", "8.8"]
    assert max(map(len, lines)) <= width
    expected = [
        ["AT2814 KV1200", "336.7", "tungsten-alloy-class-4", *sizes],
        ["AT2814 KV1050", "341.2", "tungsten-alloy-class-4", *sizes],
        ["AT2814 KV1200, GT3 2 mm x 6 mm 24:36", "341.4", "stainless-304", *sizes],
    ]
    rows = drive_rows(lines)
    assert [row[:shown] for row in rows] == [row[:shown] for row in expected]


def test_the_longest_names_are_not_abbreviated():
    long = replace(SELECTION, ranking=(ranked(*LONGEST, 12.3456), *RANKING))
    for width in (80, 110):
        rows = drive_rows(printed(long, width))
        assert rows[0][:2] == ["Antigravity MN6007 II KV320, GT3 5 mm x 15 mm 18:48", "12345.6"]
        assert len(rows) == 4


def test_rejections_are_counted_in_text_and_listed_in_the_report():
    assert "  3 motors ruled out: torque (2), heavier (1)." in printed()
    assert not any("detail" in line for line in printed())
    assert rejection_details(SELECTION) == tuple(f"motor {i}: detail {i}" for i in range(3))


def test_a_task_without_time_has_none():
    (row,) = (line for line in printed() if "rate change, pitch" in line)
    assert row.split()[-3:] == ["-", "-", "15,430"]


def test_a_co_design_reports_its_saving():
    co_design = CoDesignRecord(
        adopted=True, status="Solve_Succeeded", iterations=41, mass=0.330, selected_mass=0.3367,
        violation=2e-7, remark="The co-designed device is taken.",
    )  # fmt: skip
    text = " ".join(printed(replace(SELECTION, co_design=co_design)))
    assert "330.0 g against 336.7 g (-1.99%)" in text
    assert "2.0e-07 (relative), on a grid ten times finer" in text
    assert "The co-designed device is taken." in text


def test_shadow_prices_are_changes_with_their_savings():
    prices = (
        PriceRecord(limit="r_max", value=0.05, changed=0.051, mass_change=-0.01486),
        PriceRecord(limit="h_max", value=0.01, changed=0.011, mass_change=0.0),
        PriceRecord(limit="time", value=1.0, changed=1.01, mass_change=-0.0312),
    )
    priced = replace(design(), selection=replace(SELECTION, prices=prices))
    assert saving_table(priced).rows == (
        ("r_max", "50 to 51 mm", "14.86 g"),
        ("h_max", "10 to 11 mm", "nothing"),
        ("time for every maneuver", "+1%", "31.20 g"),
    )
    assert "AT2814 KV1050, is 4.5 g heavier" in saving_notes(priced)


def test_a_note_explains_the_times_on_a_pivot():
    notes = []
    for parameters in ({}, {"pivot": (0.0, 0.0, -0.2)}):
        maneuver = ManeuverRecord(
            kind="any", name="it", gravity=9.81, incidence=None, parameters=parameters
        )
        notes.append(task_note(SELECTION, [maneuver]))
    assert ["On a pivot both times" in note for note in notes] == [False, True]
