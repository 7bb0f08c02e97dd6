"""`ocs-design validate` on one page: read, fly as designed, fly as it might be built."""

from collections.abc import Mapping, Sequence
from contextlib import closing, nullcontext
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path

from ocs_design import __version__
from ocs_design.common.errors import OcsError, UsageError
from ocs_design.common.files import AnyPath, to_json
from ocs_design.device.answers import SampleRecord, Validated
from ocs_design.device.records.design import DESIGN_FILE, SCHEMA_VERSION, OcsDesign
from ocs_design.device.records.flights import ValidationRecord
from ocs_design.export.film import Take, film_model
from ocs_design.export.folder import check_target, file_hashes, staged_folder
from ocs_design.export.watching import check_display, watch_takes
from ocs_design.monte_carlo.campaign import Campaign, Case, read_case, replayed, write_results
from ocs_design.monte_carlo.certificate import ROUND, SequentialTest, certificate
from ocs_design.monte_carlo.outcomes import Identity, Storage, blocks_of
from ocs_design.monte_carlo.running import (
    AT_ONCE,
    AT_ONCE_ON_DEVICE,
    Cluster,
    ThisMachine,
    narrow,
    run_campaign,
)
from ocs_design.monte_carlo.summary import summarised
from ocs_design.report.html.notebook import as_html
from ocs_design.report.text.console import Steps, Tell
from ocs_design.requirement.sections import ValidationSection
from ocs_design.requirement.specification import Specification, merge_section
from ocs_design.requirement.vocabulary import RELIABILITY
from ocs_design.simulation.engine import POSE_RATE
from ocs_design.simulation.physics import Engine, EngineName
from ocs_design.simulation.run import Run
from ocs_design.simulation.scenario import refusal
from ocs_design.simulation.warp_engine import warp_engine
from ocs_design.workflows.flying import Task, flown_hash, read_task
from ocs_design.workflows.recording import record_run, write_runs

SAMPLES_VERSION = 2
"""Version of the samples in a folder, which a later run goes on with."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """What a validation is to fly, and where it is kept.

    Attributes:
        design: `design.json` or its folder. stated: `[validation]` and `[reality]`.
        robot_file, package_paths, strict: see `read_task`.
        samples: to fly at most; None: the flights as designed alone, or until it is certified.
        until_width: of the intervals, that fewer samples will do for; None: all are flown.
        scheduler: address of a Dask cluster; None: this machine.
        engine: of the physics of samples, a word of `EngineName`.
        sample: to fly alone. replay: file of a case to fly alone.
        out: folder to write to; None: nothing is kept.
        force: replace what is there, also the samples of another campaign.
        view: whether the runs are to be looked at.
    """

    design: Path
    stated: Specification = field(default_factory=Specification)
    robot_file: Path | None = None
    package_paths: Mapping[str, Path] = field(default_factory=dict)
    strict: bool = False
    samples: int | None = None
    until_width: float | None = None
    scheduler: str | None = None
    engine: str = EngineName.MUJOCO
    sample: int | None = None
    replay: Path | None = None
    out: Path | None = None
    force: bool = False
    view: bool = False

    def check(self) -> None:
        """Refuse what contradicts itself or makes no sense.

        Raises:
            UsageError: options that exclude or need each other, no samples, no such sample, no
                width between 0 and 1, or no engine.
            MissingToolError: there is no display to look at the runs.
        """
        wanted = {"--samples": self.samples, "--sample": self.sample, "--replay": self.replay}
        given = [name for name, value in wanted.items() if value is not None]
        if len(given) > 1:
            raise UsageError(f"{' and '.join(given)} exclude each other", hint="give one")
        certifies = self.stated.validation.certify is True
        if self.sample is not None and self.sample < 0:
            raise UsageError(f"--sample {self.sample}: must be a whole number from 0")
        if certifies and self.until_width is not None:
            raise UsageError("--certify and --until-width exclude each other", hint="give one")
        if not self.many and (self.until_width is not None or self.scheduler is not None):
            raise UsageError(
                "--until-width and --scheduler are about samples", hint="add --samples N"
            )
        if self.engine not in tuple(EngineName):
            words = " or ".join(EngineName)
            raise UsageError(f"--engine {self.engine}: must be {words}")
        if self.engine != EngineName.MUJOCO:
            if not self.many:
                raise UsageError(f"--engine {self.engine} is about samples", hint="add --samples N")
            if self.scheduler is not None:
                raise UsageError(f"--engine {self.engine} and --scheduler exclude each other")
            if certifies:
                raise UsageError(
                    f"--engine {self.engine} and --certify exclude each other: its precision is "
                    "single",
                    hint="leave --engine out to certify",
                )
        if self.samples is not None and not 1 <= self.samples <= ROUND:
            raise UsageError(f"--samples {self.samples}: must be from 1 to {ROUND:,}")
        if self.until_width is not None and not 0.0 < self.until_width < 1.0:
            raise UsageError(f"--until-width {self.until_width:.4g}: must be between 0 and 100 %")
        if self.view:
            check_display()

    @property
    def many(self) -> bool:
        """Whether samples are flown, not the flights as designed alone."""
        alone = self.sample is not None or self.replay is not None
        certifies = self.stated.validation.certify is True and not alone
        return self.samples is not None or certifies

    @property
    def pose_rate(self) -> float | None:
        """Rate of the poses that are kept for the video [1/s]."""
        return POSE_RATE if self.view else None


@dataclass(frozen=True, eq=False)
class Validation:
    """Flights of a design, as designed and as it might be built.

    Attributes:
        found: the record. folder: that was written to, if any. files: in it.
        task: that was flown. runs: that came of it.
    """

    found: Validated
    folder: Path | None
    files: tuple[str, ...]
    task: Task
    runs: tuple[Run, ...]

    @property
    def exit_code(self) -> int:
        """0, or 1 if a scenario does not pass with the device."""
        return self.found.exit_code

    def __repr__(self) -> str:
        return f"<Validation{repr(self.found).removeprefix('<Validated')}"

    def _repr_html_(self) -> str:
        return as_html(self.found)


def validate_design(
    design: AnyPath,
    *,
    samples: int | None = None,
    certify: bool = False,
    until_width: float | None = None,
    seed: int | None = None,
    specification: Specification | None = None,
    robot_file: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    scheduler: str | None = None,
    engine: str = EngineName.MUJOCO,
    out: AnyPath | None = None,
    force: bool = False,
    strict: bool = False,
    progress: Steps | Tell | None = None,
) -> Validation:
    """Fly a design with the device and without, and many times over as it might be built.

    Args:
        design: its folder, its `design.json`, or the `Outcome` that made it.
        samples: robots to fly at most, drawn from `[reality]`; None: none but the one as designed.
        certify: no more of them than it takes to be sure of the reliability that was asked for.
        until_width: width of the intervals, 0..1, that fewer samples will do for.
        seed: of all samples; None: the design's.
        specification: `[validation]` and `[reality]` in place of those that it was sized with.
        robot_file: of the robot, where it has moved.
        package_paths: folder of each package that `package://` addresses name.
        scheduler: address of a Dask cluster; None: this machine.
        engine: "mujoco" on the processors, or "warp": samples on a GPU, in single precision.
        out: folder for the time series and the samples; None: nothing is kept.
        force: replace an existing folder.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`.

    Raises:
        OcsError: the design or its robot cannot be read, the folder cannot be written, or what is
            to compute the samples is not there.
    """
    stated = specification or Specification()
    asked = ValidationSection(certify=certify or None, seed=seed)
    request = Request(
        design=Path(design),
        stated=replace(stated, validation=merge_section(stated.validation, asked)),
        robot_file=None if robot_file is None else Path(robot_file),
        package_paths={name: Path(path) for name, path in (package_paths or {}).items()},
        strict=strict,
        samples=samples,
        until_width=until_width,
        scheduler=scheduler,
        engine=engine,
        out=None if out is None else Path(out),
        force=force,
    )
    return validated(request, Steps.of(progress))


def validated(request: Request, steps: Steps) -> Validation:
    """Flights that were asked for, flown and kept.

    Raises:
        OcsError: see `exceptions`.
    """
    request.check()
    # Before minutes of flights: whether it is there at all.
    engine = warp_engine() if request.engine == EngineName.WARP else None
    if request.out is not None and not request.many:
        check_target(request.out, force=request.force)
    with steps.step("read the design, plan its flights") as step:
        task = read_task(
            request.design,
            request.stated,
            robot_file=request.robot_file,
            package_paths=request.package_paths,
            strict=request.strict,
        )
        step.note = task.robot.name
    steps.doubt(task.warnings)
    runs = task.fly(steps, pose_rate=request.pose_rate)
    if request.many:
        return _fly_samples(request, task, runs, steps, engine)
    if request.sample is not None or request.replay is not None:
        campaign = campaign_of(request, task, runs)
        if request.replay is not None:
            sample = case_for(task, request.replay).drawn(task.device.layout, task.detection)
        else:
            sample = campaign.sample(request.sample or 0)
        with steps.step(f"fly sample {sample.index} of seed {sample.seed}"):
            flown = replayed(campaign, sample, pose_rate=request.pose_rate)
        found = replace(
            _validated(task, flown),
            sample=SampleRecord(seed=sample.seed, index=sample.index, values=sample.by_name),
        )
        return _kept(request, task, flown, found)
    found = replace(_validated(task, runs), survival=task.fly_stopped(steps))
    return _kept(request, task, runs, found)


def watch(answer: Validation) -> None:
    """Show every run with the device, in a window each, one after the other.

    Raises:
        MissingToolError: no window can be opened.
    """
    task, shown = answer.task, [run for run in answer.runs if run.ocs]
    device_of = {each.name: task.device.as_flown(each) for each in task.maneuvers}
    takes = [
        Take(film_model(task.robot, device_of[run.scenario], ocs=True), run.poses.qpos)
        for run in shown
        if run.poses is not None
    ]
    watch_takes(takes, 1.0 / POSE_RATE)


def _fly_samples(
    request: Request, task: Task, runs: tuple[Run, ...], steps: Steps, engine: Engine | None
) -> Validation:
    """Fly samples of the design as it might be built, keep them, and say what they show."""
    test = None
    if request.stated.validation.certify:
        test = SequentialTest(task.design.requirement.reliability or RELIABILITY)
    asked, folder = request.samples or (0 if test is None else test.most), request.out
    campaign = replace(campaign_of(request, task, runs), engine=engine)
    enough = None if request.until_width is None else narrow(request.until_width)
    enough = enough if test is None else test.decided
    storage = None
    if folder is not None:
        # What the numbers of a campaign follow from.
        identity = Identity(
            schema_version=SAMPLES_VERSION,
            tool=__version__,
            simulator=version("mujoco") if engine is None else engine.name,
            design=flown_hash(task.design, task.control),
            robot=task.robot.sha256,
            reality=campaign.uncertainty.written(),
            seed=campaign.seed,
            hold=campaign.hold,
            desaturate=task.control.desaturate,
        )
        storage = Storage(folder, identity, force=request.force)
    at_once = AT_ONCE if enough is None else 1
    if engine is not None:
        at_once = AT_ONCE_ON_DEVICE
    cluster = None if request.scheduler is None else Cluster(request.scheduler)
    leaving = nullcontext() if cluster is None else closing(cluster)
    with leaving, steps.step(f"fly {asked:,} samples") as step:
        outcomes = run_campaign(
            campaign,
            blocks_of(asked),
            workers=cluster or ThisMachine(at_once=at_once),
            storage=storage,
            enough=enough,
            progress=step.update,
        )
        certified = None if test is None else certificate(test, campaign, outcomes)
        if certified is not None:
            outcomes = outcomes.take(slice(certified.samples))
        record = replace(summarised(campaign, outcomes, asked), certificate=certified)
        by = "" if engine is None else f" by {engine.name}, in single precision"
        step.note = f"{record.samples:,} flown{by}"
    found = replace(_validated(task, runs), monte_carlo=record)
    if folder is None:
        return Validation(found, None, (), task, runs)
    files = write_results(
        campaign, outcomes, record, folder, design=flown_hash(task.design, task.control)
    )
    names = tuple(str(file.relative_to(folder)) for file in files)
    return Validation(found, folder, names, task, runs)


def campaign_of(request: Request, task: Task, runs: Sequence[Run | ValidationRecord]) -> Campaign:
    """Everything that samples of this design follow from; `runs` show what its legs bear.

    Raises:
        OcsError: no flight of this robot says anything.
    """
    if unclear := refusal(task.robot):
        raise OcsError(unclear, hint="name a link of the trunk whose z axis points up by --trunk")
    seed = request.stated.validation.seed
    return task.campaign(runs, task.uncertainty, task.design.seed if seed is None else seed)


def case_for(task: Task, path: Path) -> Case:
    """Case that was kept of this very design.

    Raises:
        OcsError: it cannot be read, or is of another design.
    """
    case = read_case(path)
    if case.design != flown_hash(task.design, task.control):
        raise OcsError(
            f"{path}: is a case of another design than {task.path}",
            hint="give the design that it was kept for, flown under the same law",
        )
    return case


def _validated(task: Task, runs: tuple[Run, ...]) -> Validated:
    """Record of these flights."""
    return Validated(
        schema_version=SCHEMA_VERSION,
        design=str(task.path),
        robot=task.robot.name,
        warnings=task.warnings,
        validation=tuple(map(record_run, runs)),
    )


def _kept(request: Request, task: Task, runs: tuple[Run, ...], found: Validated) -> Validation:
    """Validation with its time series, and a design with these flights, written if asked for."""
    if request.out is None:
        return Validation(found, None, (), task, runs)
    design = write_flights(task, runs, found, request.out, force=request.force)
    return Validation(found, request.out, tuple(design.files), task, runs)


def write_flights(
    task: Task, runs: tuple[Run, ...], found: Validated, folder: Path, *, force: bool
) -> OcsDesign:
    """Write the time series, and the design with these flights in place of its own.

    Raises:
        OutputError: the folder cannot be written, or exists already.
    """
    with staged_folder(folder, force=force) as staging:
        write_runs(runs, staging, found.survival)
        design = replace(task.design, validation=found.validation, files=file_hashes(staging))
        if found.survival is not None:
            before = task.design.survival
            alone = None if before is None else before.mass_without
            design = replace(design, survival=replace(found.survival, mass_without=alone))
        (staging / DESIGN_FILE).write_bytes(to_json(design))
    return design
