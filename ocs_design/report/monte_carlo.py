"""Probabilities, distributions and worst cases of a campaign in the terminal."""

from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.text import Text

from ocs_design.monte_carlo.interval import Share
from ocs_design.monte_carlo.severity import Cause
from ocs_design.monte_carlo.summary import MonteCarloRecord, ScenarioSummary, Spread
from ocs_design.report.layout import columns, fits, heading, items, note, show
from ocs_design.units import ceiled, floored

_BARS = " ▁▂▃▄▅▆▇█"
_UNITS = (
    ("off level deg", 180.0 / np.pi, ".2f"),
    ("wheel rpm", 30.0 / np.pi, ",.0f"),
    ("torque N m", 1.0, ".3f"),
)


def print_monte_carlo(console: Console, record: MonteCarloRecord, design: str) -> None:
    """What many flights show; `design` is how the user names it."""
    heading(console, f"Monte Carlo: {_count(record)}, seed {record.seed}")
    _print_success(console, record)
    _print_spreads(console, record)
    items(console, _stories(record))
    note(console, f"Fly one again: ocs-design validate {design} --seed {record.seed} --sample N")


def _count(record: MonteCarloRecord) -> str:
    flown = f"{record.samples:,} robots as they might be built"
    if record.samples == record.asked:
        return flown
    return f"{flown} of {record.asked:,}, enough for the interval asked for"


def _print_success(console: Console, record: MonteCarloRecord) -> None:
    interval = f"{record.confidence:.0%} interval"
    table = columns("scenario", "passes", "of all", interval, "what else came of it", left=1)
    table.columns[-1].justify = "left"
    for scenario in record.scenarios:
        other = ", ".join(f"{count} {fault}" for fault, count in scenario.faults.items())
        table.add_row(Text(scenario.scenario), *share_cells(scenario.success), other or "-")
    if len(record.scenarios) > 1:
        table.add_row(Text("all of them", style="bold"), *share_cells(record.success), "-")
    show(console, table)


def share_cells(share: Share) -> tuple[str, str, str]:
    """How many, their part of all, and the interval of that: all is said of nothing less."""
    return (
        f"{share.passed:,}",
        f"{floored(100.0 * share.estimate, 1)} %",
        f"{floored(100.0 * share.low, 1)} .. {ceiled(100.0 * share.high, 1)} %",
    )


_SPREADS = ("scenario", "in flight", "5 %", "median", "95 %", "most", "least to most")


def _print_spreads(console: Console, record: MonteCarloRecord) -> None:
    console.print()
    # The histogram is left out where the terminal is too narrow: no figure is cut.
    for shown in (_SPREADS, _SPREADS[:-1]):
        table = columns(*shown, left=2)
        for scenario in record.scenarios:
            for row in _spread_rows(scenario):
                table.add_row(*map(Text, row[: len(shown)]))
        if fits(console, table):
            break
    show(console, table)


def _spread_rows(scenario: ScenarioSummary) -> Iterator[tuple[str, ...]]:
    spreads = (scenario.attitude_error, scenario.peak_wheel_speed, scenario.peak_wheel_torque)
    name = scenario.scenario
    for spread, (quantity, factor, form) in zip(spreads, _UNITS, strict=True):
        if spread is not None:
            values = (format(factor * value, form) for value in spread.quantiles[1:])
            yield name, quantity, *values, _histogram(spread)
            name = ""


def _histogram(spread: Spread) -> str:
    """One character a bin; whatever is not empty shows."""
    most = max(spread.counts)
    heights = (int(np.ceil(count / most * (len(_BARS) - 1))) for count in spread.counts)
    return "".join(_BARS[height] for height in heights)


def _stories(record: MonteCarloRecord) -> Iterator[str]:
    """What goes with bad outcomes, and where they are."""
    for scenario in record.scenarios:
        found = ", ".join(map(_cause, scenario.causes))
        if found:
            yield f"{scenario.scenario}: off level with {found}"
        if scenario.advice:
            yield f"{scenario.scenario}: {scenario.advice}"
        worst = ", ".join(map(str, scenario.worst))
        yield f"{scenario.scenario}: worst are samples {worst}"


def _cause(cause: Cause) -> str:
    name = cause.quantity.replace("_", " ").replace(".", " ")
    return f"{name} ({'either way ' if cause.either_way else ''}{cause.correlation:+.2f})"
