"""A simulated run as a report draws it, as it was flown or from its CSV file."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design_file import ValidationRecord
from ocs_design.export.time_series import series_file
from ocs_design.simulation.poses import Poses
from ocs_design.simulation.scenario import Run


@dataclass(frozen=True, eq=False)
class Flight:
    """One run, to be drawn.

    Attributes:
        scenario: name of the maneuver. ocs: with the device.
        columns: time series as in the CSV files, headings with units; SI.
        lift_off: when it leaves the ground, or is pushed as it stands [s]; None: it never does.
        touchdown: when it comes down [s]; None: it never does.
        poses: to show it again; None: only its time series are known.
    """

    scenario: str
    ocs: bool
    columns: Mapping[str, FloatArray]
    lift_off: float | None
    touchdown: float | None
    poses: Poses | None

    @property
    def time(self) -> FloatArray:
        """[s], shape (k,)."""
        return self.columns["time_s"]

    @property
    def driven(self) -> slice:
        """The instants from lift-off, or the push, to touchdown: when the wheels are at work.

        A robot that never left the ground has its last instant for them.
        """
        if self.lift_off is None:
            return slice(-1, None)
        first = int(np.searchsorted(self.time, self.lift_off))
        if self.flies and self.touchdown is not None:
            return slice(first, int(np.searchsorted(self.time, self.touchdown)) + 1)
        return slice(first, None)

    @property
    def flies(self) -> bool:
        """Whether it was in the air at all; who is pushed as they stand touch down at once."""
        if self.lift_off is None:
            return False
        return self.touchdown is None or self.touchdown > self.lift_off


def flights_of(runs: Sequence[Run]) -> tuple[Flight, ...]:
    """The runs of a simulation."""
    return tuple(
        Flight(
            run.scenario,
            run.ocs,
            run.series.columns(),
            None if run.metrics is None else run.metrics.lift_off_time,
            None if run.metrics is None else run.metrics.touchdown_time,
            run.poses,
        )
        for run in runs
    )


def first_file(folders: Sequence[Path], name: str) -> Path | None:
    """Of that name below the first folder that has it."""
    return next((folder / name for folder in folders if (folder / name).is_file()), None)


def recorded_flight(folders: Sequence[Path], record: ValidationRecord) -> Flight | None:
    """The time series of a run, where its file is still there."""
    path = first_file(folders, f"validation/{series_file(record.scenario, ocs=record.ocs)}")
    if path is None:
        return None
    with path.open(encoding="utf-8", newline="") as file:
        heading, *rows = csv.reader(file)
    values = np.array(rows, dtype=np.float64)
    columns = dict(zip(heading, values.T, strict=True))
    # Older versions say nothing of it, and all of theirs start in the air.
    lift_off = record.metrics.get("lift_off_time", 0.0 if record.metrics else None)
    touchdown = record.metrics.get("touchdown_time")
    return Flight(record.scenario, record.ocs, columns, lift_off, touchdown, None)
