"""Wald's sequential test (1945): does a device reach the specified reliability?

Sampled robots fly one after the other until the test decides. A sample passes if it passes all of
its maneuvers.
"""

from dataclasses import dataclass
from math import ceil, log
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ocs_design.device.records.flights import Conclusion, ReliabilityRecord
from ocs_design.monte_carlo.campaign import Campaign
from ocs_design.monte_carlo.outcomes import Outcomes, share
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.verdict import ends_at_any_attitude, tilt_errors

ERROR = 0.05
"""Largest probability of either wrong verdict."""

WORSE = 3.0
"""Odds of failure of a device that must not be certified, over the specified odds."""


@dataclass(frozen=True)
class SequentialTest:
    """Test of the specified reliability against one with `WORSE` times its odds of failure.

    If the better one is true, the likelihood ratio of the worse over the better ever exceeds
    1 / `ERROR` with a probability of at most `ERROR`, and vice versa (Ville 1939, Wald 1945). So
    neither wrong verdict is likelier than that, even if the test is cut short.

    Attributes:
        required: share of robots that pass all of their maneuvers, between 0 and 1.
    """

    required: float

    @property
    def worse(self) -> float:
        """The lower reliability that the test tells from the specified one."""
        return self.required / (self.required + WORSE * (1.0 - self.required))

    @property
    def most_flights(self) -> int:
        """Number of flights after which the test gives up."""
        return ceil(10.0 / (1.0 - self.required) - 1e-9)

    def verdict_on(self, passed: NDArray[np.bool_]) -> tuple[Conclusion | None, int]:
        """Verdict on n flights in order, None if undecided so far, and how many it took."""
        passed = passed[: self.most_flights]
        better = log(self.required / self.worse), log((1.0 - self.required) / (1.0 - self.worse))
        evidence = np.cumsum(np.where(passed, *better))
        decided = np.flatnonzero(np.abs(evidence) >= log(1.0 / ERROR))
        if decided.size:
            first = int(decided[0])
            return Conclusion.CERTIFIED if evidence[first] > 0.0 else Conclusion.SHORT, first + 1
        return Conclusion.UNDECIDED if len(passed) == self.most_flights else None, len(passed)

    def decided(self, outcomes: Outcomes) -> bool:
        """Whether these outcomes decide the test."""
        return self.verdict_on(outcomes.all_passed)[0] is not None


ROUND_STRIDE = 1 << 20
"""Samples of a round of `size --certify` begin at its number times this, those of `validate` at 0.
A sample's index is the spawn key of its generator: no round tests a device on samples that it was
sized with."""

ROUNDS = 3
"""Most times that a device is sized: flights of each round raise the reserve for the next."""


def certificate(
    test: SequentialTest, campaign: Campaign, outcomes: Outcomes, *, number: int = 0
) -> ReliabilityRecord:
    """Result of a test on these outcomes; those after the verdict are not counted.

    `number`: of the round, see `ReliabilityRecord`.
    """
    finding, count = test.verdict_on(outcomes.all_passed)
    passed = outcomes.passed[:count]
    names = [flight.maneuver.name for flight in campaign.flights]
    total, *by_scenario = (
        share(int(k), count) for k in (passed.all(axis=1).sum(), *passed.sum(axis=0))
    )
    return ReliabilityRecord(
        asked=test.required,
        worse=test.worse,
        verdict=finding or Conclusion.UNDECIDED,
        samples=count,
        whole=total.passed,
        whole_interval=(total.low, total.high),
        passed={name: pass_rate.passed for name, pass_rate in zip(names, by_scenario, strict=True)},
        interval={
            name: (pass_rate.low, pass_rate.high)
            for name, pass_rate in zip(names, by_scenario, strict=True)
        },
        seed=campaign.seed,
        first=int(outcomes.index[0]),
        round=number,
    )


SMALLEST_RAISE, LARGEST_RAISE = 1.1, 2.0
"""Smallest and largest factor by which a round raises the reserve."""


@dataclass(frozen=True)
class Lesson:
    """Conclusion on the reserve from flights that fell short.

    Attributes:
        factor: by which to raise the reserve; 1: a larger reserve does not help.
        observation: what was seen, in one sentence.
    """

    factor: float
    observation: str


def lesson(test: SequentialTest, campaign: Campaign, outcomes: Outcomes) -> Lesson:
    """Factor to raise the reserve by, for the maneuver and the axis that fail most often.

    Tilt at touchdown is nearly linear in the sampled quantities (docs/theory.md), and these are
    independent: so tilt is nearly normal, and the square of its correlation with a quantity is the
    share of its variance due to that quantity.
    """
    names = ("roll", "pitch")
    tilts = np.stack([outcomes.metric(f"touchdown_{name}") for name in names])
    for number, flight in enumerate(campaign.flights):
        roll, pitch = tilts[:, :, number]
        tilts[:, :, number] = tilt_errors(roll, pitch, flight.maneuver)
        if ends_at_any_attitude(flight.maneuver):
            tilts[:, :, number] = 0.0
    off_level = (np.abs(tilts) > LANDING_TOLERANCE).sum(axis=1)
    axis, number = divmod(int(np.argmax(off_level)), len(campaign.flights))
    if not off_level[axis, number]:
        return Lesson(1.0, "every touchdown is level: a larger reserve does not help")
    tilt = tilts[axis, :, number]
    finite = np.isfinite(tilt)
    tilt, values = tilt[finite], outcomes.values[finite]
    maneuver = campaign.flights[number].maneuver.name
    landings = (
        f"{maneuver}: {off_level[axis, number]} of {len(tilt)} land off level in {names[axis]}"
    )
    varied = np.flatnonzero(np.ptp(values, axis=0) > 0.0)
    if not varied.size or not np.ptp(tilt):
        return Lesson(1.0, f"{landings}, all alike: a larger reserve does not help")
    expected_tilt = (
        abs(tilt.mean()) + NormalDist().inv_cdf(0.5 * (1.0 + test.required)) * tilt.std()
    )
    shares = np.corrcoef(values[:, varied], tilt, rowvar=False)[-1, :-1] ** 2
    share, cause = max(zip(shares.tolist(), (outcomes.names[i] for i in varied), strict=True))
    factor = float(min(max(expected_tilt / LANDING_TOLERANCE, SMALLEST_RAISE), LARGEST_RAISE))
    advice = f"the reserve is raised by a factor of {factor:.2f}"
    if not campaign.flights[number].world.body.controlled[axis]:
        factor, advice = 1.0, f"no wheel, however large, turns the robot in {names[axis]}"
    elif cause.startswith("attitude_bias"):
        # The law levels the trunk by its sensor, so wheels cannot correct the sensor's bias.
        factor, advice = 1.0, "a better attitude sensor helps, a larger reserve does not"
    quantity = cause.replace("_", " ").replace(".", " ")
    return Lesson(
        factor,
        f"{landings}; {100.0 * test.required:.4g}% stay within {np.degrees(expected_tilt):.1f} deg "
        f"({np.degrees(LANDING_TOLERANCE):.0f} deg is allowed), and {share:.0%} of the variance "
        f"comes from {quantity}: {advice}",
    )
