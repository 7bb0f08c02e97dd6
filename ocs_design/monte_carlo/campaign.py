"""What is flown over and over, and one block of it: a pure function of values that can be sent."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np

from ocs_design.design import Device
from ocs_design.jumping.jump import BALLISTIC, JumpPlans
from ocs_design.monte_carlo.built import built
from ocs_design.monte_carlo.outcomes import METRICS, Outcomes, code_of
from ocs_design.monte_carlo.reality import Reality
from ocs_design.monte_carlo.sample import Sample
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.robot import Robot
from ocs_design.simulation.air_drag import air_drag
from ocs_design.simulation.engine import Progress, simulate
from ocs_design.simulation.imperfections import AirDrag
from ocs_design.simulation.metrics import Metrics, measure
from ocs_design.simulation.recording import Recording
from ocs_design.simulation.scenario import Options, world_builder
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.soundness import objection
from ocs_design.simulation.verdict import Verdict, judge
from ocs_design.simulation.world import World
from ocs_design.sizing.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Flight:
    """One scenario as designed.

    Attributes:
        maneuver: that is flown. world: with the wheels active.
        can_stand, objection: see `judge`.
    """

    maneuver: Maneuver
    world: World
    can_stand: bool | None
    objection: str


@dataclass(frozen=True, eq=False)
class Campaign:
    """Scenarios, the reality that they are flown in, and the seed of its samples.

    Attributes:
        flights: one of each scenario, as designed.
        reality: how everything is spread.
        air: drag of a wheel.
        seed: of all samples. hold: steps of the physics per control step.
    """

    flights: tuple[Flight, ...]
    reality: Reality
    air: AirDrag
    seed: int
    hold: int

    def sample(self, index: int) -> Sample:
        """What is drawn for one robot."""
        return Sample.draw(self.reality, self.seed, index)

    def worlds(self, sample: Sample) -> list[World]:
        """Every scenario of one robot."""
        return [
            built(flight.world, sample, number, self.air)
            for number, flight in enumerate(self.flights)
        ]

    def judged(self, metrics: Metrics | None, number: int) -> Verdict:
        """The verdict on a flight of scenario `number`."""
        flight = self.flights[number]
        return judge(
            metrics, flight.maneuver, can_stand=flight.can_stand, objection=flight.objection
        )


def make_campaign(
    robot: Robot,
    device: Device,
    maneuvers: Sequence[Maneuver],
    *,
    options: Options,
    references: Mapping[str, Trajectory],
    jumps: Mapping[str, JumpPlans],
    can_stand: Sequence[bool | None],
    reality: Reality,
    seed: int,
) -> Campaign:
    """The campaign of a design.

    Args:
        robot, device, maneuvers, options, references, jumps: see `run_scenarios`.
        can_stand: of each maneuver, as its flights as designed showed it.
        reality: see `Reality`. seed: of all samples.
    """
    builder = world_builder(robot, device, options)
    worlds = [
        builder.flight(
            maneuver,
            Wheels.ACTIVE,
            references.get(maneuver.name),
            jumps.get(maneuver.name, BALLISTIC).carrying,
        )
        for maneuver in maneuvers
    ]
    flights = tuple(
        Flight(maneuver, world, stands, objection(world))
        for maneuver, world, stands in zip(maneuvers, worlds, can_stand, strict=True)
    )
    return Campaign(flights, reality, air_drag(device.flywheel), seed, options.hold)


def fly_samples(
    campaign: Campaign,
    indices: Sequence[int],
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Outcomes:
    """Every scenario of these samples, in one batch.

    Args:
        campaign: what is flown.
        indices: of the samples. Each has the same numbers whatever it is flown together with.
        threads: of the physics; None: one per processor.
        progress: told the part of the work that is done, 0..1.
    """
    samples = [campaign.sample(index) for index in indices]
    worlds = [world for sample in samples for world in campaign.worlds(sample)]
    recording = simulate(worlds, hold=campaign.hold, threads=threads, progress=progress)
    shape = (len(samples), len(campaign.flights))
    metrics, codes = np.full((*shape, len(METRICS)), np.nan), np.zeros(shape, dtype=np.int8)
    for place, world in enumerate(worlds):
        row = divmod(place, len(campaign.flights))
        metrics[row], codes[row] = _measured(campaign, recording, place, world, row[1])
    values = np.stack([sample.values for sample in samples])
    return Outcomes(np.array(indices), values, metrics, codes)


def _measured(
    campaign: Campaign, recording: Recording, place: int, world: World, number: int
) -> tuple[list[float], int]:
    """Figures and verdict of one flight."""
    found = measure(recording, place, world)
    code = code_of(campaign.judged(found, number))
    if found is None:
        return [np.nan] * len(METRICS), code
    values = (getattr(found, field.name) for field in fields(found))
    return [np.nan if value is None else float(value) for value in values], code
