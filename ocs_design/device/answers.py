"""Answers of the commands, as plain values that become JSON documents and tables (SI)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import vector
from ocs_design.common.errors import Infeasible
from ocs_design.common.records import recorded
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.device.records.design import SCHEMA_VERSION
from ocs_design.device.records.flights import (
    ReliabilityRecord,
    SurvivalRecord,
    ValidationRecord,
    falls_short,
)
from ocs_design.device.records.requirement import RobotRecord
from ocs_design.robot.leg_geometry import axis_name, up_axis
from ocs_design.robot.legs import ANKLED_JOINTS, is_wheel
from ocs_design.robot.posture import posture_sensitivity
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, kw_only=True)
class BoundAnswer:
    """A bound and its curve; SI.

    Attributes:
        axis: "roll" or "pitch".
        inertia: of the robot about it. rate_change, wheel_speed_max, incidence: as requested.
        paper: inertia of the one-wheel model as printed in the paper.
        required: the same with the paper's sign error corrected; used for sizing.
        spin_inertia: of each of two wheels at the incidence, from `required`.
        rate_changes, wheel_speeds: of the curve.
        curve: required inertia relative to the robot's, one row for each wheel speed.
    """

    schema_version: int = SCHEMA_VERSION
    axis: str
    inertia: float
    rate_change: float
    wheel_speed_max: float
    incidence: float
    paper: float
    required: float
    spin_inertia: float
    rate_changes: tuple[float, ...]
    wheel_speeds: tuple[float, ...]
    curve: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, kw_only=True)
class LayoutAnswer:
    """The lightest device of one layout.

    Attributes:
        layout: its name. wheels: number of wheels. mass: of the device [kg]. motor: its name.
        momentum: largest momentum of the wheels about roll, pitch and yaw, each alone [N m s].
        momentum_without_one: the least of it with any one wheel lost.
        survives: maneuvers that it does with any one wheel missing, by closed form.
        open: points that keep it from being built, as far as they concern its place on the trunk.
        without: why there is no device; empty if there is one.
    """

    layout: str
    wheels: int = 0
    mass: float | None = None
    motor: str = ""
    momentum: tuple[float, float, float] = (0.0, 0.0, 0.0)
    momentum_without_one: tuple[float, float, float] = (0.0, 0.0, 0.0)
    survives: tuple[str, ...] = ()
    open: tuple[str, ...] = ()
    without: str = ""


@dataclass(frozen=True, kw_only=True)
class LayoutsAnswer:
    """Devices of all layouts for one robot and requirement."""

    schema_version: int = SCHEMA_VERSION
    robot: str
    layouts: tuple[LayoutAnswer, ...]

    @property
    def exit_code(self) -> int:
        """0, or 4 if no layout has a device."""
        return Infeasible.exit_code if all(layout.without for layout in self.layouts) else 0


@dataclass(frozen=True, kw_only=True)
class PostureLine:
    """The robot in one posture: diagonal of its locked inertia, and alpha* (equal-rate)."""

    posture: str
    inertia_diagonal: tuple[float, float, float]
    incidence: float


def posture_lines(robot: Robot) -> tuple[PostureLine, ...]:
    """Inertia and alpha* over plausible postures; see `posture_sensitivity`."""
    return tuple(
        PostureLine(
            posture=posture,
            inertia_diagonal=vector(np.diag(posed.inertia)),
            incidence=incidence_by_criterion(posed.inertia)[Criterion.EQUAL_RATE],
        )
        for posture, posed in posture_sensitivity(robot).items()
    )


@dataclass(frozen=True, kw_only=True)
class LegLine:
    """A leg: link of its foot, kind of its end (`ball`, `sole`, `wheel`, `point`), its joints."""

    foot: str
    ends_in: str
    length: float
    joints: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ReadingLine:
    """An interpretation of a robot: trunk, links of the feet, and confidence, 0 to 1."""

    trunk: str
    legs: tuple[str, ...]
    confidence: float


@dataclass(frozen=True, kw_only=True)
class RecognitionRecord:
    """What was recognised in a robot.

    Attributes:
        trunk: link that carries the device.
        legs: with their feet.
        forward, left, up: axes of the trunk's link, as `+x`.
        stated: items specified by the user: `trunk`, `legs`.
        confidence: fraction of the signs that support it, 0 to 1; 1 where specified.
        speaks_for, speaks_against: the signs.
        likely: interpretations to choose from if ambiguous; otherwise empty.
    """

    trunk: str
    legs: tuple[LegLine, ...]
    forward: str
    left: str
    up: str
    stated: tuple[str, ...]
    confidence: float
    speaks_for: tuple[str, ...]
    speaks_against: tuple[str, ...]
    likely: tuple[ReadingLine, ...]

    @classmethod
    def of(cls, robot: Robot) -> "RecognitionRecord | None":
        """Record of a robot from a file; None for one given by numbers."""
        recognition = robot.recognition
        if recognition is None:
            return None
        reading = recognition.reading
        rotation = np.eye(3) if robot.mount is None else robot.mount.placement.rotation
        up = up_axis(robot.tree, robot.trunk, robot.legs) if robot.legs else np.eye(3)[2]
        legs = []
        for leg in robot.legs:
            end = "sole" if len(leg.joints) >= ANKLED_JOINTS else "point"
            if is_wheel(robot.tree.bodies[leg.body]):
                end = "wheel"
            elif leg.foot_radius > 0.0:
                end = "ball"
            line = LegLine(foot=leg.name, ends_in=end, length=leg.length, joints=leg.joints)
            legs.append(line)
        return cls(
            trunk=robot.trunk if robot.mount is None else robot.mount.link,
            legs=tuple(legs),
            forward=axis_name(rotation[:, 0]),
            left=axis_name(rotation[:, 1]),
            up=axis_name(rotation @ up),
            stated=tuple(sorted(recognition.specified)),
            confidence=reading.confidence,
            speaks_for=tuple(sign.what for sign in reading.signs if sign.holds),
            speaks_against=(
                *(sign.against for sign in reading.signs if sign.holds is False),
                *(doubt.what for doubt in reading.doubts),
            ),
            likely=tuple(
                recorded(ReadingLine, reading, legs=tuple(leg.name for leg in reading.legs))
                for reading in recognition.likely
            ),
        )


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """Everything that is known about a robot without a device.

    `recognition` is None for a robot given by numbers.
    """

    schema_version: int = SCHEMA_VERSION
    robot: RobotRecord
    joints: int
    links: int
    incidence_by_criterion: Mapping[str, float]
    heading_drift: tuple[float, float]
    incidence_by_posture: tuple[PostureLine, ...]
    recognition: RecognitionRecord | None = None


@dataclass(frozen=True, kw_only=True)
class FrontDevice:
    """The lightest device of a front's point; SI.

    Attributes:
        mass: of the whole device, with plate or pedestals [kg], as `size` reports it.
        share: fraction of the robot's mass.
        motor, gear, material: names in the catalogue.
        incidence: of the wheel axes.
        outer_radius, inner_radius, height, rim_mass: of one rim.
        spin_inertia: of one wheel, including the rotor.
        overvoltage: one sentence if the supply is above the motor's rating; empty otherwise.
    """

    mass: float
    share: float
    motor: str
    gear: str
    material: str
    incidence: float
    outer_radius: float
    inner_radius: float
    height: float
    rim_mass: float
    spin_inertia: float
    overvoltage: str = ""


@dataclass(frozen=True, kw_only=True)
class FrontPoint:
    """One value of the varied figure, and the lightest device there.

    Attributes:
        value: [SI].
        file: of its specification, below the output folder. specification: its text.
        device: the lightest device; None: there is none.
        reason: why there is none; empty if there is one.
    """

    value: float
    file: str
    specification: str
    device: FrontDevice | None
    reason: str


@dataclass(frozen=True, kw_only=True)
class Front:
    """Lightest devices over one varied figure; SI.

    Attributes:
        robot: its name. against, label: the varied figure, by name and as text.
        unit: unit for display. si_unit: unit of the values.
        own_value: value in the specification.
        remarks: what changes with the figure and what does not, and motors above their rating.
        assumptions: of the original specification.
        points: by increasing value.
    """

    schema_version: int = SCHEMA_VERSION
    robot: str
    against: str
    label: str
    unit: str
    si_unit: str
    own_value: float
    remarks: tuple[str, ...]
    assumptions: tuple[str, ...]
    points: tuple[FrontPoint, ...]

    @property
    def spans_own_value(self) -> bool:
        """Whether the specification's own value lies among the points."""
        return self.points[0].value <= self.own_value <= self.points[-1].value

    @property
    def feasible(self) -> tuple[FrontPoint, ...]:
        """Points that have a device."""
        return tuple(point for point in self.points if point.device is not None)

    @property
    def exit_code(self) -> int:
        """0, or 4 if no point has a device."""
        return 0 if self.feasible else Infeasible.exit_code

    def __repr__(self) -> str:
        masses = [1e3 * point.device.mass for point in self.feasible if point.device is not None]
        mass_range = f"{min(masses):.4g} to {max(masses):.4g} g" if masses else "no device"
        subject = f"{self.robot} against {self.label}"
        return f"<Front of {subject}: {len(self.points)} points, {mass_range}>"

    def _repr_html_(self) -> str:
        from ocs_design import as_html  # noqa: PLC0415 - the report stands above

        return as_html(self)


@dataclass(frozen=True, kw_only=True)
class Initialized:
    """The specification that `init` wrote.

    Attributes:
        file: the specification.
        robot: its name; None: none was given.
        next: the command that designs from it.
    """

    schema_version: int = SCHEMA_VERSION
    file: str
    robot: str | None
    next: str


@dataclass(frozen=True, kw_only=True)
class Exported:
    """The files that `export` wrote.

    Attributes:
        folder: output folder.
        files: SHA-256 of each file, by its path in the folder.
        warnings: about the robot or parts not drawn, one sentence each.
        notes: further remarks on the files.
    """

    schema_version: int = SCHEMA_VERSION
    folder: str
    files: Mapping[str, str]
    warnings: tuple[str, ...]
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Exported to {self.folder}: {len(self.files)} files>"


RESULT_FILE = "monte_carlo.json"
"""Record of a campaign, written last: a folder without it is incomplete, and the same command
completes it."""

CERTIFICATE_FOLDER = "certificate"
"""Folder of the flights of `--certify`."""

CONFIDENCE = 0.95
"""Confidence level of all intervals of probabilities."""

QUANTILES = (0.0, 0.05, 0.5, 0.95, 1.0)
BINS = 12
"""Quantiles that are reported of a spread, and number of bars of its histogram."""


@dataclass(frozen=True, kw_only=True)
class Share:
    """An estimated probability.

    Attributes:
        passed, flown: successes and trials.
        estimate: their ratio.
        low, high: ends of the exact interval at `CONFIDENCE`.
    """

    passed: int
    flown: int
    estimate: float
    low: float
    high: float

    @property
    def width(self) -> float:
        """Width of the interval."""
        return self.high - self.low


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A sampled quantity that correlates with the outcome.

    Attributes:
        quantity: see `uncertainty.quantities`.
        correlation: Spearman's, of the quantity with the severity, -1..1.
        either_way: whether the distance of the quantity from its median counts instead.
    """

    quantity: str
    correlation: float
    either_way: bool


@dataclass(frozen=True, kw_only=True)
class Histogram:
    """Distribution of a figure of the flights, SI.

    Attributes:
        quantiles: at `QUANTILES`.
        counts: of `BINS` equal bins from the lowest value to the highest.
    """

    quantiles: tuple[float, ...]
    counts: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class ScenarioSummary:
    """Summary of the flights of one scenario.

    Attributes:
        scenario: its name. success: probability that it passes.
        faults: number of flights that failed by each fault.
        attitude_error: largest of roll and pitch at touchdown and of a flip's missing angle [rad].
        peak_wheel_speed, peak_wheel_torque: in flight [rad/s], [N m].
        causes: quantities that correlate with bad outcomes. worst: samples, the worst first.
        advice: remedy for failures, where known; one sentence or empty.
        level: number of flights that touch down level; None: there is no touchdown.
        stands: number of robots upright at the end, regardless of leg loads; None: not applicable.
    """

    scenario: str
    success: Share
    faults: Mapping[str, int]
    attitude_error: Histogram | None
    peak_wheel_speed: Histogram | None
    peak_wheel_torque: Histogram | None
    causes: tuple[Cause, ...]
    worst: tuple[int, ...]
    advice: str = ""
    level: int | None = None
    stands: int | None = None


@dataclass(frozen=True, kw_only=True)
class MonteCarloRecord:
    """Results of a campaign of flights.

    Attributes:
        seed: of all samples. samples: number flown. asked: largest number requested.
        confidence: of the intervals.
        reality: the distribution of each key of `[reality]`, SI.
        success: probability that one robot passes all scenarios.
        scenarios: summary of each.
        certificate: where requested, see `certificate`.
    """

    seed: int
    samples: int
    asked: int
    confidence: float
    reality: Mapping[str, str]
    success: Share
    scenarios: tuple[ScenarioSummary, ...]
    certificate: ReliabilityRecord | None = None


@dataclass(frozen=True, kw_only=True)
class SampleRecord:
    """The one sample that was flown: its values by name, SI."""

    seed: int
    index: int
    values: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Validated:
    """Flights of a design that was read from its folder.

    `validation` has the flights as designed, or those of `sample` if given.
    """

    schema_version: int = SCHEMA_VERSION
    design: str
    robot: str
    warnings: tuple[str, ...]
    validation: tuple[ValidationRecord, ...]
    sample: SampleRecord | None = None
    monte_carlo: MonteCarloRecord | None = None
    survival: SurvivalRecord | None = None

    @property
    def exit_code(self) -> int:
        """0, or 1 if a scenario does not pass with the device, or a requirement is not met."""
        certificate = None if self.monte_carlo is None else self.monte_carlo.certificate
        return int(falls_short(self.validation, self.survival, certificate))

    def __repr__(self) -> str:
        flown = [run.passed for run in self.validation if run.ocs]
        text = f"{flown.count(True)} of {len(flown)} flights pass"
        if self.survival is not None:
            text += f", {len(self.survival.lost)} of {len(self.survival.flights)} lost by a drive"
        if self.monte_carlo is not None:
            success = self.monte_carlo.success
            text += f"; {success.passed:,} of {success.flown:,} sampled robots"
            if self.monte_carlo.certificate is not None:
                text += f", {self.monte_carlo.certificate.verdict}"
        return f"<Validated {self.robot}: {text}>"

    def _repr_html_(self) -> str:
        from ocs_design import as_html  # noqa: PLC0415 - the report stands above

        return as_html(self)
