"""The whole chain on one page: read, require, size, export, prove, record."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.common.files import safe_name
from ocs_design.device.checks import device_warnings
from ocs_design.device.device import Device
from ocs_design.device.naming import require_no_device
from ocs_design.device.records import OcsDesign, design_to_json
from ocs_design.export.folder import (
    DESIGN_FILE,
    check_target,
    recorded_hashes,
    staged_folder,
)
from ocs_design.export.formats import USUAL_FORMATS, Subject, export_formats
from ocs_design.jumping.jump import JumpPlans
from ocs_design.report.charts.figures import FOLDER, all_charts
from ocs_design.report.charts.files import write_svgs
from ocs_design.report.html.page import write_report
from ocs_design.report.story import flights_of, story_in
from ocs_design.report.text.console import Steps
from ocs_design.report.video.film import film_or_tell
from ocs_design.requirement.resolving import Resolved, read_specified_robot, resolve
from ocs_design.requirement.specification import NO_MOTOR, Specification, ValidationSection
from ocs_design.requirement.uncertainty import uncertainty_texts
from ocs_design.robot.collision import forget_collision_model
from ocs_design.robot.meshes import size
from ocs_design.robot.robot import Robot
from ocs_design.simulation.engine import POSE_RATE
from ocs_design.simulation.scenario import Run, run_scenarios
from ocs_design.simulation.trotting import require_trot
from ocs_design.sizing.alternatives import alternatives
from ocs_design.sizing.bound.rim_program import load_solver
from ocs_design.sizing.design import Designed, design_device
from ocs_design.sizing.mounting import Mounting, mounting_of, placement_warnings
from ocs_design.sizing.selection.advice import Refused
from ocs_design.workflows.flying import control_of, flight_options, trajectories
from ocs_design.workflows.inspect import posture_lines
from ocs_design.workflows.recording import record_design, write_runs

if TYPE_CHECKING:
    from ocs_design.jumping.planning import JumpPlanning
    from ocs_design.sizing.trajectory.plans import Reference


@dataclass(frozen=True, eq=False)
class Outcome:
    """What came out.

    Attributes:
        design: the artefact.
        folder: where everything was written.
        robot, device, runs: the live values behind the artefact.
    """

    design: OcsDesign
    folder: Path
    robot: Robot
    device: Device
    runs: tuple[Run, ...]

    @property
    def exit_code(self) -> int:
        """0, or 1 if it cannot be built or a scenario does not pass with the device."""
        failed = any(run.ocs and run.passed is not True for run in self.runs)
        return 1 if failed or self.design.buildable.yes is False else 0


def design_ocs(
    specification: Specification,
    *,
    out: Path | None = None,
    package_paths: Mapping[str, Path] | None = None,
    force: bool = False,
    strict: bool = False,
    steps: Steps | None = None,
    command: str = "",
) -> Outcome:
    """Size a device for a robot, write it, fly it, and record all of it in one folder.

    Args:
        specification: what was stated, from a file, from options or made in Python.
        out: the folder; None: `<name>-ocs` in the working directory.
        package_paths: folder of each package that `package://` addresses name.
        force: replace an existing output folder, once the new one is complete.
        strict: warnings are errors.
        steps: where progress goes; None: nowhere.
        command: that was typed, for the report.

    Raises:
        OcsError: see `exceptions`; nothing is written then.
    """
    steps = steps or Steps.silent()
    with steps.step("read the robot") as step:
        robot = read_specified_robot(specification, package_paths=package_paths, strict=strict)
        folder = out or Path(f"{safe_name(robot.name)}-ocs")
        check_target(folder, force=force)
        require_no_device(robot.tree.joints)
        step.note = f"{robot.name}: {len(robot.tree.joints)} joints, {len(robot.legs)} legs"
    sized = _sized_or_advised(specification, robot, steps, strict=strict)
    device = sized.designed.device
    with steps.step("plan the maneuvers"):
        plans = _plan(sized)
    with staged_folder(folder, force=force) as staging:
        with steps.step("export parts and robot files"):
            remarks = _write_formats(robot, device, staging)
            robot = replace(robot, warnings=(*robot.warnings, *remarks))
        runs, unfilmed = _prove(sized, specification.validation, plans, staging, steps)
        with steps.step("look for what would be lighter otherwise"):
            lighter = alternatives(specification, sized.designed, sized.robot)
            forget_collision_model()
        design = record_design(
            robot,
            sized.resolved,
            sized.designed,
            runs,
            plans=plans,
            control=control_of(specification.validation, robot),
            uncertainty=uncertainty_texts(specification.reality),
            mounting=sized.mounting,
            warnings=(*sized.remarks, *unfilmed),
            alternatives=lighter,
            seed=specification.validation.seed or 0,
            files={},
            package_paths=package_paths,
        )
        with steps.step("write the report"):
            _write_instructions(robot, device, design, staging)
            design = _write_report(design, robot, runs, staging, command)
        (staging / DESIGN_FILE).write_bytes(design_to_json(design))
    return Outcome(design, folder, robot, device, runs)


@dataclass(frozen=True, eq=False)
class _Sized:
    """A robot, its device and where that stands, what is to be said of it, and its jumps."""

    robot: Robot
    resolved: Resolved
    designed: Designed
    mounting: Mounting
    remarks: tuple[str, ...]
    jumping: "JumpPlanning | None"


def _sized_or_advised(
    specification: Specification, robot: Robot, steps: Steps, *, strict: bool
) -> _Sized:
    """Size the device; if nothing meets the specification, search for what would."""
    with steps.step("size the device") as step:
        try:
            sized = _size(specification, robot, strict=strict)
        except Refused as error:
            refused, step.note = error, "nothing meets the specification"
        else:
            step.note = _what_was_sized(sized.designed)
            return sized
    with steps.step("look for the smallest changes that would do") as step:
        advised = refused.advised(step.update)
    if robot.warnings:
        odd = "`ocs-design inspect` warns of what is odd in the robot's file, which may be why."
        advised.hint = f"{odd} {advised.hint}"
    raise advised


def _size(specification: Specification, robot: Robot, *, strict: bool) -> _Sized:
    """What was asked for, the device that does it, and its place on the robot."""
    resolved = resolve(specification, robot, size(robot.tree, robot.posture, robot.trunk))
    require_trot(resolved.requirement.maneuvers, robot)
    jumping = _begin_jumps(specification.validation, robot, resolved)
    try:
        designed = design_device(specification, robot, resolved, advise=False)
        device = designed.device
        if jumping is not None:
            jumping.carry(device)
        device_warnings(device, robot.mass_properties, strict=strict)
        mounting = mounting_of(robot, device, resolved.requirement.maneuvers, designed.sized.total)
        remarks = placement_warnings(
            mounting,
            robot,
            device,
            resolved.envelope,
            stated=specification.ocs.position is not None,
            strict=strict,
        )
    except BaseException:
        if jumping is not None:
            jumping.cancel()
        raise
    forget_collision_model()
    return _Sized(robot, resolved, designed, mounting, remarks, jumping)


def _begin_jumps(
    stated: ValidationSection, robot: Robot, resolved: Resolved
) -> "JumpPlanning | None":
    """The jumps, which are planned while the device is sized; None where none will be flown."""
    if stated.enabled is False or control_of(stated, robot).ballistic:
        return None
    # CasADi takes a third of a second to import, and what starts at lift-off does without.
    from ocs_design.jumping.planning import JumpPlanning  # noqa: PLC0415

    return JumpPlanning(robot, resolved.requirement.maneuvers)


def _prove(
    sized: _Sized,
    stated: ValidationSection,
    plans: Mapping[str, "Reference"],
    folder: Path,
    steps: Steps,
) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """The flights, written and filmed as asked for, and why a film is missing."""
    if stated.enabled is False:
        return (), ()
    robot, device = sized.robot, sized.designed.device
    maneuvers = sized.resolved.requirement.maneuvers
    control = control_of(stated, robot)
    with steps.step("plan the jumps") as step:
        jumps = {} if sized.jumping is None else sized.jumping.plans()
        step.note = _who_flies(jumps)
    with steps.step("fly the maneuvers with and without the device") as step:
        runs = run_scenarios(
            robot,
            device,
            maneuvers,
            options=replace(flight_options(control), pose_rate=POSE_RATE),
            references=trajectories(plans),
            jumps=jumps,
            progress=step.update,
        )
        write_runs(runs, folder)
    if not stated.video:
        return runs, ()
    with steps.step("film the flights"):
        return runs, film_or_tell(robot, device, maneuvers, runs, folder / "validation")


def load_solvers(specification: Specification) -> None:
    """Import what sizing will need: that takes most of the time of a first design."""
    if specification.motor.name == NO_MOTOR:
        load_solver()
    else:
        import_module("ocs_design.sizing.trajectory.plans")


def _write_formats(robot: Robot, device: Device, folder: Path) -> tuple[str, ...]:
    """What is to be told of the files; the model that they are written from is let go of."""
    subject = Subject.of(robot, device, safe_name(robot.name))
    return export_formats(
        subject, [each for each in USUAL_FORMATS if not each.needs_margins], folder
    )


def _write_instructions(robot: Robot, device: Device, design: OcsDesign, folder: Path) -> None:
    """What tells of the flights too: the bill of materials and the assembly."""
    subject = Subject.of(robot, device, safe_name(robot.name))
    export_formats(
        subject.recorded(design),
        [each for each in USUAL_FORMATS if each.needs_margins],
        folder,
    )


def _what_was_sized(designed: Designed) -> str:
    if designed.choice is None:
        return ""
    return f"{designed.choice.selection.candidates:,} combinations"


def _plan(sized: _Sized) -> Mapping[str, "Reference"]:
    """The turns that the flights track; without a motor's figures there is nothing to plan for."""
    if sized.designed.choice is None:
        return {}
    # CasADi takes a third of a second to import, and wheels without a motor do without.
    from ocs_design.sizing.trajectory.plans import plan  # noqa: PLC0415

    requirement = sized.resolved.requirement
    return plan(
        sized.robot.mass_properties,
        sized.designed.device,
        requirement.maneuvers,
        requirement.standing_height,
    )


def _who_flies(jumps: Mapping[str, JumpPlans]) -> str:
    """Which jumps the legs do not make."""
    names = [name for name, plans in jumps.items() if plans.carrying.legs is None]
    return f"at lift-off starts: {', '.join(names)}" if names else ""


def _write_report(
    design: OcsDesign, robot: Robot, runs: Sequence[Run], folder: Path, command: str
) -> OcsDesign:
    """Figures and report; the design with the hashes of all files but the report, which has it."""
    story = story_in(
        [folder], design, flights=flights_of(runs), postures=posture_lines(robot), command=command
    )
    write_svgs(tuple(all_charts(story)), folder / FOLDER)
    whole = replace(design, files=recorded_hashes(folder))
    write_report(replace(story, design=whole), folder)
    return whole
