"""`ocs-design validate --samples`: a design's flights in many worlds, none quite as designed."""

import hashlib
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import msgspec

from ocs_design import __version__
from ocs_design.exceptions import OcsError, UsageError
from ocs_design.export.folder import output_error
from ocs_design.export.staging import clear_leftovers, staging_beside
from ocs_design.monte_carlo.blocks import blocks_of
from ocs_design.monte_carlo.campaign import Campaign, make_campaign
from ocs_design.monte_carlo.cases import Case, case_of, read_case, write_case
from ocs_design.monte_carlo.outcomes import Outcomes
from ocs_design.monte_carlo.reality import Reality
from ocs_design.monte_carlo.running import Workers, run_campaign
from ocs_design.monte_carlo.storage import RESULT_FILE, Identity, Storage
from ocs_design.monte_carlo.summary import MonteCarloRecord, summarised
from ocs_design.monte_carlo.tables import write_tables
from ocs_design.recording.control import flight_options
from ocs_design.simulation.engine import Progress
from ocs_design.simulation.scenario import Run, refusal
from ocs_design.validating import SCHEMA_VERSION, Task

WORST_FOLDER = "worst"


@dataclass(frozen=True, kw_only=True)
class Order:
    """What is asked for.

    Attributes:
        samples: at most. until_width: of the intervals, that fewer will do for; None: all.
        out: folder to keep everything in; None: nothing is kept.
        force: throw away what that folder has of another campaign.
    """

    samples: int
    until_width: float | None = None
    out: Path | None = None
    force: bool = False

    def check(self) -> None:
        """Refuse what makes no sense.

        Raises:
            UsageError: no samples, or no width between 0 and 1.
        """
        if self.samples < 1:
            raise UsageError(f"--samples {self.samples}: must be 1 or more")
        if self.until_width is not None and not 0.0 < self.until_width < 1.0:
            raise UsageError(f"--until-width {self.until_width:.4g}: must be between 0 and 100 %")


def campaign_of(task: Task, runs: tuple[Run, ...], seed: int) -> Campaign:
    """Everything that samples of this design follow from.

    Args:
        task: see `Task`.
        runs: of it as designed: they show what its legs bear.
        seed: of all samples.

    Raises:
        OcsError: no flight of this robot says anything.
    """
    if unclear := refusal(task.robot):
        raise OcsError(unclear, hint="name a link of the trunk whose z axis points up by --trunk")
    return make_campaign(
        task.robot,
        task.device,
        task.maneuvers,
        options=flight_options(task.control),
        references=task.references,
        jumps=task.jumps,
        can_stand=[run.can_stand for run in runs if run.ocs],
        reality=Reality.of(task.reality, task.robot, task.device),
        seed=seed,
    )


def fly_order(
    task: Task, campaign: Campaign, order: Order, workers: Workers, progress: Progress
) -> tuple[MonteCarloRecord, tuple[Path, ...]]:
    """Fly the samples, keep them, and say what they show.

    Returns:
        The record, and the files that it was written to.

    Raises:
        OcsError: the folder cannot be used, or the workers are gone.
    """
    storage = None
    if order.out is not None:
        storage = Storage(order.out, identity_of(task, campaign), force=order.force)
    outcomes = run_campaign(
        campaign,
        blocks_of(order.samples),
        workers=workers,
        storage=storage,
        until_width=order.until_width,
        progress=progress,
    )
    record = summarised(campaign, outcomes, order.samples)
    written = () if order.out is None else _write(task, campaign, outcomes, record, order.out)
    return record, written


def identity_of(task: Task, campaign: Campaign) -> Identity:
    """What the numbers follow from."""
    return Identity(
        schema_version=SCHEMA_VERSION,
        tool=__version__,
        simulator=version("mujoco"),
        design=design_hash(task),
        robot=task.robot.sha256,
        reality=campaign.reality.written(),
        seed=campaign.seed,
        hold=campaign.hold,
        desaturate=task.control.desaturate,
    )


def design_hash(task: Task) -> str:
    """SHA-256 of what of a design is flown: device, maneuvers and wheel law."""
    flown = (task.design.ocs, task.design.requirement.maneuvers, task.control)
    return hashlib.sha256(msgspec.json.encode(flown, order="deterministic")).hexdigest()


def case_for(task: Task, path: Path) -> Case:
    """A case that was kept of this design.

    Raises:
        OcsError: it cannot be read, or is of another design.
    """
    case = read_case(path)
    if case.design != design_hash(task):
        raise OcsError(
            f"{path}: is a case of another design than {task.path}",
            hint="give the design that it was kept for, flown under the same law",
        )
    return case


def _write(
    task: Task, campaign: Campaign, outcomes: Outcomes, record: MonteCarloRecord, folder: Path
) -> tuple[Path, ...]:
    """The table of all samples, the worst cases and the record, in place of earlier ones."""
    try:
        clear_leftovers(folder / RESULT_FILE)
        with staging_beside(folder / RESULT_FILE) as staging:
            names = [flight.maneuver.name for flight in campaign.flights]
            write_tables(outcomes, names, staging)
            _write_worst(task, campaign, outcomes, record, staging / WORST_FOLDER)
            result = msgspec.json.format(msgspec.json.encode(record), indent=2)
            (staging / RESULT_FILE).write_bytes(result + b"\n")
            return _put_in_place(staging, folder)
    except OSError as error:
        raise output_error(error, folder) from error


def _write_worst(
    task: Task, campaign: Campaign, outcomes: Outcomes, record: MonteCarloRecord, folder: Path
) -> None:
    folder.mkdir()
    rows = {sample: row for row, sample in enumerate(outcomes.index.tolist())}
    for number, scenario in enumerate(record.scenarios):
        for sample in scenario.worst:
            write_case(case_of(campaign, outcomes, rows[sample], number, design_hash(task)), folder)


def _put_in_place(staging: Path, folder: Path) -> tuple[Path, ...]:
    """All files, the record last and gone as long as the others are not of one run."""
    (folder / RESULT_FILE).unlink(missing_ok=True)
    (folder / WORST_FOLDER).mkdir(exist_ok=True)
    for old in (folder / WORST_FOLDER).glob("*.json"):
        old.unlink()
    files = [path.relative_to(staging) for path in staging.rglob("*") if path.is_file()]
    files.sort(key=lambda file: (file.name == RESULT_FILE, file))
    return tuple((staging / file).replace(folder / file) for file in files)
