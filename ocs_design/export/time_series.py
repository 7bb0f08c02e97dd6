"""Time series of a simulated run as CSV, SI units in the heading."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.files import safe_name


def export_time_series(columns: Mapping[str, FloatArray], path: Path) -> Path:
    """Write named columns of equal length, shape (k,) each, with six significant digits."""
    table = np.column_stack(list(columns.values()))
    rows = [",".join([f"{value:.6g}" for value in row]) for row in table.tolist()]
    path.write_text("\n".join([",".join(columns), *rows, ""]), encoding="utf-8")
    return path


def series_file(scenario: str, *, ocs: bool) -> str:
    """Name of the CSV file of a run, with the device or without."""
    return f"{safe_name(scenario)}_{'with' if ocs else 'without'}_ocs.csv"
