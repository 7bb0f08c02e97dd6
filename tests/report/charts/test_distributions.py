from dataclasses import replace

import numpy as np
from stories import story

from ocs_design.device.answers import QUANTILES, MonteCarloRecord, ScenarioSummary, Spread
from ocs_design.monte_carlo.summary import share
from ocs_design.report.charts.chart import Area, Rule
from ocs_design.report.charts.flights import distribution_charts
from ocs_design.report.html.sections import monte_carlo_section

VALUES = np.radians(np.random.default_rng(1).gamma(2.0, 0.5, 500))


def spread(values):
    counts, _ = np.histogram(values, bins=12)
    return Spread(quantiles=tuple(np.quantile(values, QUANTILES)), counts=tuple(counts.tolist()))


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
    (area,) = [mark for mark in chart.marks if isinstance(mark, Area)]
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


def test_the_section_is_there_only_if_samples_were_flown():
    assert monte_carlo_section(story()) == ""
    section = monte_carlo_section(replace(story(), monte_carlo=record(VALUES)))
    for text in ("500 robots", "99.8 %", "torque delay", "5 ms"):
        assert text in section


def test_advice_is_told_where_there_is_any():
    plain = record(VALUES)
    advised = replace(plain.scenarios[0], advice="turn the modules")
    section = monte_carlo_section(
        replace(story(), monte_carlo=replace(plain, scenarios=(advised,)))
    )
    assert "drop: turn the modules." in section
    assert "drop: ." not in monte_carlo_section(replace(story(), monte_carlo=plain))
