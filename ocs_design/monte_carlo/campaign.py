"""Campaigns: flights of many samples, their results in a folder, and replay of single samples."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from ctypes import CDLL
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ocs_design.common.errors import OcsError
from ocs_design.common.files import TextKind, safe_name, to_json
from ocs_design.device.answers import RESULT_FILE, MonteCarloRecord
from ocs_design.export.folder import clear_leftovers, output_error, staging_beside
from ocs_design.export.physics import STEP
from ocs_design.monte_carlo.outcomes import METRICS, Outcomes, code_of, write_tables
from ocs_design.monte_carlo.uncertainty import Sample, Uncertainty, sampled_world
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.simulation.engine import Engine
from ocs_design.simulation.imperfections import AirDrag, air_drag
from ocs_design.simulation.metrics import objection
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.run import Metrics, Run
from ocs_design.simulation.scenario import Flights, fly
from ocs_design.simulation.simulate import Progress, partial_progress
from ocs_design.simulation.verdict import MOMENTUM_GATE, Verdict, judge
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import Options


@dataclass(frozen=True, eq=False)
class DesignedFlight:
    """One scenario as designed.

    Attributes:
        maneuver: the one flown. world: with the wheels active.
        can_stand, objection: see `judge`.
    """

    maneuver: Maneuver
    world: World
    can_stand: bool | None
    objection: str


@dataclass(frozen=True, eq=False)
class Campaign:
    """Scenarios, their uncertainty, and the seed of the samples.

    Attributes:
        flights: one of each scenario, as designed.
        uncertainty: distributions of all sampled quantities.
        air: drag of a wheel.
        limits: of a motor before friction, which is sampled, is subtracted.
        seed: of all samples. hold: physics steps per control step.
        engine: of the physics; None: MuJoCo on the CPU.
    """

    flights: tuple[DesignedFlight, ...]
    uncertainty: Uncertainty
    air: AirDrag
    limits: MotorLimits
    seed: int
    hold: int
    engine: Engine | None = None

    def sample(self, index: int) -> Sample:
        """Sampled values for one robot."""
        return Sample.draw(self.uncertainty, self.seed, index)

    def worlds(self, sample: Sample) -> list[World]:
        """Every scenario of one robot."""
        return [self.sampled_world(sample, number) for number in range(len(self.flights))]

    def sampled_world(self, sample: Sample, number: int) -> World:
        """Scenario `number` of one robot."""
        return sampled_world(
            self.flights[number].world,
            sample,
            number,
            air=self.air,
            limits=self.limits,
            period=self.hold * STEP,
        )

    def judged(self, metrics: Metrics | None, number: int) -> Verdict:
        """The verdict on a flight of scenario `number`."""
        flight = self.flights[number]
        return judge(
            metrics,
            flight.maneuver,
            can_stand=flight.can_stand,
            objection=flight.objection,
            gate=MOMENTUM_GATE if self.engine is None else self.engine.gate,
        )


def make_campaign(
    flights: Flights,
    *,
    can_stand: Sequence[bool | None],
    uncertainty: Uncertainty,
    seed: int,
) -> Campaign:
    """The campaign of a design; `can_stand`: of each maneuver, as found in its designed flights."""
    worlds, device = map(flights.device_world, flights.maneuvers), flights.device
    designed = tuple(
        DesignedFlight(maneuver, world, stands, objection(world))
        for maneuver, world, stands in zip(flights.maneuvers, worlds, can_stand, strict=True)
    )
    limits = MotorLimits.of(device.motor.without_friction, device.supply, len(device.modules))
    air, hold = air_drag(device.flywheel), flights.options.hold
    return Campaign(designed, uncertainty, air, limits, seed, hold)


MEMORY = 512 << 20
"""Memory for worlds that are flown together [bytes]; each model of a humanoid has its meshes."""


def fly_samples(
    campaign: Campaign,
    indices: Sequence[int],
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Outcomes:
    """Fly every scenario of these samples, as many at once as fit into `MEMORY`.

    Results of a sample do not depend on what it is flown with. `threads` and `progress`: see
    `simulate`.
    """
    # Freed models must leave no holes in the C library's heap, which would otherwise grow with
    # every batch: glibc's mallopt(M_MMAP_THRESHOLD, 1 MiB), where it exists.
    with suppress(OSError, AttributeError, TypeError):
        CDLL(None).mallopt(-3, 1 << 20)
    # Measured: a model takes half as much again, and each control step records 490 bytes.
    period = campaign.hold * STEP
    size = sum(1.5 * flight.world.model.nbuffer for flight in campaign.flights)
    size += sum(490.0 * flight.world.duration / period for flight in campaign.flights)
    batch_size = max(1, int(MEMORY / size))
    parts = []
    for start in range(0, len(indices), batch_size):
        batch = indices[start : start + batch_size]
        done, after = start / len(indices), (start + len(batch)) / len(indices)
        report = partial_progress(progress, done, after)
        parts.append(_fly_batch(campaign, batch, threads, report))
    return Outcomes.joined(parts)


def _fly_batch(
    campaign: Campaign, indices: Sequence[int], threads: int | None, progress: Progress
) -> Outcomes:
    """Fly every scenario of these samples in one batch, whose memory is freed on return."""
    samples = [campaign.sample(index) for index in indices]
    worlds = [world for sample in samples for world in campaign.worlds(sample)]
    options = Options(hold=campaign.hold, threads=threads, engine=campaign.engine)
    flights = fly(worlds, options, progress)
    shape = (len(samples), len(campaign.flights))
    metrics, codes = np.full((*shape, len(METRICS)), np.nan), np.zeros(shape, dtype=np.int8)
    for place, flight in enumerate(flights):
        row, flight_metrics = divmod(place, len(campaign.flights)), flight.metrics
        codes[row] = code_of(campaign.judged(flight_metrics, row[1]))
        if flight_metrics is not None:
            figures = (getattr(flight_metrics, name) for name in METRICS)
            metrics[row] = [np.nan if figure is None else float(figure) for figure in figures]
    values = np.stack([sample.values for sample in samples])
    return Outcomes(np.array(indices), values, metrics, codes, campaign.uncertainty.names)


SCHEMA_VERSION = 1

_KIND = TextKind("case", 1 << 20, 1 << 20, "give a file from the folder worst/", '"..."')


@dataclass(frozen=True, kw_only=True)
class Case:
    """A sample with its results.

    Attributes:
        design: SHA-256 of what was designed.
        seed, sample: determine its noise.
        scenario: for which it was kept. verdict: on that scenario, in one sentence.
        values: sampled, by name (SI).
        metrics: of each scenario by its name; null where there is no value.
    """

    schema_version: int
    design: str
    seed: int
    sample: int
    scenario: str
    verdict: str
    values: Mapping[str, float]
    metrics: Mapping[str, Mapping[str, float | None]]

    def to_sample(self, uncertainty: Uncertainty) -> Sample:
        """The sample itself, as if drawn from this uncertainty.

        Raises:
            OcsError: it lacks a sampled quantity.
        """
        names = uncertainty.names
        if missing := [name for name in names if name not in self.values]:
            raise OcsError(
                f"case of sample {self.sample}: has no value of {', '.join(missing)}",
                hint="it comes from another version; draw it again with --seed and --sample",
            )
        values = np.array([self.values[name] for name in names])
        return Sample(self.seed, self.sample, uncertainty, values)


def case_of(campaign: Campaign, outcomes: Outcomes, row: int, scenario: int, design: str) -> Case:
    """Case of the sample in one row of the outcomes, kept for one scenario."""
    names = [flight.maneuver.name for flight in campaign.flights]
    return Case(
        schema_version=SCHEMA_VERSION,
        design=design,
        seed=campaign.seed,
        sample=int(outcomes.index[row]),
        scenario=names[scenario],
        verdict=campaign.judged(metrics_of(outcomes, row, scenario), scenario).reason,
        values=dict(zip(outcomes.names, outcomes.values[row].tolist(), strict=True)),
        metrics={
            name: dict(zip(METRICS, outcomes.metrics[row, number].tolist(), strict=True))
            for number, name in enumerate(names)
        },
    )


def metrics_of(outcomes: Outcomes, row: int, scenario: int) -> Metrics | None:
    """The figures of one flight; None if it became unstable."""
    values = dict(zip(METRICS, outcomes.metrics[row, scenario].tolist(), strict=True))
    if np.isnan(values["final_roll"]):
        return None
    upright = bool(values.pop("upright_at_end"))
    times = (values.pop(name) for name in ("touchdown_time", "lift_off_time"))
    touchdown, lift_off = (None if np.isnan(time) else time for time in times)
    return Metrics(
        upright_at_end=upright, touchdown_time=touchdown, lift_off_time=lift_off, **values
    )


def write_case(case: Case, folder: Path) -> Path:
    """Write a case as JSON, named after scenario and sample."""
    path = folder / f"{safe_name(case.scenario)}-{case.sample}.json"
    path.write_bytes(to_json(case))
    return path


def read_case(path: Path) -> Case:
    """Read a case that `write_case` wrote.

    Raises:
        OcsError: it cannot be read.
    """
    try:
        return msgspec.json.decode(_KIND.read(path), type=Case)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: not a case: {error}", hint=_KIND.path_hint) from error


WORST_FOLDER = "worst"


def write_results(
    campaign: Campaign, outcomes: Outcomes, record: MonteCarloRecord, folder: Path, *, design: str
) -> tuple[Path, ...]:
    """Write the results of a campaign in place of earlier ones; `design`: its hash, for the cases.

    Returns:
        The files, the record last.

    Raises:
        OutputError: the folder cannot be written.
    """
    try:
        clear_leftovers(folder / RESULT_FILE)
        with staging_beside(folder / RESULT_FILE) as staging:
            write_tables(outcomes, [flight.maneuver.name for flight in campaign.flights], staging)
            worst = staging / WORST_FOLDER
            worst.mkdir()
            rows = {sample: row for row, sample in enumerate(outcomes.index.tolist())}
            for number, scenario in enumerate(record.scenarios):
                for sample in scenario.worst:
                    write_case(case_of(campaign, outcomes, rows[sample], number, design), worst)
            (staging / RESULT_FILE).write_bytes(to_json(record))
            # The record comes last: it is absent while the other files are not all of one run.
            (folder / RESULT_FILE).unlink(missing_ok=True)
            (folder / WORST_FOLDER).mkdir(exist_ok=True)
            for old in (folder / WORST_FOLDER).glob("*.json"):
                old.unlink()
            files = [path.relative_to(staging) for path in staging.rglob("*") if path.is_file()]
            files.sort(key=lambda file: (file.name == RESULT_FILE, file))
            return tuple((staging / file).replace(folder / file) for file in files)
    except OSError as error:
        raise output_error(error, folder) from error


def replayed(
    campaign: Campaign, sample: Sample, *, pose_rate: float | None = None
) -> tuple[Run, ...]:
    """Fly every scenario of one sample again; results equal those in the campaign."""
    flights = fly(campaign.worlds(sample), Options(hold=campaign.hold, pose_rate=pose_rate))
    return tuple(
        flight.run(
            designed.maneuver.name,
            campaign.judged(flight.metrics, number),
            ocs=True,
            can_stand=designed.can_stand,
        )
        for number, (designed, flight) in enumerate(zip(campaign.flights, flights, strict=True))
    )
