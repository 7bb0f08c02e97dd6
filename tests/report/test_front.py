"""A front as people see it: table, plot, reasons; and as files."""

import io
from dataclasses import asdict
from itertools import pairwise

import pytest
from fronts import by_hand, infeasible, make_front
from rich.console import Console

from ocs_design.report.charts.chart import Points
from ocs_design.report.charts.front import COLUMNS, front_chart
from ocs_design.report.text.front import NONE, OWN, print_front

BRAILLE = {chr(code) for code in range(0x2800, 0x2900)}


@pytest.fixture(scope="module")
def front():
    return make_front(by_hand())


def printed(front, width=80, encoding="utf-8"):
    file = io.TextIOWrapper(io.BytesIO(), encoding, errors="replace", write_through=True)
    print_front(Console(file=file, width=width, color_system=None, highlight=False), front)
    return file.buffer.getvalue().decode(encoding)


@pytest.mark.parametrize("width", [60, 80, 110])
def test_nothing_is_wider_than_the_terminal(front, width):
    assert max(map(len, printed(front, width).splitlines())) <= width


def test_the_table_has_every_point(front):
    text = printed(front)
    for point in front.points:
        assert f"{1e3 * point.value:.4g}" in text
        if point.device:
            assert f"{1e3 * point.device.mass:.1f}" in text
    assert "Fast [28]" in text
    assert "the wheels would have to be larger" in text
    assert "The time is that of 'drop'" in text


def test_the_plot_falls_and_marks_what_has_no_device(front):
    rows = [line for line in printed(front).splitlines() if "┤" in line]
    areas = [line.split("┤")[1] for line in rows]
    drawn = [
        [column for column, cell in enumerate(row) if cell in BRAILLE and cell != "⠀"]
        for row in areas
    ]
    filled = [row for row in drawn if row]
    assert len(filled) > 8
    assert all(min(upper) <= min(lower) for upper, lower in pairwise(filled))
    axis = next(line for line in printed(front).splitlines() if "└" in line).split("└")[1]
    assert axis[0] == NONE
    assert axis.rstrip()[1:].count(NONE) == 0
    # The own value is the third of nine: a quarter of the way.
    assert axis.index(OWN) == pytest.approx(len(axis.rstrip()) / 4, abs=1)


def test_a_terminal_without_braille_gets_the_table_alone(front):
    text = printed(front, encoding="ascii")
    assert "┤" not in text
    assert "Mass of the device against" not in text
    assert "stainless-304" in text


def test_a_front_without_any_device_says_why():
    def never(task):
        raise infeasible("not even [red] wheels")

    text = printed(make_front(by_hand(), choose=never, points=2))
    assert text.count("not even [red] wheels") == 2


def test_the_figure_has_a_point_for_each_device_in_the_colour_of_its_drive(front):
    points = {mark.name: mark for mark in front_chart(front).marks if isinstance(mark, Points)}
    of_fast = [1e3 * p.device.mass for p in front.feasible if p.device.motor == "Fast [28]"]
    assert points["Fast [28], direct"].y.tolist() == of_fast
    assert len(points["no device"].x) == len(front.points) - len(front.feasible)
    assert len({mark.ink for mark in points.values()}) == len(points)


def test_every_field_of_a_device_has_its_column(front):
    assert list(COLUMNS) == list(asdict(front.points[-1].device))
