"""Many flights, none quite as designed: how often they pass, and how their figures are spread."""

from collections.abc import Iterator

from ocs_design.monte_carlo.summary import MonteCarloRecord
from ocs_design.report.figures.distributions import distribution_charts
from ocs_design.report.html.elements import Markup, details, element, facts, section, table
from ocs_design.report.html.figure import figures
from ocs_design.report.monte_carlo import share_cells


def monte_carlo_section(record: MonteCarloRecord | None) -> Markup:
    """Nothing where no samples were flown."""
    if record is None:
        return Markup("")
    heads = ("scenario", "passes", "of all", f"{record.confidence:.0%} interval")
    told = f"{record.samples:,} robots as they might be built, seed {record.seed}."
    return section(
        "samples",
        "Monte Carlo",
        element("p", told),
        table("How often they pass", heads, _rows(record)),
        *(element("p", f"{s.scenario}: {s.advice}.") for s in record.scenarios if s.advice),
        figures(distribution_charts(record)),
        details("What was drawn", facts(record.reality.items())),
    )


def _rows(record: MonteCarloRecord) -> Iterator[tuple[str, ...]]:
    for scenario in record.scenarios:
        yield scenario.scenario, *share_cells(scenario.success)
    if len(record.scenarios) > 1:
        yield "all of them", *share_cells(record.success)
