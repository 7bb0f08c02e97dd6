"""`design.json`: the one artefact that other commands and programs read.

Field names and units are the contract of `docs/output.md`: SI, radians, the base frame B, full
double precision. The dataclasses are the schema; a change of meaning needs a new `SCHEMA_VERSION`,
and a step in `_renewed` that reads what older versions wrote.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec
import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import Matrix, Vector, matrix, vector
from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath, read_plain_file
from ocs_design.common.units import format_quantity
from ocs_design.device.device import NO_CARRIER, Device, Flywheel, Module
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.moments import Carrier
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.robot.robot import Mount, Robot

DESIGN_FILE = "design.json"

Record = TypeVar("Record")


def recorded(kind: type[Record], live: object, /, **other: object) -> Record:
    """Record of a live value: its figures of the same names, and `other` in place of the rest."""
    record: Any = kind
    names = {each.name for each in fields(record)} - set(other)
    same = {name: getattr(live, name) for name in names if hasattr(live, name)}
    return kind(**same, **other)


@dataclass(frozen=True, kw_only=True)
class MountRecord:
    """How the base frame is fixed to the robot's own link; see `robot.Mount`."""

    link: str
    rotation: Matrix
    position: Vector

    @classmethod
    def of(cls, mount: Mount) -> "MountRecord":
        """The record of a mount."""
        place = mount.placement
        return cls(
            link=mount.link, rotation=matrix(place.rotation), position=vector(place.position)
        )


@dataclass(frozen=True, kw_only=True)
class RobotRecord:
    """The robot alone, in the frame of its trunk; see `robot.Robot`.

    `package_paths` are the folders that were given for `package://` addresses, by package.
    """

    name: str
    source: str
    sha256: str
    format: str
    trunk: str
    floating_base: str
    posture_name: str
    posture: Mapping[str, float]
    legs: tuple[str, ...]
    standing_height: float | None
    mass: float
    com: Vector
    inertia: Matrix
    warnings: tuple[str, ...]
    mount: MountRecord | None = None
    package_paths: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, robot: Robot, package_paths: Mapping[str, Path] | None = None) -> "RobotRecord":
        """The record of a robot that was read."""
        return recorded(
            cls,
            robot,
            format=str(robot.format),
            posture=dict(robot.posture),
            legs=tuple(leg.name for leg in robot.legs),
            com=vector(robot.com),
            inertia=matrix(robot.inertia),
            mount=None if robot.mount is None else MountRecord.of(robot.mount),
            package_paths={name: str(path) for name, path in (package_paths or {}).items()},
        )


@dataclass(frozen=True)
class TaskDemand:
    """What one part of the requirement asks of a drive.

    Attributes:
        source: name of the maneuver, or `rate change, roll` and `rate change, pitch`.
        incidence: of the modules during it [rad].
        spin_inertia: smallest of a wheel with which this drive does it in time [kg m^2].
        time_needed: at the least, with the wheel as designed, on the reserved share of voltage and
            current [s]; None: no time is set.
        time_given: [s]; None likewise.
        peak_speed: of the busier wheel in that least time [rad/s].
        peak_torque: of its motor at the wheel, accelerating or braking [N m]; None: no time is set.
    """

    source: str
    incidence: float
    spin_inertia: float
    time_needed: float | None
    time_given: float | None
    peak_speed: float
    peak_torque: float | None


@dataclass(frozen=True, kw_only=True)
class RankedRecord:
    """One of the lightest devices.

    Attributes:
        motor, gear, material: names in the catalogues. gear_ratio: motor speed over wheel speed.
        incidence: [rad].
        mass: of the whole device, the sum of those that follow. wheels_mass, motors_mass,
            gears_mass, housings_mass, plate_mass: [kg].
        spin_inertia: of each wheel [kg m^2].
        outer_radius, height: of its rim [m].
    """

    motor: str
    gear: str
    gear_ratio: float
    material: str
    incidence: float
    mass: float
    wheels_mass: float
    motors_mass: float
    gears_mass: float
    housings_mass: float
    spin_inertia: float
    outer_radius: float
    height: float
    plate_mass: float = 0.0


@dataclass(frozen=True, kw_only=True)
class RejectionRecord:
    """Why a motor has no place among the candidates.

    Attributes:
        motor: its name. reason: one word. detail: a sentence with figures.
    """

    motor: str
    reason: str
    detail: str


@dataclass(frozen=True, kw_only=True)
class CoDesignRecord:
    """What optimal control made of the selected device.

    Attributes:
        adopted: whether the device is the co-designed one; else the selection stands.
        status: of the solver. iterations: of the solver.
        mass: of the co-designed device [kg]; None if there is none.
        selected_mass: of the selected one [kg].
        violation: largest of any limit on a ten times finer grid, relative.
        remark: one sentence.
    """

    adopted: bool
    status: str
    iterations: int
    mass: float | None
    selected_mass: float
    violation: float | None
    remark: str


@dataclass(frozen=True, kw_only=True)
class PriceRecord:
    """What one more of a limit buys, the limit by its name in `sizing.limits.LIMITS`.

    Attributes:
        limit: its name. value: as it is [SI]. changed: the looser one [SI].
        mass_change: of the whole device [kg], at most 0.
    """

    limit: str
    value: float
    changed: float
    mass_change: float


@dataclass(frozen=True, kw_only=True)
class KeptRecord:
    """What is kept for a maneuver.

    Attributes:
        maneuver: its name. demand: factor on what is asked of the wheels, at least 1.
        needed: factor that the asked share of robots needs of this device; below 1, one that is
            designed for the mean has enough to spare.
        roll_rate, pitch_rate: that the trunk may begin with [rad/s].
        undone: rate of roll at lift-off that a flip undoes [rad/s]; 0: no flip.
        lost: share of robots that drift off level about an axis out of the wheels' reach.
    """

    maneuver: str
    demand: float
    needed: float
    roll_rate: float
    pitch_rate: float
    lost: float
    undone: float = 0.0


@dataclass(frozen=True, kw_only=True)
class UncertaintyCost:
    """What one uncertain quantity costs.

    Attributes:
        key: of `[reality]`. share: of what robots need more for all keys, each known by itself.
        mass: that the device would be lighter by if the quantity were known [kg].
    """

    key: str
    share: float
    mass: float


@dataclass(frozen=True, kw_only=True)
class ReserveRecord:
    """What is kept for what is drawn, and what it costs.

    Attributes:
        reliability: share of samples that shall pass. predicted: that do by the closed forms.
        scale: factor on every deviation; above 1 where flights showed more.
        nominal: mass of the lightest device without a reserve [kg].
        maneuvers: see `KeptRecord`. costs: the largest share first.
        curve: reliability and mass of the device of the same parts [kg], where there is one.
    """

    reliability: float
    predicted: float
    scale: float
    nominal: float
    maneuvers: tuple[KeptRecord, ...]
    costs: tuple[UncertaintyCost, ...]
    curve: tuple[tuple[float, float], ...]

    @property
    def demands(self) -> Mapping[str, float]:
        """Factor on what each maneuver asks, by its name."""
        return {each.maneuver: each.demand for each in self.maneuvers}


@dataclass(frozen=True, kw_only=True)
class SelectionRecord:
    """The choice of motor, gear, material and incidence.

    Attributes:
        bus_voltage: [V]. reserve: share of voltage, current and speed limit that it may use.
        candidates: how many combinations were looked at.
        binding_maneuver: what asks for the most spin inertia. binding: limits that hold the mass.
        tasks: of the chosen drive. ranking: lightest first. rejections: by motor.
        co_design: None if it was not asked for.
        prices: of the limits, before any co-design; empty where an older version wrote the file.
        kept: for what is drawn; None likewise, or without maneuvers.
    """

    bus_voltage: float
    reserve: float
    candidates: int
    binding_maneuver: str
    binding: tuple[str, ...]
    tasks: tuple[TaskDemand, ...]
    ranking: tuple[RankedRecord, ...]
    rejections: tuple[RejectionRecord, ...]
    co_design: CoDesignRecord | None
    prices: tuple[PriceRecord, ...] = ()
    kept: ReserveRecord | None = None


SCHEMA_VERSION = 2

OLDEST_VERSION = 1
"""Version of the oldest documents that are still read."""

LARGEST = 16 << 20
"""Largest `design.json` [bytes]; that of a humanoid takes a fiftieth."""


@dataclass(frozen=True, kw_only=True)
class Tool:
    """Who wrote the file."""

    name: str
    version: str


@dataclass(frozen=True, kw_only=True)
class ManeuverRecord:
    """A maneuver: its kind, and the fields of that kind (SI)."""

    kind: str
    name: str
    gravity: float
    incidence: float | None
    parameters: Mapping[str, float | str | tuple[float, ...]]


@dataclass(frozen=True, kw_only=True)
class DemandRecord:
    """What one source of demand asks at its incidence angle: see `requirement.bound.SpinDemand`."""

    source: str
    incidence: float
    roll_momentum: float
    pitch_momentum: float
    spin_inertia: float
    torque: float


@dataclass(frozen=True, kw_only=True)
class AxisInertia:
    """Inertia of the one-wheel model that the wheels must present on each axis [kg m^2]."""

    pitch: float
    roll: float


@dataclass(frozen=True, kw_only=True)
class RequirementRecord:
    """What was asked of the device, and everything that was assumed to ask it.

    `reliability` is the share of robots that shall pass as built; None: none was asked for.
    `detection` is the time until it is known that a drive has stopped [s], where the device shall
    land level though any one does; None: it need not.
    """

    maneuvers: tuple[ManeuverRecord, ...]
    rate_change: float | None
    wheel_speed_max: float
    required_inertia: AxisInertia
    spin_inertia_by_hand: float | None
    demands: tuple[DemandRecord, ...]
    assumptions: tuple[str, ...]
    reliability: float | None = None
    detection: float | None = None


@dataclass(frozen=True, kw_only=True)
class ModuleRecord:
    """One module in B."""

    name: str
    axis: Vector
    position: Vector


@dataclass(frozen=True)
class Clearance:
    """The part that a module is nearest to.

    Attributes:
        part: name of a body of the robot, or of the other wheel.
        distance: between the surfaces, negative if they overlap [m].
    """

    part: str
    distance: float


@dataclass(frozen=True, kw_only=True)
class ReachRecord:
    """Limb that could hit the device (`robot.clearance.Reach`)."""

    part: str
    joints: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class MountingRecord:
    """How the device sits on its robot (`sizing.mounting.Mounting`)."""

    landing: Clearance | None
    reachable: tuple[ReachRecord, ...]
    com_shift: Vector
    inertia_change: Vector


@dataclass(frozen=True, kw_only=True)
class OcsRecord:
    """The device. `mass_total` is of all modules; `total_...` of robot and braked device.

    `center_of_mass` is of the device alone, in B; None in files of older versions.
    `fitting` is what is left to do by hand: see `export.fitting`. `layout` is how the axes lie, and
    `incidence` its angle: of a pair the axes are at plus and minus that.
    """

    incidence: float
    incidence_criterion: str
    incidence_by_criterion: Mapping[str, float]
    incidence_by_criterion_robot_alone: Mapping[str, float]
    heading_drift: tuple[float, float]
    spin_inertia: float
    mass_total: float
    total_mass: float
    total_inertia: Matrix
    total_com: Vector
    modules: tuple[ModuleRecord, ...]
    clearance: Clearance | None
    flywheel: Flywheel
    motor: Drive
    carrier: Carrier = NO_CARRIER
    plate: CarrierPlate | None = None
    pedestals: tuple[Pedestal, ...] = ()
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    on_bell: bool = False
    center_of_mass: Vector | None = None
    warnings: tuple[str, ...] = ()
    fitting: tuple[str, ...] = ()
    mounting: MountingRecord | None = None
    layout: Literal[
        "single",
        "pair",
        "double-pair",
        "triple-pair",
        "triad",
        "orthogonal",
        "pyramid",
        "by-hand",
    ] = "pair"

    def device(self, supply: Supply | None = None) -> Device:
        """The device that was designed, to the last digit; `supply` is what feeds it."""
        modules = (
            Module(each.name, np.array(each.axis), np.array(each.position)) for each in self.modules
        )
        return Device(
            self.incidence,
            tuple(modules),
            self.flywheel,
            self.motor,
            self.carrier,
            supply,
            plate=self.plate,
            guard_wall=self.guard_wall,
            foot_plate=self.foot_plate,
            layout=self.axes,
            pedestals=self.pedestals,
            on_bell=self.on_bell,
        )

    @property
    def axes(self) -> Layout:
        """Layout of the modules' axes."""
        name = LayoutName(self.layout)
        axes = (each.axis for each in self.modules)
        return Layout(name, tuple(axes) if name is LayoutName.BY_HAND else ())


@dataclass(frozen=True, kw_only=True)
class SizingRecord:
    """How the optimum was found.

    Attributes:
        status, method: of the optimum. objective: what was minimised [kg]: the mass of the whole
            device, or of one rim.
        binding: limits that hold the mass up.
        shadow_prices: change of the mass of one module per change of each binding limit [kg per SI
            unit of the limit].
        gap: relative, of the optimum.
        residual: of the fixed point, relative. iterations: to it.
    """

    status: str
    method: str
    objective: float
    binding: tuple[str, ...]
    shadow_prices: Mapping[str, float]
    gap: float
    residual: float
    iterations: int


@dataclass(frozen=True, kw_only=True)
class MarginRecord:
    """Demand against capacity; `margin` is capacity over demand, None where there is no limit.

    `scenario` is the one that sets it, empty if none does; `note` is what the figures rest on.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    margin: float | None
    scenario: str = ""
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class ValidationRecord:
    """One simulated run.

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
    verdict: Literal["certified", "falls short", "undecided"]
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
        or (certificate is not None and certificate.verdict == "falls short")
    )


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


SAVES_NOTHING = "saves nothing"
"""Note of an alternative that is no lighter than the device."""


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """A lighter or simpler device that one change of the question would give.

    Attributes:
        change: what would be different, as a person would say it.
        mass_total: of both modules [kg]; None: there is no device then.
        motor: its name; empty where there is no device.
        note: what speaks for or against it; empty if nothing does.
    """

    change: str
    mass_total: float | None
    motor: str
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Owed:
    """The maneuver that the mass is owed to.

    Attributes:
        maneuver: its name; empty: no single one, without any of them it weighs the same.
        mass_without: of both modules that do all else [kg]; None: nothing else is asked.
    """

    maneuver: str
    mass_without: float | None


@dataclass(frozen=True, kw_only=True)
class Lighter:
    """What would have to give for a lighter device.

    Attributes:
        by: mass that both modules are to lose [kg].
        changes: each of which does it; empty: none that was looked for.
    """

    by: float
    changes: tuple[Alternative, ...]


@dataclass(frozen=True, kw_only=True)
class OpenPoint:
    """What keeps a device from being built, and the cure."""

    what: str
    cure: str


@dataclass(frozen=True, kw_only=True)
class Buildable:
    """Whether the device can be built as it stands; None where that cannot be told."""

    yes: bool | None
    open: tuple[OpenPoint, ...] = ()


@dataclass(frozen=True, kw_only=True)
class OcsDesign:
    """A designed, exported and simulated orientation control system."""

    schema_version: int
    tool: Tool
    seed: int
    robot: RobotRecord
    requirement: RequirementRecord
    ocs: OcsRecord
    sizing: SizingRecord
    selection: SelectionRecord | None = None
    margins: tuple[MarginRecord, ...]
    supply: Supply | None = None
    alternatives: tuple[Alternative, ...] = ()
    owed: Owed | None = None
    lighter: Lighter | None = None
    buildable: Buildable = field(default_factory=lambda: Buildable(yes=None))
    validation: tuple[ValidationRecord, ...]
    survival: SurvivalRecord | None = None
    reliability: ReliabilityRecord | None = None
    control: ControlRecord | None = None
    reality: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str]

    def __repr__(self) -> str:
        ocs, flown = self.ocs, [run for run in self.validation if run.ocs]
        motor = "no motor" if self.selection is None else ocs.motor.name
        passed = [run.passed for run in flown].count(True)
        return (
            f"<OcsDesign for {self.robot.name}: {len(ocs.modules)} wheels, "
            f"{format_quantity(ocs.mass_total, 'g')}, {motor}, "
            f"{passed} of {len(flown)} flights pass>"
        )

    def _repr_html_(self) -> str:
        from ocs_design import as_html  # noqa: PLC0415 - the report stands above

        return as_html(self)


def design_file(path: AnyPath) -> Path:
    """The `design.json` at a path, or in the folder there."""
    path = Path(path)
    return path / DESIGN_FILE if path.is_dir() else path


def read_design(path: AnyPath) -> OcsDesign:
    """Read a `design.json`.

    Args:
        path: of the file, or of the folder that it lies in.

    Raises:
        OcsError: the file cannot be read, or is not a design of this schema version.
    """
    path = design_file(path)
    try:
        content = read_plain_file(path, LARGEST)
        version = msgspec.json.decode(content, type=_Version).schema_version
    except OSError as error:
        raise OcsError(
            f"{path}: {error.strerror}", hint="give the path of a design.json"
        ) from error
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        hint = "give a design.json, which `ocs-design size` writes"
        if content.lstrip().startswith(b"<"):
            raise OcsError(f"{path}: is a robot or other XML, not a design", hint=hint) from error
        if path.suffix == ".toml":
            raise OcsError(f"{path}: is a specification, not a design", hint=hint) from error
        raise OcsError(f"{path}: not a design.json: {error}", hint=hint) from error
    if not OLDEST_VERSION <= version <= SCHEMA_VERSION:
        raise OcsError(
            f"{path}: schema_version {version}, but this version reads {OLDEST_VERSION} to "
            f"{SCHEMA_VERSION}",
            hint="run `ocs-design size` again to write it anew",
        )
    try:
        if version == SCHEMA_VERSION:
            return msgspec.json.decode(content, type=OcsDesign)
        return msgspec.convert(_renewed(msgspec.json.decode(content)), OcsDesign)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: {error}", hint="run `ocs-design size` again") from error


def _renewed(document: dict[str, Any]) -> dict[str, Any]:
    """Document of version 1 in the names of version 2; what it lacks takes its default.

    Version 1 said of a run only whether it passed, which takes a level touchdown, and an upright
    end where the legs bear one.
    """
    margins, runs = (document.get(name) for name in ("margins", "validation"))
    for margin in _objects(margins):
        margin["scenario"] = margin.pop("maneuver", "")
    for run in _objects(runs):
        if run.get("passed") is True:
            run["level"] = True
            run["stands"] = True if run.get("can_stand") is True else None
    return {**document, "schema_version": SCHEMA_VERSION}


def _objects(entries: object) -> list[dict[str, Any]]:
    """Objects in a list of any document; what is none of them is refused when it is converted."""
    found = entries if isinstance(entries, list) else []
    return [each for each in found if isinstance(each, dict)]


class _Version(msgspec.Struct):
    schema_version: int
