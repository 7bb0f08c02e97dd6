"""`ocs-design validate` on one page: read, fly as designed, fly samples."""

from collections.abc import Mapping
from contextlib import closing, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path

from ocs_design import __version__
from ocs_design.common.errors import OcsError, UsageError
from ocs_design.common.files import AnyPath, to_json
from ocs_design.device.answers import MonteCarloRecord, SampleRecord, Validated
from ocs_design.device.records.design import DESIGN_FILE
from ocs_design.export.film import Take, film_model
from ocs_design.export.folder import check_target, file_hashes, staged_folder
from ocs_design.export.watching import check_display, watch_takes
from ocs_design.monte_carlo.campaign import read_case, replayed, write_results
from ocs_design.monte_carlo.certificate import ROUND_STRIDE, SequentialTest, certificate
from ocs_design.monte_carlo.outcomes import Identity, Storage, blocks_of
from ocs_design.monte_carlo.running import (
    BLOCKS_AT_ONCE,
    BLOCKS_AT_ONCE_ON_GPU,
    Cluster,
    fly_here,
    narrow,
    run_campaign,
)
from ocs_design.monte_carlo.summary import summarise
from ocs_design.report.html.notebook import as_html
from ocs_design.report.text.console import ProgressCallback, Steps
from ocs_design.requirement.sections import ValidationSection
from ocs_design.requirement.specification import Specification, merge_section
from ocs_design.requirement.vocabulary import RELIABILITY
from ocs_design.simulation.engine import Engine, EngineName
from ocs_design.simulation.run import Run
from ocs_design.simulation.simulate import POSE_RATE
from ocs_design.simulation.warp_engine import warp_engine
from ocs_design.workflows.flying import DesignFlights, read_flights
from ocs_design.workflows.recording import record_run, write_runs

SAMPLES_VERSION = 2
"""Version of the samples in a folder, which a later run resumes."""


@dataclass(frozen=True, kw_only=True)
class _Request:
    """Request to `validate_design`: what to fly, and where to keep it."""

    specified: Specification
    samples: int | None
    until_width: float | None
    scheduler: str | None
    engine: str
    sample: int | None
    replay: Path | None
    out: Path | None
    force: bool
    view: bool

    def check(self) -> None:
        """Refuse contradictory or meaningless requests.

        Raises:
            UsageError: options that exclude or need each other, no samples, no such sample, no
                width between 0 and 1, or no engine.
            MissingToolError: there is no display to show the runs.
        """
        alternatives = {"--samples": self.samples, "--sample": self.sample, "--replay": self.replay}
        given = [name for name, value in alternatives.items() if value is not None]
        certifies, engine = self.specified.validation.certify is True, f"--engine {self.engine}"
        other_engine, width = self.engine != EngineName.MUJOCO, self.until_width

        def refuse(applies: bool, message: str, hint: str = "") -> None:
            if applies:
                raise UsageError(message, hint=hint)

        refuse(len(given) > 1, f"{' and '.join(given)} exclude each other", "give one")
        seed = self.specified.validation.seed
        refuse((seed or 0) < 0, f"--seed {seed}: must be a whole number from 0")
        refuse((self.sample or 0) < 0, f"--sample {self.sample}: must be a whole number from 0")
        refuse(
            certifies and self.flies_one_sample,
            f"{'; '.join(given)} and --certify exclude each other: one robot certifies nothing",
            "leave --certify out, or `certify` of the specification",
        )
        if width is not None:
            refuse(certifies, "--certify and --until-width exclude each other", "give one")
        if not self.flies_many_samples:
            needy = width is not None or self.scheduler is not None
            refuse(needy, "--until-width and --scheduler need --samples", "add --samples N")
        unknown = self.engine not in tuple(EngineName)
        refuse(unknown, f"{engine}: must be {' or '.join(EngineName)}")
        if other_engine:
            refuse(not self.flies_many_samples, f"{engine} needs --samples", "add --samples N")
            refuse(self.scheduler is not None, f"{engine} and --scheduler exclude each other")
            refuse(
                certifies,
                f"{engine} and --certify exclude each other: it computes in single precision",
                "leave --engine out to certify",
            )
        if self.samples is not None:
            possible = 1 <= self.samples <= ROUND_STRIDE
            refuse(not possible, f"--samples {self.samples}: must be from 1 to {ROUND_STRIDE:,}")
        if width is not None:
            possible = 0.0 < width < 1.0
            refuse(not possible, f"--until-width {width:.4g}: must be between 0 and 100 %")
        if self.view:
            check_display()

    @property
    def flies_one_sample(self) -> bool:
        """Whether a single sampled robot is flown."""
        return self.sample is not None or self.replay is not None

    @property
    def flies_many_samples(self) -> bool:
        """Whether samples are flown, in addition to the flights as designed."""
        return self.samples is not None or self.specified.validation.certify is True


@dataclass(frozen=True, eq=False)
class Validation:
    """Flights of a design, as designed and as sampled.

    Attributes:
        record: of these flights. folder: written to, if any. files: in it.
        flights: that were flown. runs: their results.
    """

    record: Validated
    folder: Path | None
    files: tuple[str, ...]
    flights: DesignFlights
    runs: tuple[Run, ...]

    @property
    def exit_code(self) -> int:
        """0, or 1 if a scenario does not pass with the device."""
        return self.record.exit_code

    def __repr__(self) -> str:
        return f"<Validation{repr(self.record).removeprefix('<Validated')}"

    def _repr_html_(self) -> str:
        return as_html(self.record)


def validate_design(
    design: AnyPath,
    *,
    samples: int | None = None,
    certify: bool = False,
    until_width: float | None = None,
    seed: int | None = None,
    sample: int | None = None,
    replay: AnyPath | None = None,
    specification: Specification | None = None,
    robot_file: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    scheduler: str | None = None,
    engine: str = EngineName.MUJOCO,
    out: AnyPath | None = None,
    force: bool = False,
    strict: bool = False,
    view: bool = False,
    progress: Steps | ProgressCallback | None = None,
) -> Validation:
    """Fly a design with and without the device, and many times as sampled.

    Args:
        design: its folder, its `design.json`, or the `Outcome` that made it.
        samples: largest number of robots to fly, sampled from `[reality]`; None: the nominal one.
        certify: fly only as many as it takes to decide on the specified reliability.
        until_width: width of the intervals at which to stop early, 0..1.
        seed: of all samples; None: the design's.
        sample: index of a single sample to fly. replay: file of a single case to fly.
        specification: `[validation]` and `[reality]` in place of the design's own.
        robot_file: the robot's file, if it has moved.
        package_paths: folder of each package, for `package://` addresses.
        scheduler: address of a Dask cluster; None: this machine.
        engine: "mujoco" on the processors, or "warp": samples on a GPU, in single precision.
        out: folder for the time series and the samples; None: nothing is kept.
        force: replace an existing folder, even with samples of another campaign.
        strict: warnings about the robot are errors.
        view: keep poses for `watch`.
        progress: see `design_ocs`.

    Raises:
        OcsError: options exclude each other, the design or its robot cannot be read, the folder
            cannot be written, or the engine or the display is missing.
    """
    steps, specified = Steps.of(progress), specification or Specification()
    overrides = ValidationSection(certify=certify or None, seed=seed)
    request = _Request(
        specified=replace(specified, validation=merge_section(specified.validation, overrides)),
        samples=samples,
        until_width=until_width,
        scheduler=scheduler,
        engine=engine,
        sample=sample,
        replay=None if replay is None else Path(replay),
        out=None if out is None else Path(out),
        force=force,
        view=view,
    )
    request.check()
    # Check before minutes of flights that the engine exists.
    physics = warp_engine() if engine == EngineName.WARP else None
    case = None if request.replay is None else read_case(request.replay)
    if request.out is not None and not request.flies_many_samples:
        check_target(request.out, force=force)
    with steps.step("read the design, plan its flights") as step:
        flights = read_flights(
            design,
            request.specified,
            robot_file=robot_file,
            package_paths=package_paths,
            strict=strict,
        )
        step.note = flights.robot.name
    if case is not None and case.design != flights.flown_hash:
        raise OcsError(
            f"{replay}: belongs to another design than {flights.path}",
            hint="give the design that it was saved for, with the same wheel law",
        )
    steps.warn(flights.warnings)
    pose_rate = POSE_RATE if view else None
    runs = flights.fly(steps, pose_rate=pose_rate)
    answer = Validated(
        design=str(flights.path),
        robot=flights.robot.name,
        warnings=(*flights.warnings, *_unused_keys(request.specified)),
        validation=tuple(map(record_run, runs)),
    )
    if request.flies_many_samples:
        record, files = _fly_samples(request, flights, runs, steps, physics)
        return Validation(replace(answer, monte_carlo=record), request.out, files, flights, runs)
    if request.flies_one_sample:
        campaign = flights.campaign(runs)
        to_sample = campaign.sample(sample or 0)
        if case is not None:
            to_sample = case.to_sample(campaign.uncertainty)
        with steps.step(f"fly sample {to_sample.index} of seed {to_sample.seed}"):
            runs = replayed(campaign, to_sample, pose_rate=pose_rate)
        answer = replace(
            answer,
            validation=tuple(map(record_run, runs)),
            sample=SampleRecord(
                seed=to_sample.seed, index=to_sample.index, values=to_sample.by_name
            ),
        )
    else:
        answer = replace(answer, survival=flights.fly_stopped(steps))
    if request.out is None:
        return Validation(answer, None, (), flights, runs)
    # The time series, and the design with these flights instead of its own.
    with staged_folder(request.out, force=force) as staging:
        write_runs(runs, staging, answer.survival)
        updated = replace(
            flights.design,
            validation=answer.validation,
            control=flights.control,
            requirement=replace(flights.design.requirement, detection=flights.detection),
            files=file_hashes(staging),
        )
        if answer.survival is not None:
            before = flights.design.survival
            mass_without = None if before is None else before.mass_without
            updated = replace(updated, survival=replace(answer.survival, mass_without=mass_without))
        (staging / DESIGN_FILE).write_bytes(to_json(updated))
    return Validation(answer, request.out, tuple(updated.files), flights, runs)


_FLIGHT_SECTIONS = ("validation", "reality")
"""Sections of a specification that apply to the flights of a design."""

_IGNORED_KEYS = ("validation.enabled", "validation.video")
_FURTHER_FLIGHT_KEYS = ("requirement.survives", "requirement.detection")


def _unused_keys(specified: Specification) -> tuple[str, ...]:
    """A sentence on the keys of a specification that do not apply to a finished design."""
    names = [
        path
        for path in specified.specified
        if path in _IGNORED_KEYS
        or not (path.partition(".")[0] in _FLIGHT_SECTIONS or path in _FURTHER_FLIGHT_KEYS)
    ]
    names += [f"maneuver {maneuver.name!r}" for maneuver in specified.maneuvers]
    if not names:
        return ()
    return (
        f"not used from the specification: {', '.join(names)}: a design is flown as it was sized; "
        "for another one run `ocs-design size`",
    )


def watch(answer: Validation) -> None:
    """Show every run with the device, each in a window, one after the other.

    Raises:
        MissingToolError: no window can be opened.
    """
    flights, with_device = answer.flights, [run for run in answer.runs if run.ocs]
    device_of = {maneuver.name: flights.device.as_flown(maneuver) for maneuver in flights.maneuvers}
    scenario_poses = [(run.scenario, run.poses) for run in with_device if run.poses is not None]
    takes = [
        Take(film_model(flights.robot, device_of[scenario], ocs=True), poses.qpos)
        for scenario, poses in scenario_poses
    ]
    # Poses are whole control steps apart, so their rate is not exactly `POSE_RATE`.
    periods = [float(poses.time[1] - poses.time[0]) for _, poses in scenario_poses]
    watch_takes(takes, next(iter(periods), 1.0 / POSE_RATE))


def _fly_samples(
    request: _Request,
    flights: DesignFlights,
    runs: tuple[Run, ...],
    steps: Steps,
    engine: Engine | None,
) -> tuple[MonteCarloRecord, tuple[str, ...]]:
    """Fly samples of the design; returns the record and the files."""
    test = None
    if request.specified.validation.certify:
        test = SequentialTest(flights.design.requirement.reliability or RELIABILITY)
    requested, folder = request.samples or (0 if test is None else test.most_flights), request.out
    campaign = replace(flights.campaign(runs), engine=engine)
    stop_when = None if request.until_width is None else narrow(request.until_width)
    stop_when = stop_when if test is None else test.decided
    flown, storage = flights.flown_hash, None
    if folder is not None:
        # Everything that determines the figures of a campaign.
        identity = Identity(
            schema_version=SAMPLES_VERSION,
            tool=__version__,
            simulator=version("mujoco") if engine is None else engine.name,
            design=flown,
            robot=flights.robot.sha256,
            reality=campaign.uncertainty.written(),
            seed=campaign.seed,
            hold=campaign.hold,
            desaturate=flights.control.desaturate,
        )
        storage = Storage(folder, identity, force=request.force)
    at_once = BLOCKS_AT_ONCE if stop_when is None else 1
    if engine is not None:
        at_once = BLOCKS_AT_ONCE_ON_GPU
    cluster = None if request.scheduler is None else Cluster(request.scheduler)
    cluster_context = nullcontext() if cluster is None else closing(cluster)
    with cluster_context, steps.step(f"fly {requested:,} samples") as step:
        outcomes = run_campaign(
            campaign,
            blocks_of(requested),
            fly=partial(fly_here, at_once=at_once) if cluster is None else cluster.fly,
            storage=storage,
            stop_when=stop_when,
            progress=step.update,
        )
        certified = None if test is None else certificate(test, campaign, outcomes)
        if certified is not None:
            outcomes = outcomes.take(slice(certified.samples))
        record = replace(summarise(campaign, outcomes, requested), certificate=certified)
        engine_text = "" if engine is None else f" by {engine.name}, in single precision"
        step.note = f"{record.samples:,} flown{engine_text}"
    if folder is None:
        return record, ()
    files = write_results(campaign, outcomes, record, folder, design=flown)
    return record, tuple(str(file.relative_to(folder)) for file in files)
