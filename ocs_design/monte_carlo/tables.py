"""All samples of a campaign as one table: CSV always, Parquet where pyarrow is installed."""

import csv
import math
from collections.abc import Mapping, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ocs_design.monte_carlo.outcomes import FAULTS, METRICS, Outcomes
from ocs_design.monte_carlo.reality import NAMES

NAME = "samples"


def write_tables(outcomes: Outcomes, scenarios: Sequence[str], folder: Path) -> tuple[Path, ...]:
    """One row per sample and scenario: verdict, figures of the flight, what was drawn (SI).

    Args:
        outcomes: of all samples.
        scenarios: their names.
        folder: to write into.
    """
    columns = _columns(outcomes, scenarios)
    written = [_write_csv(columns, folder / f"{NAME}.csv")]
    if find_spec("pyarrow") is not None:
        written.append(_write_parquet(columns, folder / f"{NAME}.parquet"))
    return tuple(written)


def _columns(outcomes: Outcomes, scenarios: Sequence[str]) -> Mapping[str, NDArray[np.generic]]:
    samples, count = len(outcomes.index), len(scenarios)
    words = np.array(["pass", *map(str, FAULTS)])
    drawn = np.repeat(outcomes.values, count, axis=0)
    figures = outcomes.metrics.reshape(samples * count, len(METRICS))
    return {
        "sample": np.repeat(outcomes.index, count),
        "scenario": np.tile(np.array(scenarios), samples),
        "verdict": words[outcomes.codes.ravel()],
        **dict(zip(METRICS, figures.T, strict=True)),
        **dict(zip(NAMES, drawn.T, strict=True)),
    }


def _write_csv(columns: Mapping[str, NDArray[np.generic]], path: Path) -> Path:
    """Numbers to six digits; an empty cell where there is none."""
    cells = [_texts(values) for values in columns.values()]
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*cells, strict=True))
    return path


def _texts(values: NDArray[np.generic]) -> list[str]:
    if values.dtype.kind == "f":
        return ["" if math.isnan(value) else f"{value:.6g}" for value in values.tolist()]
    return [str(value) for value in values.tolist()]


def _write_parquet(columns: Mapping[str, NDArray[np.generic]], path: Path) -> Path:
    """With all digits."""
    arrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    parquet.write_table(arrow.table(dict(columns)), path)
    return path
