"""What many samples say together: the record of a campaign."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design_file import ValidationRecord
from ocs_design.monte_carlo.advice import advice
from ocs_design.monte_carlo.campaign import Campaign
from ocs_design.monte_carlo.interval import CONFIDENCE, Share, share
from ocs_design.monte_carlo.outcomes import FAULTS, Outcomes
from ocs_design.monte_carlo.reality import NAMES
from ocs_design.monte_carlo.sample import Sample
from ocs_design.monte_carlo.severity import Cause, attitude_error, causes, order

QUANTILES = (0.0, 0.05, 0.5, 0.95, 1.0)
BINS = 12
WORST = 3
"""Cases of each scenario that are kept."""


@dataclass(frozen=True, kw_only=True)
class Spread:
    """How a figure of the flights is spread, SI.

    Attributes:
        quantiles: at `QUANTILES`.
        counts: of `BINS` equal bins from the lowest value to the highest.
    """

    quantiles: tuple[float, ...]
    counts: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class ScenarioSummary:
    """One scenario.

    Attributes:
        scenario: its name. success: how often it passes.
        faults: how often each kept a flight from passing.
        attitude_error: largest of roll and pitch at touchdown, and of what a flip lacks [rad].
        peak_wheel_speed, peak_wheel_torque: in flight [rad/s], [N m].
        causes: what bad outcomes go with. worst: samples, the worst first.
        advice: how to mend what fails, where that is known; one sentence or empty.
    """

    scenario: str
    success: Share
    faults: Mapping[str, int]
    attitude_error: Spread | None
    peak_wheel_speed: Spread | None
    peak_wheel_torque: Spread | None
    causes: tuple[Cause, ...]
    worst: tuple[int, ...]
    advice: str = ""


@dataclass(frozen=True, kw_only=True)
class MonteCarloRecord:
    """A campaign.

    Attributes:
        seed: of all samples. samples: that were flown, from 0 on. asked: for at most.
        confidence: of the intervals.
        reality: the distribution of each key of `[reality]`, SI.
        success: how often one robot passes all scenarios.
        scenarios: one by one.
    """

    seed: int
    samples: int
    asked: int
    confidence: float
    reality: Mapping[str, str]
    success: Share
    scenarios: tuple[ScenarioSummary, ...]


def summarised(campaign: Campaign, outcomes: Outcomes, asked: int) -> MonteCarloRecord:
    """The record of these outcomes."""
    flown, whole = len(outcomes.index), outcomes.passed.all(axis=1)
    return MonteCarloRecord(
        seed=campaign.seed,
        samples=flown,
        asked=asked,
        confidence=CONFIDENCE,
        reality=campaign.reality.written(),
        success=share(int(whole.sum()), flown),
        scenarios=tuple(
            _scenario(campaign, outcomes, number) for number in range(len(campaign.flights))
        ),
    )


def shares(outcomes: Outcomes) -> tuple[Share, ...]:
    """How often each scenario passes."""
    passed = outcomes.passed.sum(axis=0).tolist()
    return tuple(share(count, len(outcomes.index)) for count in passed)


def _scenario(campaign: Campaign, outcomes: Outcomes, number: int) -> ScenarioSummary:
    maneuver = campaign.flights[number].maneuver
    ranking = order(outcomes, maneuver, number)
    codes = outcomes.codes[:, number]
    return ScenarioSummary(
        scenario=maneuver.name,
        success=shares(outcomes)[number],
        faults={
            str(fault): int(count)
            for code, fault in enumerate(FAULTS, 1)
            if (count := np.count_nonzero(codes == code))
        },
        attitude_error=_spread(attitude_error(outcomes, maneuver, number)),
        peak_wheel_speed=_spread(outcomes.metric("peak_wheel_speed")[:, number]),
        peak_wheel_torque=_spread(outcomes.metric("peak_wheel_torque")[:, number]),
        causes=causes(outcomes, ranking),
        worst=tuple(outcomes.index[ranking[::-1][:WORST]].tolist()),
        advice=advice(outcomes, maneuver, number),
    )


def _spread(values: FloatArray) -> Spread | None:
    """None where no flight reached its end."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return None
    counts, _ = np.histogram(finite, bins=BINS)
    return Spread(
        quantiles=tuple(np.quantile(finite, QUANTILES).tolist()), counts=tuple(counts.tolist())
    )


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """The one sample that was flown: its values by name, SI."""

    seed: int
    index: int
    values: Mapping[str, float]

    @classmethod
    def of(cls, sample: Sample) -> "Drawn":
        """The record of a sample."""
        values = dict(zip(NAMES, sample.values.tolist(), strict=True))
        return cls(seed=sample.seed, index=sample.index, values=values)


@dataclass(frozen=True, kw_only=True)
class Validated:
    """What came of it.

    `validation` has the flights as designed, or those of `sample` if that is given.
    """

    schema_version: int
    design: str
    robot: str
    warnings: tuple[str, ...]
    validation: tuple[ValidationRecord, ...]
    sample: Drawn | None = None
    monte_carlo: MonteCarloRecord | None = None

    @property
    def exit_code(self) -> int:
        """0, or 1 if a scenario does not pass with the device."""
        return 1 if any(run.ocs and run.passed is not True for run in self.validation) else 0
