"""Flights in the terminal, as shown by `size` and `validate`, one by one and as campaigns."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.text import Text

from ocs_design.common.units import format_quantity
from ocs_design.device.answers import Validated
from ocs_design.device.records.flights import SurvivalRecord, ValidationRecord
from ocs_design.monte_carlo.uncertainty import STOP_QUANTITIES, key_of
from ocs_design.report import flights, monte_carlo
from ocs_design.report.table import Tone
from ocs_design.report.text.layout import STYLES, facts, files_written, heading, items, note, show
from ocs_design.report.verdict import SEPARATOR, Headline, headline
from ocs_design.requirement.uncertainty import spreads


def print_runs(
    console: Console, runs: Sequence[ValidationRecord], survival: SurvivalRecord | None = None
) -> None:
    """Print the flights with and without the device: verdicts, attitudes, wheels, reasons."""
    heading(console, "Flights in MuJoCo, with the device and without")
    show(console, flights.flight_table(runs))
    items(console, map(flights.run_sentence, runs))
    if survival is not None:
        heading(console, flights.SURVIVAL_TITLE)
        show(console, flights.survival_table(survival))
        items(console, [flights.survival_sentence(survival)])


def print_headline(console: Console, line: Headline, *more: Text) -> None:
    """Print the verdict and `more` in one line, and below it what matters most."""
    parts = (Text(part.text, style=f"bold {STYLES[part.tone]}") for part in line.parts)
    console.print(Text(SEPARATOR).join(parts), *more)
    if line.main_finding:
        console.print(
            Text(line.main_finding, style="" if line.tone is Tone.PASS else STYLES[line.tone])
        )


def print_validated(
    console: Console,
    result: Validated,
    folder: Path | None,
    files: Sequence[str],
    replay_hint: str = "",
) -> None:
    """Print the flights as `size` does, the campaign, the files written, and the verdict.

    Args:
        replay_hint: how to fly one of the samples again.
    """
    if result.sample is not None:
        heading(console, f"Sample {result.sample.index} of seed {result.sample.seed}")
        units = {key: spread.unit for key, spread in spreads().items()} | dict.fromkeys(
            STOP_QUANTITIES, ""
        )
        values = (
            (name.replace("_", " ").replace(".", " "), format_quantity(value, units[key_of(name)]))
            for name, value in result.sample.values.items()
        )
        facts(console, values)
    print_runs(console, result.validation, result.survival)
    record = result.monte_carlo
    if record is not None:
        heading(console, f"Monte Carlo: {monte_carlo.campaign_title(record)}")
        show(console, monte_carlo.success_table(record))
        console.print()
        spread = monte_carlo.spread_table(record)
        show(console, spread, fewest=len(spread.columns) - 1)
        items(console, monte_carlo.campaign_remarks(record))
        if record.certificate is not None:
            items(console, monte_carlo.certificate_notes(record.certificate))
        note(console, replay_hint)
    if folder is not None:
        files_written(console, str(folder), files)
    console.print()
    print_headline(console, headline(result))
