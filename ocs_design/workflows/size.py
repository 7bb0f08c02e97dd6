"""The whole chain on one page: read, require, size, export, prove, record."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.common.files import AnyPath, safe_name, to_json
from ocs_design.device.answers import MonteCarloRecord
from ocs_design.device.checks import device_warnings
from ocs_design.device.device import Device
from ocs_design.device.naming import require_no_device
from ocs_design.device.records import (
    DESIGN_FILE,
    Lighter,
    OcsDesign,
    Owed,
    SurvivalRecord,
    falls_short,
)
from ocs_design.export.assembly.content import assembly_of
from ocs_design.export.folder import check_target, recorded_hashes, staged_folder
from ocs_design.export.formats import USUAL_FORMATS, Subject, export_formats
from ocs_design.jumping.jump import JumpPlans
from ocs_design.monte_carlo.campaign import Campaign, write_results
from ocs_design.monte_carlo.certificate import (
    ROUND,
    ROUNDS,
    SequentialTest,
    certificate,
    lesson,
)
from ocs_design.monte_carlo.outcomes import Outcomes, blocks_of
from ocs_design.monte_carlo.running import ThisMachine, run_campaign
from ocs_design.monte_carlo.summary import summarised
from ocs_design.report.charts.figures import FOLDER, all_charts
from ocs_design.report.charts.files import write_svgs
from ocs_design.report.html.notebook import as_html
from ocs_design.report.html.page import write_report
from ocs_design.report.story import flights_of, story_in
from ocs_design.report.text.console import Steps, Tell
from ocs_design.report.video.film import film_or_tell
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.maneuver import (
    Disturbance,
    End,
    Maneuver,
    Pivoted,
    Requirement,
    StandUp,
    TurnTo,
)
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.resolving import Resolved, read_specified_robot, resolve
from ocs_design.requirement.specification import (
    AUTO,
    LIGHTEST,
    MORE_PAIRS,
    NO_MOTOR,
    PYRAMID,
    RELIABILITY,
    WHEELS,
    Specification,
    ValidationSection,
)
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.uncertainty import complete_uncertainty, uncertainty_texts
from ocs_design.robot.collision import forget_collision_model
from ocs_design.robot.links import listed
from ocs_design.robot.meshes import size
from ocs_design.robot.robot import Robot
from ocs_design.simulation.engine import POSE_RATE, Progress
from ocs_design.simulation.scenario import Run
from ocs_design.simulation.trotting import require_trot
from ocs_design.sizing.alternatives import alternatives, owed_to
from ocs_design.sizing.bound.rim_program import load_solver
from ocs_design.sizing.design import CannotSurvive, design_device
from ocs_design.sizing.lighter import lighter_by
from ocs_design.sizing.mounting import Mounting, mounting_of, placement_warnings
from ocs_design.sizing.on_robot import NeverHeld
from ocs_design.sizing.reserve import Reserve
from ocs_design.sizing.selection.advice import NO_ROOM, Refused, unasked
from ocs_design.sizing.sized import Designed
from ocs_design.workflows.flying import Flights, control_of, flown_hash, trajectories
from ocs_design.workflows.inspect import posture_lines
from ocs_design.workflows.recording import record_design, write_runs

CERTIFICATE_FOLDER = "certificate"
"""Folder of the many flights of `--certify`."""

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
        """0, or 1 if it cannot be built, or does not pass as designed or as it might be built."""
        found = self.design
        failed = falls_short(found.validation, found.survival, found.reliability)
        return int(failed or found.buildable.yes is False)

    def __fspath__(self) -> str:
        """Its folder: an outcome stands wherever the path of a design is asked for."""
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
    progress: Steps | Tell | None = None,
    command: str = "",
) -> Outcome:
    """Size a device for a robot, write it, fly it, and record all of it in one folder.

    Args:
        design_for: a specification (`specify`, `read_specification`), the path of its TOML file, or
            that of a robot with nothing else stated.
        out: the folder; None: `<name>-ocs` in the working directory.
        package_paths: folder of each package that `package://` addresses name.
        force: replace an existing output folder, once the new one is complete.
        strict: warnings are errors.
        progress: function that is told the name of the step that runs and what part of it is done,
            0..1; None: a notebook shows it below the cell, and a script is silent.
        command: that was typed, for the report.

    Raises:
        OcsError: see `exceptions`; nothing is written then.
    """
    specification = specification_of(design_for)
    paths = {name: Path(path) for name, path in (package_paths or {}).items()}
    stated = specification.validation
    flying = {"--video films the": stated.video, "--certify repeats the": stated.certify}
    for what, wanted in flying.items():
        if wanted and stated.enabled is False:
            raise UsageError(
                f"{what} flights, and --no-validate flies none", hint="leave one of them out"
            )
    steps = Steps.of(progress)
    if out is not None:
        check_target(Path(out), force=force)
    with steps.step("read the robot") as step:
        robot = read_specified_robot(specification, package_paths=paths, strict=strict)
        folder = Path(out or f"{safe_name(robot.name)}-ocs")
        check_target(folder, force=force)
        require_no_device(robot.tree.joints)
        step.note = f"{robot.name}: {len(robot.tree.joints)} joints, {len(robot.legs)} legs"
    steps.doubt(robot.warnings)
    specification, sized = _sized_or_advised(specification, robot, steps, strict=strict)
    sized = _large_enough(sized, specification, steps, strict=strict)
    proof = _prove(sized, stated, steps)
    if proof.runs and stated.certify:
        sized, proof = _certify(sized, proof, specification, steps, strict=strict)
    device, runs = sized.designed.device, proof.runs
    with staged_folder(folder, force=force) as staging:
        with steps.step("export parts and robot files"):
            remarks = _write_formats(robot, device, staging)
            robot = replace(robot, warnings=(*robot.warnings, *remarks))
        unfilmed = _write_flights(sized, proof, stated, staging, steps)
        with steps.step("look for what would be lighter otherwise"):
            lighter = alternatives(specification, sized.resolved, sized.designed, sized.robot)
            owed = owed_to(sized.designed, sized.robot)
        conceded = _what_must_give(specification, sized, owed, steps)
        forget_collision_model()
        control = control_of(stated, robot)
        design = record_design(
            robot,
            sized.resolved,
            sized.designed,
            runs,
            plans=proof.plans,
            control=control,
            uncertainty=uncertainty_texts(
                complete_uncertainty(specification.reality, standing_height(robot), device.motor)
            ),
            mounting=sized.mounting,
            warnings=(*_unmade(sized, proof.plans), *sized.remarks, *unfilmed),
            alternatives=lighter,
            owed=owed,
            lighter=conceded,
            seed=stated.seed or 0,
            files={},
            package_paths=paths,
        )
        if proof.survival is not None:
            alone = _mass_without_survival(specification, sized, steps)
            design = replace(design, survival=replace(proof.survival, mass_without=alone))
        if proof.certificate is not None:
            flown = proof.certificate
            design = replace(design, reliability=flown.record.certificate)
            (staging / CERTIFICATE_FOLDER).mkdir()
            write_results(
                flown.campaign,
                flown.outcomes,
                flown.record,
                staging / CERTIFICATE_FOLDER,
                design=flown_hash(design, control),
            )
        with steps.step("write the report"):
            # What tells of the flights too: the bill of materials and the assembly.
            told = Subject.of(robot, device, safe_name(robot.name)).recorded(design)
            export_formats(told, [each for each in USUAL_FORMATS if each.needs_margins], staging)
            design = _write_report(design, told, runs, staging, command)
        (staging / DESIGN_FILE).write_bytes(to_json(design))
    return Outcome(design, folder, robot, device, runs)


@dataclass(frozen=True, eq=False)
class _Sized:
    """A robot, its device and where that stands, what is to be said of it, and its jumps.

    `estimates` has the factor on what a turn is estimated to ask for, by its name.
    """

    robot: Robot
    resolved: Resolved
    designed: Designed
    mounting: Mounting
    remarks: tuple[str, ...]
    jumping: "JumpPlanning | None"
    estimates: Mapping[str, float] = field(default_factory=dict)


def _sized_or_advised(
    specification: Specification, robot: Robot, steps: Steps, *, strict: bool
) -> tuple[Specification, _Sized]:
    """Size the device; if nothing meets the specification, search for what would.

    Returns:
        Specification with what was taken of all that is tried, see `_attempts`, and what it came
        to.
    """
    tried: list[tuple[Specification, Refused | NeverHeld]] = []
    for asked in _attempts(specification, tried):
        more = asked.ocs.layout if asked.ocs.layout != specification.ocs.layout else None
        lightest = asked.ocs.alpha_criterion != specification.ocs.alpha_criterion
        less = asked.requirement.reliability if tried else None
        less = None if less == specification.requirement.reliability else less
        what = "the device" if more is None else f"a device of {WHEELS[more]} wheels"
        what = f"{what}{' at its lightest incidence' * lightest}"
        what = what if less is None else f"{what} for {less:.0%} of robots"
        with steps.step(f"size {what}") as step:
            try:
                sized = _size(asked, robot, strict=strict)
            except (Refused, NeverHeld) as error:
                tried.append((asked, error))
                step.note = "nothing meets the specification"
                continue
            except CannotSurvive as error:
                step.note = "nothing meets the specification"
                if tried:
                    continue
                error.hint = f"{_survivors(specification, robot, step.update)} {error.hint}"
                raise
            step.note = _what_was_sized(sized.designed)
        if not tried:
            return specification, sized
        told, few = _instead(specification, asked, tried)
        resolved = sized.resolved
        resolved = replace(resolved, assumptions=(*told, *resolved.assumptions))
        return asked, replace(sized, resolved=resolved, remarks=(*few, *sized.remarks))
    # What lacks room is told of what was asked for, what is too weak of what came closest. What got
    # as far as to what holds it on the trunk came closer than what no motor drives without.
    refused = [error for _, error in tried if isinstance(error, Refused)]
    if not refused:
        raise tried[0][1]
    closest = refused[0]
    if closest.nearest.reason not in NO_ROOM:
        held = [each for each in refused if each.problem.robot.mass > robot.mass]
        at_angle = [each for each in refused if each.problem.incidence is not None]
        closest = min(held or at_angle, key=lambda each: each.nearest.shortfall, default=closest)
    with steps.step("look for the smallest changes that would do") as step:
        advised = closest.advised(
            step.update,
            default=specification.asks_nothing,
            lightest=all(each.problem.incidence is not None for each in refused),
        )
    advised.assumptions, advised.warnings = closest.assumptions, closest.warnings
    raise advised


def _instead(
    specification: Specification,
    asked: Specification,
    tried: Sequence[tuple[Specification, Infeasible]],
) -> tuple[list[str], list[str]]:
    """What was taken in place of what was stated, as assumptions and as remarks, and why."""
    told: list[str] = []
    few: list[str] = []
    more, less = asked.ocs.layout, asked.requirement.reliability
    if more is not None and more != specification.ocs.layout:
        with_two = f"With two: {tried[0][1].message}"
        told.append(f"Layout: {more}, {WHEELS[more]} wheels. {with_two}")
        if specification.motor.name not in {None, AUTO}:
            few.append(f"{WHEELS[more]} wheels are needed. {with_two}")
    criterion = specification.ocs.alpha_criterion
    if asked.ocs.alpha_criterion != criterion:
        at_alpha = replace(asked.ocs, alpha_criterion=criterion)
        refused = (error.message for each, error in tried if each.ocs == at_alpha)
        why = next(refused, tried[-1][1].message)
        told.append(f"Incidence: the lightest. At alpha*: {why}")
    if less is not None and less != specification.requirement.reliability:
        why = next(error.message for each, error in tried if each.ocs == asked.ocs)
        told.append(f"Reliability: {less:.0%} of robots. For {RELIABILITY:.0%}: {why}")
        few.append(f"sized for {less:.0%} of robots: for {RELIABILITY:.0%} there is no device")
    return told, few


LESS_SURE = (0.9, 0.8)
"""Reliabilities that are tried in turn where no device has the default one."""


def _attempts(
    specification: Specification, tried: Sequence[tuple[Specification, Infeasible]]
) -> Iterator[Specification]:
    """What was asked for, and what is tried in turn where that was refused.

    Where neither layout nor incidence is stated, the lightest incidence and more pairs. Where no
    reliability is, a smaller one for all that its reserve alone stood in the way of.

    Args:
        specification: what was stated.
        tried: what has been refused so far, and how.
    """
    yield specification
    yield from _more(specification)
    if specification.requirement.reliability is not None:
        return
    short = [asked for asked, error in tried if isinstance(error, Refused) and error.for_reserve]
    for level in LESS_SURE:
        for asked in short:
            yield replace(asked, requirement=replace(asked.requirement, reliability=level))


def _more(specification: Specification) -> Iterator[Specification]:
    """What is tried in turn instead: the lightest incidence, and layouts of more pairs.

    Only what is not stated changes, and only as far as all that is stated allows it.
    """
    stated = specification.ocs
    if stated.layout is not None or stated.axes is not None:
        return
    free = stated.alpha is None and stated.alpha_criterion is None
    for layout in (None, *MORE_PAIRS):
        for criterion in (stated.alpha_criterion, LIGHTEST)[: 1 + free]:
            ocs = replace(stated, layout=layout, alpha_criterion=criterion)
            asked = replace(specification, ocs=ocs)
            if ocs != stated and not any(contradictions(asked)):
                yield asked


SURVIVORS = ("triad", *MORE_PAIRS[:1], PYRAMID)
"""Layouts that reach roll and pitch with any one wheel left out, the fewest wheels first."""


def _survivors(specification: Specification, robot: Robot, progress: Progress) -> str:
    """What would survive a stopped drive, with its mass, in place of a layout that cannot."""
    masses: dict[str, float] = {}
    for done, layout in enumerate(SURVIVORS):
        progress(done / len(SURVIVORS))
        ocs = replace(
            specification.ocs, layout=layout, axes=None, position=None, alpha=None,
            alpha_criterion=None,
        )  # fmt: skip
        asked = replace(specification, ocs=ocs)
        if any(contradictions(asked)):
            continue
        resolved = resolve(asked, robot, size(robot.tree, robot.posture, robot.trunk))
        with suppress(Infeasible):
            designed = design_device(asked, robot, resolved, advise=False, ranked=False)
            masses[layout] = designed.device.mass
    if not masses:
        return "No layout that survives it has a device either."
    told = listed([f"`--layout {name}` {1e3 * mass:.0f} g" for name, mass in masses.items()])
    return (
        f"What survives it weighs: {told}. At which instants a device that need not survive lands "
        "all the same, `validate DESIGN --survives one` tells."
    )


def _unmade(sized: _Sized, plans: Mapping[str, "Reference"]) -> Iterator[str]:
    """Turns that the device does not make, with the time that they would take."""
    for maneuver in sized.resolved.requirement.maneuvers:
        planned = plans.get(maneuver.name)
        if planned is None or planned.trajectory is not None:
            continue
        if isinstance(maneuver, TurnTo | StandUp):
            yield f"{maneuver.name}: {planned.note}"


TURN_ROUNDS = 3
"""How often a device is sized anew for turns that it cannot make."""

LEAST_SPARE, SPARE = 0.9, 1.1
"""Share of the drives that the plan of a heading may take, and factor where it takes more."""


def _large_enough(
    sized: _Sized, specification: Specification, steps: Steps, *, strict: bool
) -> _Sized:
    """The device, sized anew with more for each turn that takes too much of it, or too long."""
    for _ in range(TURN_ROUNDS):
        asked = sized.resolved.requirement.maneuvers
        estimates = dict(sized.estimates)
        turns = {each.name: each for each in asked if isinstance(each, TurnTo | StandUp)}
        for name, planned in _plan(sized, list(turns.values())).items():
            # Momentum goes with the inverse of the time, torque with its square.
            more = SPARE if planned.needed is None else SPARE * planned.needed**1.5
            # What falls over from most tilts tells little.
            more = more if planned.part is None else SPARE / max(planned.part, 0.5)
            headed = turns[name].end != End.LEVEL
            if planned.trajectory is None or (headed and planned.share > LEAST_SPARE):
                estimates[name] = more * estimates.get(name, 1.0)
        if estimates == sized.estimates:
            break
        with steps.step("size the device anew for its turns") as step:
            try:
                sized = _size(specification, sized.robot, strict=strict, estimates=estimates)
            except (Refused, NeverHeld):
                step.note = "nothing makes them in time"
                break
    return sized


def _size(
    specification: Specification,
    robot: Robot,
    *,
    strict: bool,
    reserve: Reserve | None = None,
    estimates: Mapping[str, float] | None = None,
) -> _Sized:
    """What was asked for, the device that does it, and its place on the robot."""
    resolved = resolve(specification, robot, size(robot.tree, robot.posture, robot.trunk))
    factors = estimates or {}
    maneuvers = tuple(
        replace(each, estimate=factors.get(each.name, 1.0))
        if isinstance(each, TurnTo | Pivoted)
        else each
        for each in resolved.requirement.maneuvers
    )
    resolved = replace(resolved, requirement=replace(resolved.requirement, maneuvers=maneuvers))
    require_trot(resolved.requirement.maneuvers, robot)
    jumping = _begin_jumps(specification.validation, robot, resolved)
    try:
        designed = design_device(specification, robot, resolved, advise=False, reserve=reserve)
        device = designed.device
        if designed.requirement is not None:
            own = designed.requirement
            told = tuple(_kicked(each, own) for each in resolved.assumptions)
            resolved = replace(resolved, requirement=own, assumptions=told)
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
    except BaseException as error:
        if jumping is not None:
            jumping.cancel()
        if isinstance(error, Infeasible):
            error.assumptions, error.warnings = resolved.assumptions, robot.warnings
            if specification.asks_nothing and not isinstance(error, Refused):
                error.hint = f"{unasked(resolved.requirement.maneuvers)} {error.hint}"
        raise
    forget_collision_model()
    return _Sized(robot, resolved, designed, mounting, remarks, jumping, factors)


def _kicked(assumption: str, requirement: Requirement) -> str:
    """An assumption; that of a kick with what the kick is on robot and device."""
    for kick in requirement.maneuvers:
        if not isinstance(kick, Disturbance) or not any(kick.impulse):
            continue
        if assumption.startswith(f"{kick.name}: "):
            turned = ", ".join(f"{each * kick.duration:.3g}" for each in kick.torque)
            moved = np.linalg.norm(kick.velocity_change)
            told = f"with the device on, ({turned}) N m s and {moved:.3g} m/s"
            return f"{assumption.removesuffix('.')}; {told}."
    return assumption


def _what_must_give(
    specification: Specification, sized: _Sized, owed: Owed | None, steps: Steps
) -> Lighter | None:
    """What would have to give for a lighter device, where that was asked."""
    by, choice, robot = specification.ocs.lighter_by, sized.designed.choice, sized.robot
    if by is None or choice is None:
        return None
    extent = size(robot.tree, robot.posture, robot.trunk)
    task = Task(specification, sized.resolved, robot, extent)
    with steps.step("look for what would have to give") as step:
        return Lighter(
            by=by,
            changes=lighter_by(by, task, choice, owed.maneuver if owed else "", step.update),
        )


def _mass_without_survival(
    specification: Specification, sized: _Sized, steps: Steps
) -> float | None:
    """Mass of the lightest device that need not survive a stopped drive [kg], if there is one."""
    requirement = replace(sized.resolved.requirement, detection=None)
    resolved = replace(sized.resolved, requirement=requirement)
    with steps.step("size a device that need not survive"), suppress(Infeasible):
        free = design_device(specification, sized.robot, resolved, advise=False, ranked=False)
        return free.device.mass
    return None


def _begin_jumps(
    stated: ValidationSection, robot: Robot, resolved: Resolved
) -> "JumpPlanning | None":
    """The jumps, which are planned while the device is sized; None where none will be flown."""
    if stated.enabled is False or control_of(stated, robot).ballistic:
        return None
    # CasADi takes a third of a second to import, and what starts at lift-off does without.
    from ocs_design.jumping.planning import JumpPlanning  # noqa: PLC0415

    return JumpPlanning(robot, resolved.requirement.maneuvers)


@dataclass(frozen=True, eq=False)
class _Certificate:
    """Many flights of a device, and what they say."""

    campaign: Campaign
    outcomes: Outcomes
    record: MonteCarloRecord


@dataclass(frozen=True, eq=False)
class _Proof:
    """How a device is to fly, how it does as designed, and its certificate."""

    plans: Mapping[str, "Reference"]
    flights: Flights
    runs: tuple[Run, ...] = ()
    survival: SurvivalRecord | None = None
    certificate: _Certificate | None = None


def _prove(sized: _Sized, stated: ValidationSection, steps: Steps) -> _Proof:
    """Plan the maneuvers and fly them, if that is wanted."""
    requirement, jumps = sized.resolved.requirement, dict[str, JumpPlans]()
    with steps.step("plan the maneuvers"):
        plans = _plan(sized, requirement.maneuvers)
    if stated.enabled is not False:
        with steps.step("plan the jumps") as step:
            jumps = {} if sized.jumping is None else dict(sized.jumping.plans())
            others = [name for name, jump in jumps.items() if jump.carrying.legs is None]
            step.note = f"at lift-off starts: {', '.join(others)}" if others else ""
    flights = Flights(
        robot=sized.robot,
        device=sized.designed.device,
        maneuvers=requirement.maneuvers,
        control=control_of(stated, sized.robot),
        references=trajectories(plans),
        jumps=jumps,
        detection=requirement.detection,
    )
    if stated.enabled is False:
        return _Proof(plans, flights)
    runs = flights.fly(steps, pose_rate=POSE_RATE)
    return _Proof(plans, flights, runs, flights.fly_stopped(steps))


def _certify(
    sized: _Sized, proof: _Proof, specification: Specification, steps: Steps, *, strict: bool
) -> tuple[_Sized, _Proof]:
    """Fly robots as they might be built; what falls short is sized anew with more in reserve.

    Returns:
        Device of the last round and its flights.
    """
    robot, stated = sized.robot, specification.validation
    test = SequentialTest(sized.resolved.reliability or RELIABILITY)
    told: list[str] = []
    for number in range(1, ROUNDS + 1):
        campaign = proof.flights.campaign(proof.runs, specification.reality, stated.seed or 0)
        with steps.step(f"fly the certificate, round {number}") as step:
            flown = run_campaign(
                campaign,
                blocks_of(test.most, first=number * ROUND),
                workers=ThisMachine(),
                enough=test.decided,
                progress=step.update,
            )
            found = certificate(test, campaign, flown, number=number)
            step.note = f"{found.verdict}, {found.whole:,} of {found.samples:,} pass"
        reserve, learnt = sized.designed.reserve, None
        if found.verdict == "falls short" and number < ROUNDS and reserve is not None:
            learnt = lesson(test, campaign, flown)
            told.append(f"round {number}: {step.note}; {learnt.told}")
        outcomes = flown.take(slice(found.samples))
        found = replace(found, rounds=tuple(told))
        record = replace(summarised(campaign, outcomes, test.most), certificate=found)
        proof = replace(proof, certificate=_Certificate(campaign, outcomes, record))
        if reserve is None or learnt is None or learnt.factor == 1.0:
            break
        with steps.step("size the device with more in reserve") as step:
            try:
                again = _size(
                    specification,
                    robot,
                    strict=strict,
                    reserve=reserve.raised(learnt.factor),
                    estimates=sized.estimates,
                )
            except (Refused, NeverHeld):
                step.note = "nothing has that reserve"
                break
            step.note = _what_was_sized(again.designed)
        sized, proof = again, _prove(again, stated, steps)
    return sized, proof


def _write_flights(
    sized: _Sized, proof: _Proof, stated: ValidationSection, folder: Path, steps: Steps
) -> tuple[str, ...]:
    """Write the flights as designed, film them if asked for; why a film is missing."""
    if not proof.runs:
        return ()
    write_runs(proof.runs, folder, proof.survival)
    if not stated.video:
        return ()
    with steps.step("film the flights"):
        return film_or_tell(
            sized.robot,
            sized.designed.device,
            sized.resolved.requirement.maneuvers,
            proof.runs,
            folder / "validation",
        )


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


def _what_was_sized(designed: Designed) -> str:
    if designed.choice is None:
        return ""
    return f"{designed.choice.selection.candidates:,} combinations"


def _plan(sized: _Sized, maneuvers: Sequence[Maneuver]) -> Mapping[str, "Reference"]:
    """The turns that the flights track; without a motor's figures there is nothing to plan for."""
    if sized.designed.choice is None or not maneuvers:
        return {}
    # CasADi takes a third of a second to import, and wheels without a motor do without.
    from ocs_design.sizing.trajectory.plans import plan  # noqa: PLC0415

    requirement, kept = sized.resolved.requirement, sized.designed.kept
    return plan(
        sized.robot.mass_properties,
        sized.designed.device,
        maneuvers,
        requirement.standing_height,
        None if kept is None else kept.demands,
        one_stops=requirement.detection is not None,
    )


def _write_report(
    design: OcsDesign, subject: Subject, runs: Sequence[Run], folder: Path, command: str
) -> OcsDesign:
    """Figures and report; the design with the hashes of all files but the report, which has it."""
    story = story_in(
        [folder],
        design,
        flights=flights_of(runs),
        postures=posture_lines(subject.carrier),
        command=command,
        assembly=assembly_of(subject),
    )
    write_svgs(tuple(all_charts(story)), folder / FOLDER)
    whole = replace(design, files=recorded_hashes(folder))
    write_report(replace(story, design=whole), folder)
    return whole
