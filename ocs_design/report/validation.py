"""What `ocs-design validate` found."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from ocs_design.monte_carlo.reality import key_of
from ocs_design.monte_carlo.summary import Drawn, Validated
from ocs_design.report.flights import print_files, print_runs, print_verdicts
from ocs_design.report.layout import facts, heading, print_warnings
from ocs_design.report.monte_carlo import print_monte_carlo
from ocs_design.requirement.reality import spreads
from ocs_design.units import format_quantity


def print_validated(
    console: Console, found: Validated, folder: Path | None, files: Sequence[str]
) -> None:
    """Warnings, the flights as `size` prints them, what many samples show, and the verdict.

    Args:
        console: to print on.
        found: what came of it.
        folder: that was written to, if any. files: in it.
    """
    print_warnings(console, found.warnings)
    if found.sample is not None:
        _print_drawn(console, found.sample)
    print_runs(console, found.validation)
    if found.monte_carlo is not None:
        print_monte_carlo(console, found.monte_carlo, found.design)
    if folder is not None:
        print_files(console, str(folder), files)
    console.print()
    print_verdicts(console, found.validation)


def _print_drawn(console: Console, drawn: Drawn) -> None:
    """The sample's values in the units that people think in."""
    heading(console, f"Sample {drawn.index} of seed {drawn.seed}")
    units = {key: spread.unit for key, spread in spreads().items()}
    facts(
        console,
        (
            (name.replace("_", " ").replace(".", " "), format_quantity(value, units[key_of(name)]))
            for name, value in drawn.values.items()
        ),
    )
