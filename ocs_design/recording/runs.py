"""Flights as they are kept: their record, and their time series as files."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from ocs_design.design_file import ValidationRecord
from ocs_design.export.time_series import export_time_series, series_file
from ocs_design.simulation.scenario import Run

FOLDER = "validation"


def record_run(run: Run) -> ValidationRecord:
    """One flight, without its time series."""
    return ValidationRecord(
        scenario=run.scenario,
        ocs=run.ocs,
        passed=run.passed,
        reason=run.reason,
        note=run.note,
        can_stand=run.can_stand,
        metrics={} if run.metrics is None else asdict(run.metrics),
    )


def write_runs(runs: Sequence[Run], folder: Path) -> None:
    """One CSV a flight, below `folder`."""
    if runs:
        (folder / FOLDER).mkdir()
    for run in runs:
        path = folder / FOLDER / series_file(run.scenario, ocs=run.ocs)
        export_time_series(run.series.columns(), path)
