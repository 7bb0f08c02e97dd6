"""The proof of a design: every maneuver flown with the device and without it, in one batch."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from ocs_design.design import Device
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.controller import Allocation, Gains
from ocs_design.simulation.engine import Progress, simulate
from ocs_design.simulation.metrics import Metrics, Series, measure, series_of
from ocs_design.simulation.recording import Recording
from ocs_design.simulation.reference import Profile, Quintic
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.verdict import judge, stands
from ocs_design.simulation.world import World, WorldBuilder


@dataclass(frozen=True)
class Options:
    """How to simulate.

    Attributes:
        allocation: of the torque to the wheels.
        gains: of the wheel law; None: `wheel_gains` of the robot.
        drop_profile: how a dropped robot is turned to level; `Step()` is the paper's command.
        hold: physics steps of 1 ms per control step.
        threads: of the physics; None: one per processor.
    """

    allocation: Allocation = Allocation.PSEUDO_INVERSE
    gains: Gains | None = None
    drop_profile: Profile = field(default_factory=Quintic)
    hold: int = 5
    threads: int | None = None


@dataclass(frozen=True, eq=False)
class Run:
    """One flight.

    Attributes:
        scenario: name of the maneuver. ocs: with the device, or the bare robot.
        passed: True, False, or None where it cannot be judged. reason: one sentence.
        metrics: None if the simulation became unstable.
        series: of time. note: how the turn was changed to suit the wheels; empty if it was not.
    """

    scenario: str
    ocs: bool
    passed: bool | None
    reason: str
    metrics: Metrics | None
    series: Series
    note: str


@dataclass(frozen=True, eq=False)
class _Flights:
    """The worlds of one maneuver; `level` shows what the legs can bear, None without legs."""

    maneuver: Maneuver
    with_ocs: World
    without_ocs: World
    level: World | None


def run_scenarios(
    robot: Robot,
    device: Device,
    maneuvers: Sequence[Maneuver],
    *,
    options: Options | None = None,
    progress: Progress | None = None,
) -> tuple[Run, ...]:
    """Fly every maneuver with the device and then without, in that order.

    Args:
        robot: at its nominal posture, which its joints hold.
        device: that the robot carries.
        maneuvers: see `Maneuver`.
        options: see `Options`.
        progress: told the part of the work that is done, 0..1.
    """
    chosen = options or Options()
    flights = _flights(robot, device, maneuvers, chosen)
    worlds = [world for flight in flights for world in _worlds(flight)]
    if not worlds:
        return ()
    recording = simulate(worlds, hold=chosen.hold, threads=chosen.threads, progress=progress)
    runs: list[Run] = []
    first = 0
    for flight in flights:
        runs += _runs(flight, recording, first)
        first += len(_worlds(flight))
    return tuple(runs)


def _flights(
    robot: Robot, device: Device, maneuvers: Sequence[Maneuver], options: Options
) -> list[_Flights]:
    builder = WorldBuilder(
        robot,
        device,
        allocation=options.allocation,
        gains=options.gains,
        drop_profile=options.drop_profile,
    )
    return [
        _Flights(
            maneuver,
            builder.flight(maneuver, Wheels.ACTIVE),
            builder.flight(maneuver, Wheels.ABSENT),
            builder.level_landing(maneuver) if robot.legs else None,
        )
        for maneuver in maneuvers
    ]


def _worlds(flight: _Flights) -> list[World]:
    found = [flight.with_ocs, flight.without_ocs, flight.level]
    return [world for world in found if world is not None]


def _runs(flight: _Flights, recording: Recording, first: int) -> list[Run]:
    can_stand = None
    if flight.level is not None:
        can_stand = stands(measure(recording, first + 2, flight.level))
    pair = ((first, flight.with_ocs, True), (first + 1, flight.without_ocs, False))
    return [
        _run(flight.maneuver, recording, index, world, ocs=ocs, can_stand=can_stand)
        for index, world, ocs in pair
    ]


def _run(
    maneuver: Maneuver,
    recording: Recording,
    index: int,
    world: World,
    *,
    ocs: bool,
    can_stand: bool | None,
) -> Run:
    metrics = measure(recording, index, world)
    verdict = judge(metrics, maneuver, can_stand=can_stand)
    return Run(
        scenario=maneuver.name,
        ocs=ocs,
        passed=verdict.passed,
        reason=verdict.reason,
        metrics=metrics,
        series=series_of(recording, index),
        note=world.note,
    )
