"""`ocs-design validate` on one page: read, fly as designed, fly as it might be built."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from ocs_design.exceptions import UsageError
from ocs_design.export.film import Take, film_model
from ocs_design.export.folder import check_target
from ocs_design.export.watching import check_display, watch_takes
from ocs_design.monte_carlo.cluster import Cluster
from ocs_design.monte_carlo.replay import replayed
from ocs_design.monte_carlo.running import ThisMachine, Workers
from ocs_design.monte_carlo.summary import Drawn, Validated
from ocs_design.report.console import Steps
from ocs_design.requirement.specification import Specification
from ocs_design.sampling import Order, campaign_of, case_for, fly_order
from ocs_design.simulation.poses import POSE_RATE
from ocs_design.simulation.scenario import Run
from ocs_design.validating import Task, fly_again, read_task, validated, write_flights


@dataclass(frozen=True, kw_only=True)
class Request:
    """What was asked for.

    Attributes:
        design: `design.json` or its folder. stated: `[validation]` and `[reality]`.
        robot_file, package_paths, strict: see `read_task`.
        samples, until_width: see `Order`; None: the flights as designed alone.
        scheduler: address of a Dask cluster; None: this machine.
        sample: to fly alone. replay: file of a case to fly alone.
        out, force: where to write, and whether over what is there.
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
    sample: int | None = None
    replay: Path | None = None
    out: Path | None = None
    force: bool = False
    view: bool = False

    def check(self) -> None:
        """Refuse what contradicts itself.

        Raises:
            UsageError: options that exclude or need each other.
            MissingToolError: there is no display to look at them.
        """
        wanted = {"--samples": self.samples, "--sample": self.sample, "--replay": self.replay}
        given = [name for name, value in wanted.items() if value is not None]
        if len(given) > 1:
            raise UsageError(f"{' and '.join(given)} exclude each other", hint="give one")
        if self.samples is None and (self.until_width is not None or self.scheduler is not None):
            raise UsageError(
                "--until-width and --scheduler are about samples", hint="add --samples N"
            )
        if self.samples is not None:
            self.order.check()
        if self.view:
            check_display()

    @property
    def pose_rate(self) -> float | None:
        """Of the poses that are kept to be looked at [1/s]."""
        return POSE_RATE if self.view else None

    @property
    def order(self) -> Order:
        """Of the samples."""
        return Order(
            samples=self.samples or 0,
            until_width=self.until_width,
            out=self.out,
            force=self.force,
        )


@dataclass(frozen=True, eq=False)
class Answer:
    """What came of it.

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


def validate_design(request: Request, steps: Steps) -> Answer:
    """Do it.

    Raises:
        OcsError: see `exceptions`.
    """
    request.check()
    if request.out is not None and request.samples is None:
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
    with steps.step("fly the maneuvers with and without the device") as step:
        runs = fly_again(task, step.update, pose_rate=request.pose_rate)
    if request.samples is not None:
        return _many(request, task, runs, steps)
    if request.sample is not None or request.replay is not None:
        return _one(request, task, runs, steps)
    return _written(request, task, runs, validated(task, runs))


def watch(answer: Answer) -> None:
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


def _many(request: Request, task: Task, runs: tuple[Run, ...], steps: Steps) -> Answer:
    """As designed, and as it might be built."""
    order = request.order
    campaign = campaign_of(task, runs, _seed(request, task))
    doing = steps.step(f"fly {order.samples:,} samples")
    with _workers(request.scheduler) as workers, doing as step:
        record, files = fly_order(task, campaign, order, workers, step.update)
        step.note = f"{record.samples:,} flown"
    found = replace(validated(task, runs), monte_carlo=record)
    names = () if order.out is None else tuple(str(f.relative_to(order.out)) for f in files)
    return Answer(found, order.out, names, task, runs)


def _one(request: Request, task: Task, runs: tuple[Run, ...], steps: Steps) -> Answer:
    """One sample alone."""
    campaign = campaign_of(task, runs, _seed(request, task))
    if request.replay is not None:
        sample = case_for(task, request.replay).drawn()
    else:
        sample = campaign.sample(request.sample or 0)
    with steps.step(f"fly sample {sample.index} of seed {sample.seed}"):
        flown = replayed(campaign, sample, pose_rate=request.pose_rate)
    found = replace(validated(task, flown), sample=Drawn.of(sample))
    return _written(request, task, flown, found)


def _written(request: Request, task: Task, runs: tuple[Run, ...], found: Validated) -> Answer:
    if request.out is None:
        return Answer(found, None, (), task, runs)
    design = write_flights(task, runs, found, request.out, force=request.force)
    return Answer(found, request.out, tuple(design.files), task, runs)


def _seed(request: Request, task: Task) -> int:
    stated = request.stated.validation.seed
    return task.design.seed if stated is None else stated


@contextmanager
def _workers(scheduler: str | None) -> Iterator[Workers]:
    """This machine, or a cluster that is left again in the end."""
    if scheduler is None:
        yield ThisMachine()
        return
    cluster = Cluster(scheduler)
    try:
        yield cluster
    finally:
        cluster.close()
