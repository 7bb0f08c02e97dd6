"""How the device does in flight: as designed, with a drive stopped, as it might be built."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias


@dataclass(frozen=True, kw_only=True)
class ControlRecord:
    """The wheel law of the flights: `projection` of the torque, gains [1/s^2, 1/s], period [s].

    `ballistic` flights start at lift-off; a design that does not say was flown so.
    """

    projection: str
    kp: float
    kd: float
    period: float = 0.005
    desaturate: bool = False
    ballistic: bool = True


@dataclass(frozen=True, kw_only=True)
class ValidationRecord:
    """One simulated flight.

    Attributes:
        scenario: name of the maneuver. ocs: with the device, or the bare robot.
        passed: a level touchdown, the turn done, and upright at the end where the legs bear a level
            landing; None: it could not be judged.
        level: whether it touches down level, within 5 deg; None: not judged.
        stands: whether it is upright at the end; None: not judged, or it has no legs.
        reason: for `passed`, one sentence.
        note: how the turn was changed to suit the wheels; empty if it was not.
        metrics: by their names, SI.
        can_stand: whether the legs bear this landing when level; None: no legs, or an old file.
    """

    scenario: str
    ocs: bool
    passed: bool | None
    reason: str
    note: str
    metrics: Mapping[str, float | bool | None]
    can_stand: bool | None = None
    level: bool | None = None
    stands: bool | None = None


RunMetrics: TypeAlias = Mapping[str, float | bool | None]
"""Metrics of a recorded run by their names, SI."""


def lift_off_and_touchdown(metrics: RunMetrics) -> tuple[float | None, float | None]:
    """Times of a recorded run [s]; None: it never does so."""
    # Older versions do not record the lift-off, and all of their flights start in the air.
    lift_off = metrics.get("lift_off_time", 0.0 if metrics else None)
    return lift_off, metrics.get("touchdown_time")


def was_in_the_air(lift_off: float | None, touchdown: float | None) -> bool:
    """Whether a run left the ground; who is pushed as they stand touch down at once."""
    return lift_off is not None and (touchdown is None or touchdown > lift_off)


def was_on_pivot(run: ValidationRecord) -> bool:
    """Whether a run stood on a pivot: it is judged by its stand alone, and was not pushed.

    What others have for touchdown is when it is to be upright.
    """
    flew = was_in_the_air(*lift_off_and_touchdown(run.metrics))
    return run.level is None and run.stands is not None and flew


@dataclass(frozen=True, kw_only=True)
class StoppedRecord:
    """One flight in which a drive stops and its wheel runs on.

    Attributes:
        scenario: name of the maneuver. module: whose drive. instant: from lift-off [s].
        lands: whether it comes down within the allowance; None: not judged.
        tilt: larger of roll and pitch off what is asked at touchdown [rad]; None: not judged.
        reason: for `lands`, one sentence.
    """

    scenario: str
    module: str
    instant: float
    lands: bool | None
    tilt: float | None
    reason: str


@dataclass(frozen=True, kw_only=True)
class SurvivalRecord:
    """How the device lands when any one drive stops at any instant.

    Attributes:
        detection: time until the law knows of it [s].
        flights: of every drive at several instants of each maneuver.
        mass_without: of the lightest device that need not survive it [kg]; None: not looked for.
    """

    detection: float
    flights: tuple[StoppedRecord, ...]
    mass_without: float | None = None

    @property
    def lost(self) -> tuple[StoppedRecord, ...]:
        """Flights that do not come down within the allowance, or are not judged."""
        return tuple(each for each in self.flights if each.lands is not True)

    @property
    def worst(self) -> StoppedRecord:
        """The flight that ends worst: of those lost, if there are any."""
        return max(
            self.lost or self.flights,
            key=lambda each: float("inf") if each.tilt is None else each.tilt,
        )


class Conclusion(StrEnum):
    """What a certificate says."""

    CERTIFIED = "certified"
    SHORT = "falls short"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True)
class ReliabilityRecord:
    """What flights of robots as they might be built say of the reliability that was asked for.

    Attributes:
        asked: share of robots that do all of their maneuvers.
        worse: share that the test tells it from: of a device that must not be certified.
        verdict: of the sequential test.
        samples: robots that it took. whole: of them, those that do all maneuvers.
        whole_interval: of their share, exact, at 95 %.
        passed, interval: the same of each scenario alone.
        seed, first: of the samples, and the index of the first.
        round: number of the round, 1 and more; 0 where no design could learn from it.
        rounds: what was learnt in the rounds before, one sentence each.
    """

    asked: float
    worse: float
    verdict: Conclusion
    samples: int
    whole: int
    whole_interval: tuple[float, float]
    passed: Mapping[str, int]
    interval: Mapping[str, tuple[float, float]]
    seed: int
    first: int = 0
    round: int = 0
    rounds: tuple[str, ...] = ()


def falls_short(
    runs: Iterable[ValidationRecord],
    survival: SurvivalRecord | None,
    certificate: ReliabilityRecord | None,
) -> bool:
    """Whether a flight with the device does not pass, or what was asked besides is not met."""
    return (
        any(run.ocs and run.passed is not True for run in runs)
        or (survival is not None and bool(survival.lost))
        or (certificate is not None and certificate.verdict == Conclusion.SHORT)
    )
