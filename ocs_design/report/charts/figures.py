"""All figures of a report: on the design, its drive and each maneuver."""

from collections.abc import Iterator, Mapping

from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.flights import distribution_charts, drive_charts, time_charts
from ocs_design.report.charts.front import reserve_charts
from ocs_design.report.charts.momentum import bound_charts, incidence_charts
from ocs_design.report.story import RecordedFlight, Story

FOLDER = "figures"
"""Subfolder of an output folder for the figures."""


def scenario_charts(story: Story) -> Mapping[str, tuple[Chart, ...]]:
    """Time series of each maneuver, by name."""
    flights: dict[str, list[RecordedFlight]] = {}
    for flight in story.flights:
        flights.setdefault(flight.record.scenario, []).append(flight)
    return {scenario: tuple(time_charts(scenario, own)) for scenario, own in flights.items()}


def all_charts(story: Story) -> Iterator[Chart]:
    """All charts that are written as files."""
    yield from bound_charts(story)
    yield from incidence_charts(story)
    yield from drive_charts(story.design.ocs.motor, story.flights)
    yield from reserve_charts(story.design.selection)
    for charts in scenario_charts(story).values():
        yield from charts
    if story.monte_carlo is not None:
        yield from distribution_charts(story.monte_carlo, story.pivots)
