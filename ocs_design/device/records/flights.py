"""Records of margins, and of flights: as designed, with a drive stopped, and of samples."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated

from ocs_design.common.ranges import OneOf, Positive, Range
from ocs_design.requirement.vocabulary import PROJECTIONS


@dataclass(frozen=True)
class Margin:
    """Demand on one part against its capacity.

    Attributes:
        name: of the quantity; each name is one kind of margin.
        demand: largest demand, never negative.
        capacity: of the part; None: no limit, or an unknown one; `note` says which.
        unit: of both, SI.
        margin: capacity over demand, exceeded below 1; None: no limit or no demand.
        scenario: name of the maneuver with the largest demand; empty if none.
        note: basis of the figures, one sentence; may be empty.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    margin: float | None = field(default=None, init=False)
    scenario: str = ""
    note: str = ""

    def __post_init__(self) -> None:
        capacity, demand = self.capacity, self.demand
        # A field that is set is written to the file, even if None.
        margin = None if capacity is None or demand == 0.0 else capacity / demand
        object.__setattr__(self, "margin", margin)

    @property
    def sort_key(self) -> tuple[float, float]:
        """Sort key: demand as a fraction of the capacity, then demand."""
        return (0.0 if self.margin is None else 1.0 / self.margin, self.demand)


@dataclass(frozen=True, kw_only=True)
class OpenPoint:
    """An obstacle to building a device.

    Attributes:
        what: prevents it, one sentence. cure: one sentence.
    """

    what: str
    cure: str


@dataclass(frozen=True, kw_only=True)
class Buildable:
    """Whether the device can be built as designed.

    Attributes:
        yes: None where that is unknown. open: what prevents it.
    """

    yes: bool | None
    open: tuple[OpenPoint, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ControlRecord:
    """The wheel law of the flights.

    Attributes:
        projection: of the torque on the trunk to the wheels.
        kp: gain on the attitude error [1/s^2]. kd: on the rate error [1/s].
        period: of the torque commands [s].
        desaturate: whether the wheels are braked while the robot stands.
        ballistic: whether flights start at lift-off, as in all designs that lack this field.
    """

    projection: Annotated[str, OneOf(PROJECTIONS)]
    kp: Positive
    kd: Positive
    period: Annotated[float, Range(1e-3, 1.0)] = 0.005
    desaturate: bool = False
    ballistic: bool = True


@dataclass(frozen=True, kw_only=True)
class ValidationRecord:
    """One simulated flight.

    Attributes:
        scenario: name of the maneuver. ocs: with the device, or the bare robot.
        passed: whether touchdown is level, the turn is done, and the robot ends upright where the
            legs can take a level landing; None: it could not be judged.
        level: whether it touches down level, within 5 deg; None: not judged.
        stands: whether it is upright at the end; None: not judged, or it has no legs.
        reason: for `passed`, one sentence.
        note: how the turn was adapted to the wheels; empty if it was not.
        metrics: by name, SI.
        can_stand: whether the legs can take this landing if level; None: no legs, or an old file.
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

    @property
    def lift_off(self) -> float | None:
        """Time of lift-off, or of the push on a standing robot [s]; None if there is none."""
        # Older versions do not record lift-off; all of their flights start in the air.
        return self.metrics.get("lift_off_time", 0.0 if self.metrics else None)

    @property
    def touchdown(self) -> float | None:
        """Time of touchdown [s]; None if there is none."""
        return self.metrics.get("touchdown_time")

    @property
    def was_airborne(self) -> bool:
        """Whether it left the ground; for shoves of a standing robot, touchdown is the start."""
        lift_off, touchdown = self.lift_off, self.touchdown
        return lift_off is not None and (touchdown is None or touchdown > lift_off)

    @property
    def was_on_pivot(self) -> bool:
        """Whether it was on a pivot: it is judged only by standing, and was not pushed.

        Its touchdown time is the time at which it must be upright.
        """
        return self.level is None and self.stands is not None and self.was_airborne


@dataclass(frozen=True, kw_only=True)
class StoppedRecord:
    """One flight in which a drive stops while its wheel keeps spinning.

    Attributes:
        scenario: name of the maneuver. module: with the stopped drive. instant: from lift-off [s].
        lands: whether it lands within tolerance; None: not judged.
        tilt: larger error of roll and pitch at touchdown [rad]; None: not judged.
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
    """Landings of the device when any one drive stops at any instant.

    Attributes:
        detection: time until the control law detects it [s].
        flights: for every drive at several instants of each maneuver.
        mass_without: mass of the lightest device that need not survive it [kg]; None: not computed.
    """

    detection: float
    flights: tuple[StoppedRecord, ...]
    mass_without: float | None = None

    @property
    def lost(self) -> tuple[StoppedRecord, ...]:
        """Flights that do not land within tolerance, or are not judged."""
        return tuple(flight for flight in self.flights if flight.lands is not True)

    @property
    def worst(self) -> StoppedRecord:
        """The flight with the largest tilt, among the lost ones if there are any."""
        return max(
            self.lost or self.flights,
            key=lambda flight: float("inf") if flight.tilt is None else flight.tilt,
        )


class Conclusion(StrEnum):
    """Verdict of a certificate."""

    CERTIFIED = "certified"
    SHORT = "falls short"
    UNDECIDED = "undecided"


@dataclass(frozen=True, kw_only=True)
class ReliabilityRecord:
    """Result of flights of sampled robots, for the required reliability.

    Attributes:
        asked: required fraction of robots that do all of their maneuvers.
        worse: fraction at which a device must not be certified; the test's alternative hypothesis.
        verdict: of the sequential test.
        samples: number of robots used. whole: number of those that do all maneuvers.
        whole_interval: exact 95 % interval of their fraction.
        passed, interval: the same for each scenario alone.
        seed, first: seed of the samples, and the index of the first.
        round: number of the round, from 1; 0 where the design was not revised by it.
        rounds: what was learnt in earlier rounds, one sentence each.
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
    """Whether a flight with the device fails, or required survival or reliability is not shown.

    An undecided certificate does not show it.
    """
    return (
        any(run.ocs and run.passed is not True for run in runs)
        or (survival is not None and bool(survival.lost))
        or (certificate is not None and certificate.verdict != Conclusion.CERTIFIED)
    )
