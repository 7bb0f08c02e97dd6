"""Validation of a design: every maneuver flown with the device and without it, in one batch.

Whether a robot stands at the end is judged only if its legs can bear a level landing at all. A run
that lands well and stands shows that they can. If no run of a maneuver does, a second batch flies
that maneuver once more, level and undisturbed, to tell the device's fault from the legs'.
"""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property

from ocs_design.device.device import Device
from ocs_design.device.records.flights import StoppedRecord, SurvivalRecord
from ocs_design.jumping.jump import BALLISTIC, JumpPlans
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.leg_geometry import up_axis
from ocs_design.robot.robot import Robot
from ocs_design.simulation.batch import Recording
from ocs_design.simulation.metrics import breakdown, measure, objection, series_of
from ocs_design.simulation.run import Metrics, Poses, Run, Series
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import Progress, poses_of, simulate
from ocs_design.simulation.target import StoppedDrive
from ocs_design.simulation.verdict import (
    MOMENTUM_GATE,
    Fault,
    Verdict,
    attitude_error_at_touchdown,
    judge,
    lands_on_legs,
    lands_well,
    stands,
)
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import Options, WorldBuilder
from ocs_design.sizing.trajectory.motion import Trajectory


@dataclass(frozen=True, eq=False)
class FlownWorld:
    """One world, flown: its place in a recording, and `metrics` as in `Run`."""

    world: World
    recording: Recording
    place: int
    metrics: Metrics | None

    @property
    def objection(self) -> str:
        """Why the flight cannot be judged, see `judge`; empty if it can."""
        return objection(self.world) or breakdown(self.recording, self.place)

    @property
    def series(self) -> Series:
        """Time series."""
        return series_of(self.recording, self.place, self.world)

    @property
    def poses(self) -> Poses | None:
        """Poses to show the flight again; None if none were recorded."""
        return poses_of(self.recording, self.place, self.world)

    def run(self, scenario: str, verdict: Verdict, *, ocs: bool, can_stand: bool | None) -> Run:
        """The flight with its verdict; arguments as in `Run`."""
        return Run(
            scenario=scenario,
            ocs=ocs,
            passed=verdict.passed,
            reason=verdict.reason,
            metrics=self.metrics,
            series=self.series,
            note=self.world.note,
            poses=self.poses,
            can_stand=can_stand,
            level=verdict.level,
            stands=verdict.stands,
        )


@dataclass(frozen=True, eq=False)
class Flights:
    """Robot, device and maneuvers to be flown, as designed and as sampled.

    Attributes:
        robot: at its nominal posture, which its joints hold. device: on the robot.
        references: trajectory that the device tracks, by name of the maneuver. Without one it
            follows a smooth turn within its wheels' limits; a disturbance, not known beforehand, is
            met by feedback alone.
        jumps: plans for the legs, by name of the maneuver; without one it starts at lift-off.
    """

    robot: Robot
    device: Device
    maneuvers: Sequence[Maneuver]
    options: Options = field(default_factory=Options)
    references: Mapping[str, Trajectory] = field(default_factory=dict)
    jumps: Mapping[str, JumpPlans] = field(default_factory=dict)

    @cached_property
    def builder(self) -> WorldBuilder:
        """Builder of their worlds."""
        return WorldBuilder(self.robot, self.device, self.options)

    def jump_plans(self, maneuver: Maneuver) -> JumpPlans:
        """How the legs begin a maneuver."""
        return self.jumps.get(maneuver.name, BALLISTIC)

    def device_world(self, maneuver: Maneuver) -> World:
        """World of a maneuver with the device."""
        reference = self.references.get(maneuver.name)
        return self.builder.flight(
            maneuver, Wheels.ACTIVE, reference, self.jump_plans(maneuver).carrying
        )


def run_scenarios(flights: Flights, progress: Progress | None = None) -> tuple[Run, ...]:
    """Fly every maneuver with the device and then without, in that order.

    `progress` is called with the share of the work that is done, 0..1.
    """
    robot, maneuvers, builder = flights.robot, flights.maneuvers, flights.builder
    worlds = [
        world
        for maneuver in maneuvers
        for world in (
            flights.device_world(maneuver),
            builder.flight(maneuver, Wheels.ABSENT, None, flights.jump_plans(maneuver).bare),
        )
    ]
    flown = fly(worlds, flights.options, progress)
    pairs = list(zip(flown[::2], flown[1::2], strict=True))
    robot_objection = refusal(robot)

    # If flights land well but none of them stands, either the legs or the device is at fault.
    # In orbit there is nothing to stand on, and no robot stands on its back.
    can_stand = [
        True if robot.legs and maneuver.gravity and lands_on_legs(maneuver) else None
        for maneuver in maneuvers
    ]
    doubtful = []
    for index, (maneuver, pair) in enumerate(zip(maneuvers, pairs, strict=True)):
        well_landed = [flight.metrics for flight in pair if lands_well(flight.metrics, maneuver)]
        can_be_judged = can_stand[index] and not maneuver.on_pivot
        if can_be_judged and well_landed and not any(stands(metrics) for metrics in well_landed):
            doubtful.append(index)
    landings = [
        builder.flight(
            maneuver, Wheels.BRAKED, None, flights.jump_plans(maneuver).carrying, level=True
        )
        for maneuver in [maneuvers[index] for index in doubtful]
    ]
    for index, flight in zip(doubtful, fly(landings, flights.options), strict=True):
        can_stand[index] = stands(flight.metrics)

    runs = []
    for maneuver, pair, legs_can_stand in zip(maneuvers, pairs, can_stand, strict=True):
        for flight, ocs in zip(pair, (True, False), strict=True):
            reason = robot_objection or flight.objection
            verdict = judge(
                flight.metrics,
                maneuver,
                can_stand=legs_can_stand,
                objection=reason,
                legs=len(robot.legs),
            )
            runs.append(flight.run(maneuver.name, verdict, ocs=ocs, can_stand=legs_can_stand))
    return tuple(runs)


STOPS = 8
"""Instants at which each drive stops in turn, evenly spaced from lift-off or release."""


def fly_stopped(
    flights: Flights, detection: float, progress: Progress | None = None
) -> SurvivalRecord:
    """Fly every maneuver with each drive stopping at each of `STOPS` instants, and judge landings.

    `detection`: time until the law knows of a stop [s].
    """
    device = flights.device
    flown: list[tuple[Maneuver, StoppedDrive, World]] = []
    for maneuver in flights.maneuvers:
        world = flights.device_world(maneuver)
        for wheel in range(len(device.modules)):
            for index in range(STOPS):
                stopped = StoppedDrive(wheel, index / STOPS * world.flight_time, detection)
                flown.append((maneuver, stopped, replace(world, stopped=stopped)))
    records, worlds = [], [world for *_, world in flown]
    flown_again = fly(worlds, flights.options, progress)
    for (maneuver, stopped, _), flight in zip(flown, flown_again, strict=True):
        reason = refusal(flights.robot) or flight.objection
        # The landing counts, not whether the legs then keep the robot up.
        can_stand = True if maneuver.on_feet else None
        verdict = judge(flight.metrics, maneuver, can_stand=can_stand, objection=reason)
        tilt, ended = None, flight.metrics
        if ended is not None and verdict.fault is not Fault.UNSOUND:
            final = max(abs(ended.final_roll), abs(ended.final_pitch))
            tilt = final if maneuver.on_feet else attitude_error_at_touchdown(ended, maneuver)
        records.append(
            StoppedRecord(
                scenario=maneuver.name,
                module=device.modules[stopped.wheel].name,
                instant=stopped.instant,
                lands=verdict.passed,
                tilt=tilt,
                reason=verdict.reason.partition(";")[0],
            )
        )
    return SurvivalRecord(detection=detection, flights=tuple(records))


MOST_HALVINGS = 2
"""Most times that the physics step is halved; each halving leaves a sixteenth of the error."""


def fly(
    worlds: Sequence[World], options: Options, progress: Progress | None = None
) -> list[FlownWorld]:
    """Fly worlds, and again at half the step those whose momentum error exceeds the gate."""
    flights = _simulated(worlds, options, progress)
    # In single precision the error is rounding, which shorter steps increase.
    for _ in range(MOST_HALVINGS if options.engine is None else 0):
        coarse = [
            (index, flight.metrics.momentum_error)
            for index, flight in enumerate(flights)
            if flight.metrics is not None
            and flight.metrics.momentum_error > MOMENTUM_GATE
            and not flight.objection
        ]
        refined = []
        for index, error in coarse:
            world = flights[index].world
            model, drives = copy(world.model), world.imperfections
            model.opt.timestep /= 2.0
            step = 1e3 * model.opt.timestep
            remark = (
                f"flown again with steps of {step:g} ms: at {2.0 * step:g} ms its angular momentum "
                f"was off by {error:.1e}"
            )
            if drives is not None:
                drives = replace(drives, delay=2 * drives.delay)
            note = "; ".join(filter(None, (worlds[index].note, remark)))
            refined.append(replace(world, model=model, imperfections=drives, note=note))
        for (index, _error), flight in zip(coarse, _simulated(refined, options), strict=True):
            flights[index] = flight
    return flights


def _simulated(
    worlds: Sequence[World], options: Options, progress: Progress | None = None
) -> list[FlownWorld]:
    if not worlds:
        return []
    recording = simulate(
        worlds,
        hold=options.hold,
        threads=options.threads,
        pose_rate=options.pose_rate,
        progress=progress,
        engine=options.engine,
    )
    return [
        FlownWorld(world, recording, index, measure(recording, index, world))
        for index, world in enumerate(worlds)
    ]


def refusal(robot: Robot) -> str:
    """Why no flight of this robot can be judged; empty if they can."""
    if not robot.legs or up_axis(robot.tree, robot.trunk, robot.legs)[2] == 1.0:
        return ""
    return (
        f"not judged: the z axis of the trunk frame '{robot.trunk}' does not point up, so roll "
        f"and pitch do not measure its tilt"
    )
