"""All figures of a report: of the design, of its drive, of each maneuver."""

from collections.abc import Iterator, Mapping

from ocs_design.report.charts.chart import Chart
from ocs_design.report.figures.bound import bound_charts
from ocs_design.report.figures.distributions import distribution_charts
from ocs_design.report.figures.incidence import criterion_chart, posture_chart
from ocs_design.report.figures.time_series import time_charts
from ocs_design.report.figures.top_view import ellipsoid_chart, momentum_chart
from ocs_design.report.figures.torque_speed import torque_speed_chart
from ocs_design.report.story import Story
from ocs_design.text_files import safe_name

FOLDER = "figures"
"""Of an output folder."""


def plane_charts(story: Story) -> Iterator[Chart]:
    """What lies in the plane of the wheel axes."""
    yield ellipsoid_chart(story.design)
    yield momentum_chart(story)


def incidence_charts(story: Story) -> Iterator[Chart]:
    """How the wheel axes could stand."""
    yield criterion_chart(story.design)
    if story.postures:
        yield posture_chart(story.design, story.postures)


def drive_charts(story: Story) -> Iterator[Chart]:
    """What the motors are asked for."""
    chart = torque_speed_chart(story.design.ocs.motor, story.flights)
    if chart is not None:
        yield chart


def scenario_charts(story: Story) -> Mapping[str, tuple[Chart, ...]]:
    """Time series of each maneuver, by its name."""
    scenarios = dict.fromkeys(flight.scenario for flight in story.flights)
    return {
        scenario: time_charts(
            scenario,
            safe_name(scenario),
            [flight for flight in story.flights if flight.scenario == scenario],
        )
        for scenario in scenarios
    }


def all_charts(story: Story) -> Iterator[Chart]:
    """Everything that has a file of its own."""
    yield from bound_charts(story)
    yield from plane_charts(story)
    yield from incidence_charts(story)
    yield from drive_charts(story)
    for charts in scenario_charts(story).values():
        yield from charts
    if story.monte_carlo is not None:
        yield from distribution_charts(story.monte_carlo)
