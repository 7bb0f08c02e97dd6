"""What the figures show, against numpy by hand."""

from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from stories import TOUCHDOWN, design, flight, story

from ocs_design.device.answers import (
    QUANTILES,
    Histogram,
    MonteCarloRecord,
    PostureLine,
    ScenarioSummary,
)
from ocs_design.monte_carlo.outcomes import share
from ocs_design.report.charts.chart import Curve, FilledArea, Ink, Points, Rule
from ocs_design.report.charts.figures import all_charts
from ocs_design.report.charts.flights import distribution_charts, drive_charts
from ocs_design.report.charts.front import reserve_charts
from ocs_design.report.charts.momentum import bound_charts, posture_chart, taken
from ocs_design.report.charts.svg import inline_svg, write_svgs
from ocs_design.report.html.sections import monte_carlo_section
from ocs_design.report.limits import reserve_note

RPM = 30.0 / np.pi


@pytest.mark.slow
def test_the_momentum_taken_is_that_of_both_wheels_up_to_touchdown():
    (found,) = taken(story())
    alpha, spin = design().ocs.incidence, design().ocs.spin_inertia
    assert found.largest(0) == pytest.approx(spin * np.sin(alpha) * 100.0, rel=1e-4)
    assert found.largest(1) == pytest.approx(spin * np.cos(alpha) * 500.0, rel=1e-4)


def test_only_flights_say_what_momentum_a_device_with_a_motor_takes():
    assert taken(replace(story(), flights=())) == ()
    assert taken(replace(story(motor="none"), flights=()))


def test_a_point_lies_on_the_bound_of_the_speed_that_its_wheels_reached():
    """The bound is the inertia that the device has, at one and the same wheel speed."""
    told = story(motor="none")
    fastest = 250.0
    demand = replace(told.design.requirement, wheel_speed_max=fastest)
    told = replace(told, design=replace(told.design, requirement=demand))
    chart = next(bound_charts(told))
    (own,) = [mark for mark in chart.marks if isinstance(mark, Curve) and not mark.dashed]
    (point,) = [mark for mark in chart.marks if isinstance(mark, Points)]
    total, alone = (m[1][1] for m in (told.design.ocs.total_inertia, told.design.robot.inertia))
    # Of a momentum L the bound for the robot alone asks I_r d / (gamma - d) with d = L / I_tot.
    expected = alone * point.x[0] / (fastest - point.x[0])
    assert np.interp(point.x[0], own.x, own.y) == pytest.approx(expected, rel=1e-3)
    assert point.y[0] == pytest.approx(total * point.x[0] / fastest, rel=1e-3)


def test_mass_against_reliability_is_drawn_by_the_robots_of_which_one_may_fail():
    """What the nominal device has to spare is flat; else each step weighs what was recorded."""
    told = story()
    (chart,) = reserve_charts(told.design.selection)
    (points,) = [mark for mark in chart.marks if isinstance(mark, Points)]
    np.testing.assert_allclose(points.x, [2.0, 5.0, 10.0, 20.0, 100.0, 1000.0])
    np.testing.assert_allclose(points.y, 1e3 * np.array(told.design.selection.kept.curve)[:, 1])
    assert points.labels[-2:] == ("99 %", "99.9 %")
    assert np.all(np.diff(points.y) >= 0.0)
    flat = replace(told.design.selection.kept, curve=((0.5, 0.5), (0.999, 0.5)))
    (chart,) = reserve_charts(replace(told.design.selection, kept=flat))
    (line,) = [mark for mark in chart.marks if isinstance(mark, Curve)]
    assert line.y.tolist() == [500.0, 500.0]
    assert "No extra mass up to 99.9 %" in reserve_note(flat, 0.5)
    assert not list(reserve_charts(story(motor="none").design.selection))


def test_the_plane_holds_what_the_drive_can_give():
    motor = design().ocs.motor
    (chart,) = drive_charts(motor, [flight()])
    (edge,) = [mark for mark in chart.marks if getattr(mark, "name", "") == "range of the drive"]
    top = motor.speed_max * RPM
    assert np.abs(edge.x).max() == pytest.approx(top)
    forwards = (edge.y >= 0.0) & (edge.x >= 0.0)
    line = motor.stall_torque * (1.0 - edge.x / RPM / motor.no_load_speed)
    expected = np.minimum(motor.torque_limit, np.maximum(line, 0.0))
    np.testing.assert_allclose(edge.y[forwards], expected[forwards], atol=1e-12)


def test_paths_in_the_plane_end_at_touchdown_and_are_of_wheels_that_flew():
    (chart,) = drive_charts(design().ocs.motor, [flight(), flight(ocs=False)])
    paths = [mark for mark in chart.marks if isinstance(mark, Curve) and mark.ink is not Ink.FAINT]
    time = flight().time
    assert [len(path.x) for path in paths] == [np.count_nonzero(time < TOUCHDOWN)] * 2
    assert not list(drive_charts(design().ocs.motor, [flight(ocs=False)]))


def test_wheels_that_never_turned_have_a_plane_too():
    still = {name: 0.0 * values for name, values in flight().columns.items()}
    still["time_s"] = flight().time
    (chart,) = drive_charts(design().ocs.motor, [replace(flight(), columns=still)])
    assert "<svg" in inline_svg(chart)


def test_postures_are_rows_from_the_top():
    lines = [
        PostureLine(posture=name, inertia_diagonal=(1.0, 2.0, 3.0), incidence=angle)
        for name, angle in (("stand", 0.5), ("zero", 0.6))
    ]
    chart = posture_chart(design(), lines)
    assert chart.rows == ("stand", "zero")
    assert chart.y.parts(np.array([0.0]))[0] > chart.y.parts(np.array([1.0]))[0]


@pytest.mark.parametrize("motor", ["none", "EC 45 flat 70 W 411812"])
def test_every_figure_is_a_file_that_reads_as_svg_with_units_on_its_axes(tmp_path, motor):
    write_svgs(tuple(all_charts(story(motor=motor))), tmp_path)
    files = sorted(tmp_path.iterdir())
    names = {path.stem for path in files}
    assert {"bound_pitch", "inertia_ellipsoid", "momentum", "torque_speed", "tilt_drop"} <= names
    for path in files:
        texts = [each.text for each in ET.parse(path).iter("{http://www.w3.org/2000/svg}text")]
        assert any(text.endswith("]") for text in texts)


VALUES = np.radians(np.random.default_rng(1).gamma(2.0, 0.5, 500))


def spread(values):
    counts, _ = np.histogram(values, bins=12)
    return Histogram(quantiles=tuple(np.quantile(values, QUANTILES)), counts=tuple(counts.tolist()))


def record(values):
    scenario = ScenarioSummary(
        scenario="drop", success=share(499, 500), faults={}, attitude_error=spread(values),
        peak_wheel_speed=None, peak_wheel_torque=None, causes=(), worst=(),
    )  # fmt: skip
    return MonteCarloRecord(
        seed=3, samples=500, asked=500, confidence=0.95, reality={"torque_delay": "0.005"},
        success=share(499, 500), scenarios=(scenario,),
    )  # fmt: skip


def test_the_area_of_a_histogram_is_that_of_its_flights():
    (chart,) = distribution_charts(record(VALUES))
    (area,) = [mark for mark in chart.marks if isinstance(mark, FilledArea)]
    degrees = np.degrees(VALUES)
    assert np.isclose(np.trapezoid(area.y, area.x), 500 * np.ptp(degrees) / 12)
    rules = {mark.label: mark.value for mark in chart.marks if isinstance(mark, Rule)}
    assert np.isclose(rules["median"], np.median(degrees))
    assert np.isclose(rules["allowed"], 5.0)


def test_a_robot_on_a_pivot_never_touches_down():
    (lands,), (stands,) = (distribution_charts(record(VALUES), each) for each in ((), ("drop",)))
    assert "touchdown" in lands.title
    assert "touchdown" not in stands.title + stands.description


def test_flights_that_are_all_alike_have_a_bin_too():
    (chart,) = distribution_charts(record(np.zeros(5)))
    assert chart.x.low < 0.0 < chart.x.high


def test_the_section_is_there_only_if_samples_were_flown_with_advice_where_there_is_any():
    assert monte_carlo_section(story()) == ""
    found = record(VALUES)
    section = monte_carlo_section(replace(story(), monte_carlo=found))
    for text in ("500 sampled robots", "99.8 %", "torque delay", "5 ms"):
        assert text in section
    assert "drop: ." not in section
    advised = replace(found, scenarios=(replace(found.scenarios[0], advice="turn the modules"),))
    section = monte_carlo_section(replace(story(), monte_carlo=advised))
    assert "drop: turn the modules." in section
