"""How the figures of many flights are spread, none quite as designed."""

from collections.abc import Iterator

import numpy as np

from ocs_design.monte_carlo.summary import MonteCarloRecord, ScenarioSummary, Spread
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import Area, Ink, Line, Mark, Rule
from ocs_design.report.charts.scales import Axis
from ocs_design.report.figures.amounts import in_unit
from ocs_design.simulation.verdict import LANDING_TOLERANCE
from ocs_design.text_files import safe_name

_HEIGHT = 200.0


def distribution_charts(record: MonteCarloRecord) -> Iterator[Chart]:
    """Attitude at touchdown, peak speed and peak torque of each scenario."""
    for scenario in record.scenarios:
        yield from _of_scenario(scenario)


def _of_scenario(scenario: ScenarioSummary) -> Iterator[Chart]:
    spreads = (
        ("off_level", "off level at touchdown", "deg", scenario.attitude_error),
        ("peak_speed", "highest wheel speed", "rpm", scenario.peak_wheel_speed),
        ("peak_torque", "highest torque", "N m", scenario.peak_wheel_torque),
    )
    for name, label, unit, spread in spreads:
        if spread is not None:
            limit = LANDING_TOLERANCE if name == "off_level" else None
            yield _histogram(scenario.scenario, name, label, unit, spread=spread, limit=limit)


def _histogram(
    scenario: str, name: str, label: str, unit: str, *, spread: Spread, limit: float | None
) -> Chart:
    low, high = in_unit(spread.quantiles[0], unit), in_unit(spread.quantiles[-1], unit)
    # All flights alike: one narrow bin.
    width = max(high - low, 1e-3 * max(abs(high), 1.0))
    edges = np.linspace(low, low + width, len(spread.counts) + 1)
    x = np.repeat(edges, 2)
    y = np.concatenate([[0.0], np.repeat(spread.counts, 2), [0.0]]).astype(float)
    median = in_unit(spread.quantiles[len(spread.quantiles) // 2], unit)
    marks: list[Mark] = [
        Area(x, y, Ink.BLUE),
        Line(x, y, Ink.BLUE),
        Rule(median, upright=True, label="median"),
    ]
    ends = [low, low + width]
    if limit is not None:
        allowed = in_unit(limit, unit)
        marks.append(Rule(allowed, upright=True, label="allowed", ink=Ink.VERMILION))
        ends.append(allowed)
    return Chart(
        name=f"{name}_{safe_name(scenario)}",
        title=f"{scenario}: {label}",
        description=f"Histogram over all samples of what was {label}, with its median.",
        x=Axis.around(label, unit, ends),
        y=Axis("flights", "", 0.0, 1.1 * max(spread.counts)),
        marks=tuple(marks),
        height=_HEIGHT,
    )
