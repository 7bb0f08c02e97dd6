"""Content of a report: the design, its flights and the shapes to show."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import OcsError
from ocs_design.common.files import safe_name
from ocs_design.device.answers import CERTIFICATE_FOLDER, RESULT_FILE, MonteCarloRecord, PostureLine
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import ValidationRecord
from ocs_design.export.assembly.content import Assembly
from ocs_design.report.bodies import ShownBody, read_bodies
from ocs_design.simulation.run import Poses, Run


@dataclass(frozen=True, eq=False)
class RecordedFlight:
    """One simulated run, ready for plotting.

    Attributes:
        record: its scenario, verdict and metrics.
        columns: time series by the headings of the CSV files, which name the SI units.
        poses: poses for the replay; None if only the time series are known.
    """

    record: ValidationRecord
    columns: Mapping[str, FloatArray]
    poses: Poses | None = None

    @property
    def time(self) -> FloatArray:
        """Sample times [s], shape (k,)."""
        return self.columns["time_s"]

    @property
    def wheels(self) -> tuple[str, ...]:
        """Names of the modules, in the order of the columns."""
        start, end = "wheel_speed_", "_rad_s"
        names = (name for name in self.columns if name.startswith(start))
        return tuple(name.removeprefix(start).removesuffix(end) for name in names)

    def wheel_speed(self, wheel: str) -> FloatArray:
        """Speed of one wheel relative to the trunk [rad/s], shape (k,)."""
        return self.columns[f"wheel_speed_{wheel}_rad_s"]

    def wheel_torque(self, wheel: str) -> FloatArray:
        """Torque of one motor on its wheel [N m], shape (k,)."""
        return self.columns[f"wheel_torque_{wheel}_nm"]

    @property
    def driven_samples(self) -> slice:
        """Samples from lift-off, or the push, to touchdown, while the wheels work.

        For a robot that never left the ground this is the last sample.
        """
        lift_off, touchdown = self.record.lift_off, self.record.touchdown
        if lift_off is None:
            return slice(-1, None)
        first = int(np.searchsorted(self.time, lift_off))
        if self.record.was_airborne and touchdown is not None:
            return slice(first, int(np.searchsorted(self.time, touchdown)) + 1)
        return slice(first, None)


@dataclass(frozen=True, eq=False)
class Story:
    """Everything that a report is made from.

    Attributes:
        design: the design.
        flights: flights in the order of `design.validation`.
        bodies: bodies of the robot with its device; empty if the folder has no GLB.
        postures: alpha* in other postures; empty if the robot was not read.
        monte_carlo: record of a Monte Carlo campaign, if any was flown.
        command: command line that made the report; empty if a program did.
        assembly: how the device is built; None: as the design records it.
    """

    design: OcsDesign
    flights: tuple[RecordedFlight, ...]
    bodies: tuple[ShownBody, ...]
    postures: tuple[PostureLine, ...] = ()
    monte_carlo: MonteCarloRecord | None = None
    command: str = ""
    assembly: Assembly | None = None

    @property
    def pivots(self) -> frozenset[str]:
        """Scenarios about a pivot."""
        return frozenset(run.scenario for run in self.design.validation if run.was_on_pivot)


def read_story(
    folders: Sequence[Path],
    design: OcsDesign,
    *,
    runs: Sequence[Run] = (),
    postures: tuple[PostureLine, ...] = (),
    command: str = "",
    assembly: Assembly | None = None,
) -> Story:
    """Story of a design from its output folders: flights from their CSV files, bodies from the GLB.

    A file is read from the first folder that has it. Flights that were just simulated are passed as
    `runs` and not read; for the other arguments see `Story`.
    """
    flights: list[RecordedFlight] = []
    for index, record in enumerate(design.validation):
        if runs:
            run = runs[index]
            flights.append(RecordedFlight(record, run.series.columns(), run.poses))
            continue
        # The CSV file may have been deleted.
        path = _first_file(folders, f"validation/{series_file(record.scenario, ocs=record.ocs)}")
        if path is not None:
            with path.open(encoding="utf-8", newline="") as file:
                heading, *rows = csv.reader(file)
            values = np.array(rows, dtype=np.float64)
            flights.append(RecordedFlight(record, dict(zip(heading, values.T, strict=True))))
    glb = _first_file(folders, f"robot/{safe_name(design.robot.name)}_ocs.glb")
    bodies = () if glb is None else read_bodies(glb.read_bytes())
    campaign = read_campaign(folders)
    return Story(design, tuple(flights), bodies, postures, campaign, command, assembly)


def _first_file(folders: Sequence[Path], name: str) -> Path | None:
    """Path of that file in the first folder that has it."""
    return next((folder / name for folder in folders if (folder / name).is_file()), None)


def read_campaign(folders: Sequence[Path]) -> MonteCarloRecord | None:
    """Monte Carlo record in or below one of these folders; None if there is none.

    A record from `validate --samples` takes precedence over that of the certificate.

    Raises:
        OcsError: the record exists but cannot be read.
    """
    paths = (path for folder in folders for path in sorted(folder.glob(f"**/{RESULT_FILE}")))
    path = min(paths, key=lambda path: path.parent.name == CERTIFICATE_FOLDER, default=None)
    if path is None:
        return None
    try:
        return msgspec.json.decode(path.read_bytes(), type=MonteCarloRecord)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: {error}", hint="fly the samples again") from error


def series_file(scenario: str, *, ocs: bool) -> str:
    """Name of the CSV file of a run, with the device or without."""
    return f"{safe_name(scenario)}_{'with' if ocs else 'without'}_ocs.csv"
