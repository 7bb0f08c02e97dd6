"""Rounds of sizing and flying, until the device meets the requirement.

A device is sized for one attempt after another until one succeeds, resized for turns that it cannot
make, and resized with a larger reserve for sampled robots that fail.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.common.errors import Infeasible, SpecificationError, UsageError
from ocs_design.common.units import format_quantity
from ocs_design.device.answers import CERTIFICATE_FOLDER, MonteCarloRecord
from ocs_design.device.checks import device_warnings
from ocs_design.device.records.flights import Conclusion, SurvivalRecord
from ocs_design.jumping.jump import JumpPlans
from ocs_design.monte_carlo.campaign import Campaign, write_results
from ocs_design.monte_carlo.certificate import (
    ROUND_STRIDE,
    ROUNDS,
    SequentialTest,
    certificate,
    lesson,
)
from ocs_design.monte_carlo.outcomes import Outcomes, blocks_of
from ocs_design.monte_carlo.running import run_campaign
from ocs_design.monte_carlo.summary import summarise
from ocs_design.report.text.console import Steps
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.sections import ValidationSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import RELIABILITY
from ocs_design.robot.collision import forget_collision_model
from ocs_design.robot.meshes import longest_side
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run
from ocs_design.simulation.simulate import POSE_RATE
from ocs_design.simulation.trotting import require_trot
from ocs_design.simulation.world_builder import Options, control_of
from ocs_design.sizing.advice import defaults_text
from ocs_design.sizing.design import design_device, layouts_that_survive
from ocs_design.sizing.fallbacks import (
    Attempt,
    advised,
    attempt_text,
    attempts,
    closest_refusal,
    more_wheels_may_do,
    substitutions,
    with_lower_reliability,
)
from ocs_design.sizing.mounting import DeviceMounting, mounting_of, placement_warnings
from ocs_design.sizing.on_robot import NoMountHolds
from ocs_design.sizing.reserve import Reserve
from ocs_design.sizing.selection.rejections import Refused
from ocs_design.sizing.sized import Designed
from ocs_design.sizing.specified import CannotSurvive
from ocs_design.workflows.flying import PlannedFlights, planned_turns, trajectories

if TYPE_CHECKING:
    from ocs_design.jumping.planning import JumpPlanning
    from ocs_design.sizing.trajectory.plans import Reference


@dataclass(frozen=True, eq=False)
class PlacedDevice:
    """A device mounted on its robot.

    Attributes:
        specification: that it was sized for, including fallbacks for what was not specified.
        robot, resolved, designed, mounting: the live values.
        warnings: about its position, and about the fallbacks.
        jumping: planning of its jumps, in progress or done; None: no jump will be flown.
        estimates: factor on the estimated demand of each turn, by name.
        substitutions: the fallbacks for what was not specified, as assumptions and as warnings.
    """

    specification: Specification
    robot: Robot
    resolved: Resolved
    designed: Designed
    mounting: DeviceMounting
    warnings: tuple[str, ...]
    jumping: "JumpPlanning | None"
    estimates: Mapping[str, float] = field(default_factory=dict)
    substitutions: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())

    def with_substitutions(
        self, substitutions: tuple[tuple[str, ...], tuple[str, ...]]
    ) -> "PlacedDevice":
        """This device with the assumptions and warnings of substitutions before its own."""
        assumptions, warnings = substitutions
        resolved = replace(self.resolved, assumptions=(*assumptions, *self.resolved.assumptions))
        return replace(
            self,
            resolved=resolved,
            warnings=(*warnings, *self.warnings),
            substitutions=substitutions,
        )

    def cancel(self) -> None:
        """Start no further plans of its jumps."""
        if self.jumping is not None:
            self.jumping.cancel()

    @property
    def task(self) -> Task:
        """The task that it was sized for."""
        robot = self.robot
        extent = longest_side(robot.tree, robot.posture, robot.trunk)
        return Task(self.specification, self.resolved, robot, extent)

    @property
    def combinations(self) -> str:
        """Number of combinations of parts that were examined, in words; empty without a motor."""
        choice = self.designed.choice
        return "" if choice is None else f"{choice.selection.candidates:,} combinations"


def size_on_robot(
    specification: Specification,
    robot: Robot,
    *,
    strict: bool,
    reserve: Reserve | None = None,
    estimates: Mapping[str, float] | None = None,
) -> PlacedDevice:
    """Size the device of a specification and place it; its jumps are planned in parallel.

    Args:
        reserve: to keep; None: the one for the specified reliability.
        estimates: factor on the estimated demand of each turn, by name; 1 for all others.

    Raises:
        Infeasible: there is none.
        OcsError: the maneuvers do not suit the robot, or with `strict` there is a warning.
    """
    factors = estimates or {}
    task = Task.of(specification, robot)
    resolved = task.resolved.estimated(factors)
    require_trot(resolved.requirement.maneuvers, robot)
    specified, jumping = specification.validation, None
    if specified.enabled is not False and not control_of(specified, robot).ballistic:
        # CasADi takes a third of a second to import, and flights from lift-off do not need it.
        from ocs_design.jumping.planning import JumpPlanning  # noqa: PLC0415

        # Jumps are planned while the device is sized.
        jumping = JumpPlanning(robot, resolved.requirement.maneuvers)
    try:
        designed = design_device(replace(task, resolved=resolved), reserve=reserve)
        device = designed.device
        if designed.requirement is not None:
            resolved = resolved.carrying(designed.requirement)
        if jumping is not None:
            jumping.carry(device)
        mounting = mounting_of(robot, device, resolved.requirement.maneuvers, designed.sized.total)
        placed = PlacedDevice(
            specification, robot, resolved, designed, mounting, (), jumping, factors
        )
        placed = replace(placed, warnings=warnings_of(placed, strict=strict))
    except BaseException as error:
        if jumping is not None:
            jumping.cancel()
        if isinstance(error, Infeasible):
            error.assumptions, error.warnings = resolved.assumptions, robot.warnings
            if specification.maneuvers_are_defaults and not isinstance(error, Refused):
                error.hint = f"{defaults_text(resolved.requirement.maneuvers)} {error.hint}"
        raise
    forget_collision_model()
    return placed


def warnings_of(placed: PlacedDevice, *, strict: bool) -> tuple[str, ...]:
    """Warnings about the position of a device.

    Raises:
        SpecificationError: `strict`, and there is one, or the device is heavy for its robot.
    """
    robot, device = placed.robot, placed.designed.device
    device_warnings(device, robot.mass_properties, strict=strict)
    return placement_warnings(
        placed.mounting,
        robot,
        device,
        placed.resolved.envelope,
        specified=placed.specification.ocs.position is not None,
        strict=strict,
    )


def size_or_advise(
    specification: Specification, robot: Robot, steps: Steps, *, strict: bool
) -> PlacedDevice:
    """Size the device; if nothing meets the specification, try the fallbacks in turn.

    If a device's motors are heavy for the robot, more wheels are tried, too, until that makes it
    heavier, and the lightest device is taken.

    Raises:
        Infeasible: no attempt gives a device; with the smallest changes that would.
        SpecificationError: `strict`, and there is a warning about the final device.
    """
    best, tried = _lightest_attempt(attempts(specification), specification, robot, steps)
    if best is None:
        best, tried_again = _lightest_attempt(
            with_lower_reliability(specification, tried), specification, robot, steps
        )
        tried += tried_again
    if best is not None:
        if strict:
            try:
                warnings_of(best, strict=True)
            except SpecificationError:
                best.cancel()
                raise
        return best.with_substitutions(substitutions(specification, best.specification, tried))
    refusal = closest_refusal(tried, robot.mass)
    with steps.step("search for the smallest changes that make it feasible") as step:
        advised_refusal = advised(refusal, specification, tried, step.update)
    raise advised_refusal


def _lightest_attempt(
    in_turn: Iterable[Specification], specification: Specification, robot: Robot, steps: Steps
) -> tuple[PlacedDevice | None, list[Attempt]]:
    """The device of the first attempt that gives one, or of more wheels that are lighter.

    Returns:
        The device, None if there is none, and the attempts whose device was not taken.
    """
    tried: list[Attempt] = []
    best: PlacedDevice | None = None
    for attempt in in_turn:
        if best is not None:
            best_specification = best.specification
            if (
                attempt.ocs.layout == best_specification.ocs.layout
                or attempt.requirement != best_specification.requirement
            ):
                continue
        with steps.step(f"size {attempt_text(specification, attempt)}") as step:
            try:
                # A device that is replaced by a lighter one need not be free of warnings.
                placed = size_on_robot(attempt, robot, strict=False)
            except (Refused, NoMountHolds) as error:
                tried.append(Attempt(attempt, error.message, error))
                step.note = "nothing meets the specification"
                continue
            except CannotSurvive as error:
                step.note = "nothing meets the specification"
                if tried:
                    continue
                error.hint = (
                    f"{layouts_that_survive(specification, robot, step.update)} {error.hint}"
                )
                raise
            step.note = placed.combinations
        if best is None:
            best = placed
        else:
            best, heavier = sorted(
                (best, placed), key=lambda candidate: candidate.designed.device.mass
            )
            mass = format_quantity(heavier.designed.device.mass, "kg", digits=4)
            tried.append(Attempt(heavier.specification, f"{mass}."))
            heavier.cancel()
        if best is not placed or not more_wheels_may_do(best.designed.device, robot.mass):
            break
    return best, tried


TURN_ROUNDS = 3
"""Most times that a device is resized for turns that it cannot make."""


def size_for_turns(placed: PlacedDevice, steps: Steps, *, strict: bool) -> PlacedDevice:
    """Resize the device for turns that need too much of it, or take too long."""
    for _ in range(TURN_ROUNDS):
        maneuvers = placed.resolved.requirement.maneuvers
        estimates = dict(placed.estimates)
        turns = {maneuver.name: maneuver for maneuver in maneuvers if maneuver.estimated}
        for name, reference in turn_references(placed, list(turns.values())).items():
            factor = reference.missing_demand(turns[name].end)
            if factor is not None:
                estimates[name] = factor * estimates.get(name, 1.0)
        if estimates == placed.estimates:
            break
        with steps.step("resize the device for its turns") as step:
            larger = resized(placed, strict=strict, estimates=estimates)
            if larger is None:
                step.note = "no device makes them in time"
                break
        placed = larger
    return placed


def resized(
    placed: PlacedDevice,
    *,
    strict: bool,
    estimates: Mapping[str, float],
    reserve: Reserve | None = None,
) -> PlacedDevice | None:
    """The device sized again with other demands (`size_on_robot`); None: there is none."""
    try:
        larger = size_on_robot(
            placed.specification, placed.robot, strict=strict, reserve=reserve, estimates=estimates
        )
    except (Refused, NoMountHolds):
        return None
    return larger.with_substitutions(placed.substitutions)


def turn_references(
    placed: PlacedDevice, maneuvers: Sequence[Maneuver]
) -> Mapping[str, "Reference"]:
    """Planned turns that the flights track, by name; none without a motor's data."""
    if placed.designed.choice is None or not maneuvers:
        return {}
    robot, designed = placed.robot, placed.designed
    one_stops = placed.resolved.requirement.detection is not None
    return planned_turns(robot, designed.device, maneuvers, designed.kept, one_stops=one_stops)


def impossible_turns(placed: PlacedDevice, references: Mapping[str, "Reference"]) -> Iterator[str]:
    """Turns that the device cannot make in time, each with the time that it would take."""
    for maneuver in placed.resolved.requirement.maneuvers:
        reference = references.get(maneuver.name)
        if reference is None or reference.trajectory is not None:
            continue
        if maneuver.estimated:
            yield f"{maneuver.name}: {reference.note}"


@dataclass(frozen=True, eq=False)
class Certificate:
    """Many flights of a device, and their verdict."""

    campaign: Campaign
    outcomes: Outcomes
    record: MonteCarloRecord

    def write(self, folder: Path, design: str) -> None:
        """Write the flights into a subfolder of `folder`.

        Args:
            folder: an existing one. design: hash of the flown design (`flown_hash`).
        """
        subfolder = folder / CERTIFICATE_FOLDER
        subfolder.mkdir()
        write_results(self.campaign, self.outcomes, self.record, subfolder, design=design)


@dataclass(frozen=True, eq=False)
class FlightResults:
    """A device's flights as designed, what they were planned from, and its certificate.

    Attributes:
        references: planned turns that the flights track, by name of maneuver.
        flights: inputs of the flights. runs: as designed; empty if nothing is flown.
        survival: flights with each drive failing in turn; None: not required.
        certificate: None: not required.
    """

    references: Mapping[str, "Reference"]
    flights: PlannedFlights
    runs: tuple[Run, ...] = ()
    survival: SurvivalRecord | None = None
    certificate: Certificate | None = None


def plan_and_fly(placed: PlacedDevice, specified: ValidationSection, steps: Steps) -> FlightResults:
    """Plan the maneuvers and, if validation is enabled, fly them."""
    requirement, jumps = placed.resolved.requirement, dict[str, JumpPlans]()
    with steps.step("plan the maneuvers"):
        references = turn_references(placed, requirement.maneuvers)
    if specified.enabled is not False:
        with steps.step("plan the jumps") as step:
            jumps = {} if placed.jumping is None else dict(placed.jumping.plans())
            not_planned = [name for name, jump in jumps.items() if jump.carrying.legs is None]
            step.note = f"starting at lift-off: {', '.join(not_planned)}" if not_planned else ""
    control = control_of(specified, placed.robot)
    flights = PlannedFlights(
        placed.robot,
        placed.designed.device,
        requirement.maneuvers,
        Options.of_record(control),
        control=control,
        uncertainty=placed.specification.reality,
        seed=specified.seed or 0,
        references=trajectories(references),
        jumps=jumps,
        detection=requirement.detection,
    )
    if specified.enabled is False:
        return FlightResults(references, flights)
    runs = flights.fly(steps, pose_rate=POSE_RATE)
    return FlightResults(references, flights, runs, flights.fly_stopped(steps))


def certify(
    placed: PlacedDevice, results: FlightResults, steps: Steps, *, strict: bool
) -> tuple[PlacedDevice, FlightResults]:
    """Fly sampled robots; a device that falls short is resized with more reserve.

    Returns:
        Device of the last round and its flights.

    Raises:
        UsageError: there is no maneuver to fly.
    """
    specification = placed.specification
    specified = specification.validation
    if not results.runs:
        raise UsageError(
            "--certify repeats maneuvers, but none is specified",
            hint="leave it out, or add a maneuver, as in --fall 1m",
        )
    test = SequentialTest(placed.resolved.reliability or RELIABILITY)
    rounds: list[str] = []
    for number in range(1, ROUNDS + 1):
        campaign = results.flights.campaign(results.runs)
        with steps.step(f"fly the certificate, round {number}") as step:
            flown = run_campaign(
                campaign,
                blocks_of(test.most_flights, first=number * ROUND_STRIDE),
                stop_when=test.decided,
                progress=step.update,
            )
            reliability = certificate(test, campaign, flown, number=number)
            step.note = (
                f"{reliability.verdict}, {reliability.whole:,} of {reliability.samples:,} pass"
            )
        reserve, conclusion = placed.designed.reserve, None
        if reliability.verdict == Conclusion.SHORT and number < ROUNDS and reserve is not None:
            conclusion = lesson(test, campaign, flown)
            rounds.append(f"round {number}: {step.note}; {conclusion.observation}")
        outcomes = flown.take(slice(reliability.samples))
        reliability = replace(reliability, rounds=tuple(rounds))
        record = replace(summarise(campaign, outcomes, test.most_flights), certificate=reliability)
        results = replace(results, certificate=Certificate(campaign, outcomes, record))
        if reserve is None or conclusion is None or conclusion.factor == 1.0:
            break
        with steps.step("resize the device with more reserve") as step:
            raised = reserve.raised(conclusion.factor)
            larger = resized(placed, strict=strict, estimates=placed.estimates, reserve=raised)
            if larger is None:
                step.note = "no device has that reserve"
                break
            step.note = larger.combinations
        placed = larger
        results = plan_and_fly(placed, specified, steps)
    return placed, results
