"""`ocs-design size` on one page: read, require, size, plan, fly, export, record, report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path

from ocs_design.common.errors import UsageError
from ocs_design.common.files import AnyPath, safe_name, to_json
from ocs_design.common.workers import WorkerPool
from ocs_design.device.answers import posture_lines
from ocs_design.device.bodies import require_no_device
from ocs_design.device.device import Device
from ocs_design.device.records.design import DESIGN_FILE, OcsDesign
from ocs_design.device.records.flights import falls_short
from ocs_design.device.records.selection import DrivingManeuver, TradeOffs
from ocs_design.export.assembly.content import assembly_of
from ocs_design.export.folder import check_target, recorded_hashes, staged_folder
from ocs_design.export.formats import USUAL_FORMATS, Subject, export_formats, refusal
from ocs_design.report.charts.figures import FOLDER, all_charts
from ocs_design.report.charts.svg import write_svgs
from ocs_design.report.html.notebook import as_html
from ocs_design.report.html.page import write_report
from ocs_design.report.story import read_story
from ocs_design.report.text.console import ProgressCallback, Steps
from ocs_design.report.video import film_if_possible
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.uncertainty import complete_uncertainty, uncertainty_texts
from ocs_design.requirement.vocabulary import NO_MOTOR
from ocs_design.robot.collision import forget_collision_model
from ocs_design.robot.robot import Robot
from ocs_design.simulation.margins import record_margins
from ocs_design.simulation.run import Run
from ocs_design.simulation.world_builder import control_of
from ocs_design.sizing.alternatives import lighter_by, start_alternatives
from ocs_design.sizing.bound.rim_program import load_solver
from ocs_design.sizing.buildable import buildable_of
from ocs_design.sizing.design import mass_without_survival
from ocs_design.workflows.flying import flown_hash
from ocs_design.workflows.recording import record_design, record_run, write_runs
from ocs_design.workflows.rounds import (
    FlightResults,
    PlacedDevice,
    certify,
    impossible_turns,
    plan_and_fly,
    size_for_turns,
    size_or_advise,
)


@dataclass(frozen=True, eq=False)
class Outcome:
    """A device that was sized for a robot, and the folder with its files.

    Attributes:
        design: everything recorded, as in `design.json`.
        folder: where everything was written.
        robot, device, runs: values that the record was made from.
    """

    design: OcsDesign
    folder: Path
    robot: Robot
    device: Device
    runs: tuple[Run, ...]

    @property
    def exit_code(self) -> int:
        """0, or 1 if it cannot be built, or falls short as designed or as sampled."""
        design = self.design
        failed = falls_short(design.validation, design.survival, design.reliability)
        return int(failed or design.buildable.yes is False)

    def __fspath__(self) -> str:
        """Its folder, so that an outcome can be given as the path of a design."""
        return str(self.folder)

    def __repr__(self) -> str:
        return f"<Outcome in {self.folder}: {self.design!r}>"

    def _repr_html_(self) -> str:
        return as_html(self.design, self.folder)


def design_ocs(
    design_for: Specification | AnyPath,
    *,
    out: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    force: bool = False,
    strict: bool = False,
    progress: Steps | ProgressCallback | None = None,
    command: str = "",
    workers: WorkerPool | None = None,
) -> Outcome:
    """Size a device for a robot, write it, fly it, and record everything in one folder.

    Args:
        design_for: a specification (`specify`, `read_specification`), the path of its TOML file, or
            that of a robot alone.
        out: the folder; None: `<name>-ocs` in the working directory.
        package_paths: folder of each package, for `package://` addresses.
        force: replace an existing output folder, once the new one is complete.
        strict: warnings are errors.
        progress: function that receives the name of the current step and the part of it that is
            done, 0..1; None: a notebook shows it below the cell, and a script is silent.
        command: as typed, for the report.
        workers: processes that search lighter alternatives while the device is planned and flown;
            None: this process does so afterwards.

    Raises:
        OcsError: see `exceptions`; nothing is written then.
    """
    specification = specification_of(design_for)
    specified = specification.validation
    options = {"--video films the": specified.video, "--certify repeats the": specified.certify}
    for phrase, requested in options.items():
        if requested and specified.enabled is False:
            raise UsageError(
                f"{phrase} flights, but --no-validate flies none", hint="leave one of them out"
            )
    steps = Steps.of(progress)
    if out is not None:
        check_target(Path(out), force=force)
    with steps.step("read the robot") as step:
        robot = read_specified_robot(specification, package_paths=package_paths, strict=strict)
        folder = Path(out or f"{safe_name(robot.name)}-ocs")
        check_target(folder, force=force)
        require_no_device(robot.tree.joints)
        step.note = f"{robot.name}: {len(robot.tree.joints)} joints, {len(robot.legs)} legs"
    steps.warn(robot.warnings)
    placed = size_or_advise(specification, robot, steps, strict=strict)
    placed = size_for_turns(placed, steps, strict=strict)
    start = partial(start_alternatives, call=(workers or WorkerPool()).call)
    wait_for_alternatives = (
        None if specified.certify else start(placed.task, placed.designed.choice)
    )
    results = plan_and_fly(placed, specified, steps)
    if specified.certify:
        placed, results = certify(placed, results, steps, strict=strict)
    wait_for_alternatives = wait_for_alternatives or start(placed.task, placed.designed.choice)
    device, runs = placed.designed.device, results.runs
    with staged_folder(folder, force=force) as staging:
        film_remarks = _write_flights(placed, results, staging, steps)
        control = control_of(specified, robot)
        # Everything that does not depend on the alternatives, while other processes search them.
        with steps.step("export parts and robot files"):
            margins = record_margins(placed.resolved, placed.designed, runs, results.references)
            buildable = buildable_of(robot, placed.designed, margins, placed.mounting)
            # The model is released after the files are written: nothing refers to the subject.
            remarks = export_formats(
                replace(
                    Subject.of(robot, device, safe_name(robot.name)), refused=refusal(buildable)
                ),
                [file_format for file_format in USUAL_FORMATS if not file_format.needs_margins],
                staging,
            )
            robot = replace(robot, warnings=(*robot.warnings, *remarks))
            design = replace(
                record_design(
                    robot,
                    placed.resolved,
                    placed.designed,
                    margins=margins,
                    buildable=buildable,
                    mounting=placed.mounting,
                    warnings=(
                        *impossible_turns(placed, results.references),
                        *placed.warnings,
                        *film_remarks,
                    ),
                    seed=specified.seed or 0,
                    package_paths=package_paths,
                ),
                validation=tuple(map(record_run, runs)),
                control=control,
                reality=uncertainty_texts(
                    complete_uncertainty(
                        placed.specification.reality, standing_height(robot), device.motor
                    )
                ),
            )
            # Bill of materials and assembly, which also report on the flights.
            subject = Subject.of(robot, device, safe_name(robot.name)).recorded(design)
            export_formats(
                subject,
                [file_format for file_format in USUAL_FORMATS if file_format.needs_margins],
                staging,
            )
        with steps.step("search lighter alternatives"):
            lighter, driving_maneuver = wait_for_alternatives()
        design = replace(
            design,
            alternatives=lighter,
            owed=driving_maneuver,
            lighter=_lighter_changes(placed, driving_maneuver, steps),
        )
        forget_collision_model()
        if results.survival is not None:
            with steps.step("size a device that need not survive"):
                mass_without = mass_without_survival(placed.task)
            design = replace(design, survival=replace(results.survival, mass_without=mass_without))
        if results.certificate is not None:
            design = replace(design, reliability=results.certificate.record.certificate)
            results.certificate.write(
                staging, flown_hash(design, control, design.requirement.detection)
            )
        with steps.step("write the report"):
            design = _write_report(design, subject, runs, staging, command)
        (staging / DESIGN_FILE).write_bytes(to_json(design))
    return Outcome(design, folder, robot, device, runs)


def load_solvers(specification: Specification) -> None:
    """Import what sizing will need, which takes most of the time of a first design."""
    if specification.motor.name == NO_MOTOR:
        load_solver()
    else:
        import_module("ocs_design.sizing.trajectory.plans")


def _write_flights(
    placed: PlacedDevice, results: FlightResults, folder: Path, steps: Steps
) -> tuple[str, ...]:
    """Write the flights as designed, and film them if requested; returns why a film is missing."""
    if not results.runs:
        return ()
    write_runs(results.runs, folder, results.survival)
    if not placed.specification.validation.video:
        return ()
    device, maneuvers = placed.designed.device, placed.resolved.requirement.maneuvers
    with steps.step("film the flights"):
        target = folder / "validation"
        return film_if_possible(placed.robot, device, maneuvers, results.runs, target)


def _lighter_changes(
    placed: PlacedDevice, driving_maneuver: DrivingManeuver | None, steps: Steps
) -> TradeOffs | None:
    """Changes that would make the device lighter, if requested."""
    by, choice = placed.specification.ocs.lighter_by, placed.designed.choice
    if by is None or choice is None:
        return None
    driving = driving_maneuver.maneuver if driving_maneuver else ""
    with steps.step("search changes that make it lighter") as step:
        changes = lighter_by(by, placed.task, choice, driving, step.update)
    return TradeOffs(by=by, changes=changes)


def _write_report(
    design: OcsDesign, subject: Subject, runs: Sequence[Run], folder: Path, command: str
) -> OcsDesign:
    """Write figures and report; returns the design with the hashes of all files but the report."""
    story = read_story(
        [folder],
        design,
        runs=runs,
        postures=posture_lines(subject.carrier),
        command=command,
        assembly=assembly_of(subject),
    )
    write_svgs(tuple(all_charts(story)), folder / FOLDER)
    complete = replace(design, files=recorded_hashes(folder))
    write_report(replace(story, design=complete), folder)
    return complete
