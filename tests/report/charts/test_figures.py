"""Contents of the figures against independent calculations."""

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
from ocs_design.report.charts.momentum import bound_charts, maneuver_momenta, posture_chart
from ocs_design.report.charts.svg import inline_svg, write_svgs
from ocs_design.report.html.sections import monte_carlo_section
from ocs_design.report.limits import reserve_note

RPM = 30.0 / np.pi


@pytest.mark.slow
def test_the_momentum_is_that_of_both_wheels_up_to_touchdown():
    (momentum,) = maneuver_momenta(story())
    alpha, spin = design().ocs.incidence, design().ocs.spin_inertia
    assert momentum.largest(0) == pytest.approx(spin * np.sin(alpha) * 100.0, rel=1e-4)
    assert momentum.largest(1) == pytest.approx(spin * np.cos(alpha) * 500.0, rel=1e-4)


def test_the_momentum_of_a_device_with_a_motor_needs_flights():
    assert maneuver_momenta(replace(story(), flights=())) == ()
    assert maneuver_momenta(replace(story(motor="none"), flights=()))


def test_the_point_of_a_device_lies_on_its_bound():
    """The bound is the inertia that the device has, at one and the same wheel speed."""
    unmotorized = story(motor="none")
    fastest = 250.0
    demand = replace(unmotorized.design.requirement, wheel_speed_max=fastest)
    unmotorized = replace(unmotorized, design=replace(unmotorized.design, requirement=demand))
    chart = next(bound_charts(unmotorized))
    (bound,) = [mark for mark in chart.marks if isinstance(mark, Curve) and not mark.dashed]
    (point,) = [mark for mark in chart.marks if isinstance(mark, Points)]
    total, robot = (
        m[1][1] for m in (unmotorized.design.ocs.total_inertia, unmotorized.design.robot.inertia)
    )
    # For a momentum L the bound of the robot alone is I_r d / (gamma - d) with d = L / I_tot.
    expected = robot * point.x[0] / (fastest - point.x[0])
    assert np.interp(point.x[0], bound.x, bound.y) == pytest.approx(expected, rel=1e-3)
    assert point.y[0] == pytest.approx(total * point.x[0] / fastest, rel=1e-3)


def test_mass_is_drawn_against_the_number_of_robots_per_failure():
    """The curve is flat within the reserve of the nominal device, else of the recorded masses."""
    reserved = story()
    (chart,) = reserve_charts(reserved.design.selection)
    (points,) = [mark for mark in chart.marks if isinstance(mark, Points)]
    np.testing.assert_allclose(points.x, [2.0, 5.0, 10.0, 20.0, 100.0, 1000.0])
    np.testing.assert_allclose(points.y, 1e3 * np.array(reserved.design.selection.kept.curve)[:, 1])
    assert points.labels[-2:] == ("99 %", "99.9 %")
    assert np.all(np.diff(points.y) >= 0.0)
    flat = replace(reserved.design.selection.kept, curve=((0.5, 0.5), (0.999, 0.5)))
    (chart,) = reserve_charts(replace(reserved.design.selection, kept=flat))
    (line,) = [mark for mark in chart.marks if isinstance(mark, Curve)]
    assert line.y.tolist() == [500.0, 500.0]
    assert "No extra mass up to 99.9 %" in reserve_note(flat, 0.5)
    assert not list(reserve_charts(story(motor="none").design.selection))


def test_the_torque_speed_plane_has_the_range_of_the_drive():
    motor = design().ocs.motor
    (chart,) = drive_charts(motor, [flight()])
    (edge,) = [mark for mark in chart.marks if getattr(mark, "name", "") == "range of the drive"]
    speed_max = motor.speed_max * RPM
    assert np.abs(edge.x).max() == pytest.approx(speed_max)
    forwards = (edge.y >= 0.0) & (edge.x >= 0.0)
    line = motor.stall_torque * (1.0 - edge.x / RPM / motor.no_load_speed)
    expected = np.minimum(motor.torque_limit, np.maximum(line, 0.0))
    np.testing.assert_allclose(edge.y[forwards], expected[forwards], atol=1e-12)


def test_paths_in_the_plane_end_at_touchdown():
    (chart,) = drive_charts(design().ocs.motor, [flight(), flight(ocs=False)])
    paths = [mark for mark in chart.marks if isinstance(mark, Curve) and mark.ink is not Ink.FAINT]
    time = flight().time
    assert [len(path.x) for path in paths] == [np.count_nonzero(time < TOUCHDOWN)] * 2
    assert not list(drive_charts(design().ocs.motor, [flight(ocs=False)]))


def test_wheels_at_rest_have_a_plane_too():
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
    assert chart.y.fractions(np.array([0.0]))[0] > chart.y.fractions(np.array([1.0]))[0]


@pytest.mark.parametrize("motor", ["none", "EC 45 flat 70 W 411812"])
def test_every_figure_is_an_svg_file_with_units_on_its_axes(tmp_path, motor):
    write_svgs(tuple(all_charts(story(motor=motor))), tmp_path)
    files = sorted(tmp_path.iterdir())
    names = {path.stem for path in files}
    assert {"bound_pitch", "inertia_ellipsoid", "momentum", "torque_speed", "tilt_drop"} <= names
    for path in files:
        texts = [
            element.text for element in ET.parse(path).iter("{http://www.w3.org/2000/svg}text")
        ]
        assert any(text.endswith("]") for text in texts)


VALUES = np.radians(np.random.default_rng(1).gamma(2.0, 0.5, 500))


def histogram(values):
    counts, _ = np.histogram(values, bins=12)
    return Histogram(quantiles=tuple(np.quantile(values, QUANTILES)), counts=tuple(counts.tolist()))


def record(values):
    scenario = ScenarioSummary(
        scenario="drop", success=share(499, 500), faults={}, attitude_error=histogram(values),
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
    (landing,), (on_pivot,) = (
        distribution_charts(record(VALUES), pivoted) for pivoted in ((), ("drop",))
    )
    assert "touchdown" in landing.title
    assert "touchdown" not in on_pivot.title + on_pivot.description


def test_equal_flights_have_a_bin_too():
    (chart,) = distribution_charts(record(np.zeros(5)))
    assert chart.x.low < 0.0 < chart.x.high


def test_the_section_of_samples_has_advice_where_there_is_any():
    assert monte_carlo_section(story()) == ""
    campaign = record(VALUES)
    section = monte_carlo_section(replace(story(), monte_carlo=campaign))
    for text in ("500 sampled robots", "99.8 %", "torque delay", "5 ms"):
        assert text in section
    assert "drop: ." not in section
    advised = replace(
        campaign, scenarios=(replace(campaign.scenarios[0], advice="turn the modules"),)
    )
    section = monte_carlo_section(replace(story(), monte_carlo=advised))
    assert "drop: turn the modules." in section
