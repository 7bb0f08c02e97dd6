"""The time series of flights as files."""

from collections.abc import Sequence
from pathlib import Path

from ocs_design.export.naming import safe_name
from ocs_design.export.time_series import export_time_series
from ocs_design.simulation.scenario import Run

FOLDER = "validation"


def write_runs(runs: Sequence[Run], folder: Path) -> None:
    """One CSV a flight, below `folder`."""
    if runs:
        (folder / FOLDER).mkdir()
    for run in runs:
        name = f"{safe_name(run.scenario)}_{'with' if run.ocs else 'without'}_ocs.csv"
        export_time_series(run.series.columns(), folder / FOLDER / name)
