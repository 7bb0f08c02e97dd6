"""`design.json`: the one artefact that other commands and programs read.

Field names and units are the contract of `docs/output.md`: SI, radians, the base frame B, full
double precision. The dataclasses are the schema; a change of meaning needs a new `SCHEMA_VERSION`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import msgspec

from ocs_design.arrays import Matrix, Vector
from ocs_design.bounded_files import read_plain_file
from ocs_design.design import NO_CARRIER, Flywheel, Motor
from ocs_design.exceptions import OcsError
from ocs_design.robot_record import RobotRecord
from ocs_design.selection_record import SelectionRecord
from ocs_design.sizing.carrier import Carrier

SCHEMA_VERSION = 1

LARGEST = 16 << 20
"""Of a `design.json` [bytes]; that of a humanoid takes a fiftieth."""


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
    parameters: Mapping[str, float | tuple[float, ...]]


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
    """What was asked of the device, and everything that was assumed to ask it."""

    maneuvers: tuple[ManeuverRecord, ...]
    rate_change: float | None
    wheel_speed_max: float
    required_inertia: AxisInertia
    spin_inertia_by_hand: float | None
    demands: tuple[DemandRecord, ...]
    assumptions: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ModuleRecord:
    """One module in B."""

    name: Literal["left", "right"]
    axis: Vector
    position: Vector


@dataclass(frozen=True, kw_only=True)
class ClearanceRecord:
    """See `mounting.Clearance`."""

    part: str
    distance: float


@dataclass(frozen=True, kw_only=True)
class ReachRecord:
    """See `robot.obstacles.reach.Reach`."""

    part: str
    joints: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class MountingRecord:
    """See `mounting.Mounting`, whose `nearest` is the `clearance` of the device."""

    landing: ClearanceRecord | None
    reachable: tuple[ReachRecord, ...]
    com_shift: Vector
    inertia_change: Vector


@dataclass(frozen=True, kw_only=True)
class OcsRecord:
    """The device. `mass_total` is of both modules; `total_...` of robot and braked device.

    `fitting` is what is left to do by hand: see `export.fitting`.
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
    modules: tuple[ModuleRecord, ModuleRecord]
    clearance: ClearanceRecord | None
    flywheel: Flywheel
    motor: Motor
    carrier: Carrier = NO_CARRIER
    warnings: tuple[str, ...] = ()
    fitting: tuple[str, ...] = ()
    mounting: MountingRecord | None = None


@dataclass(frozen=True, kw_only=True)
class SizingRecord:
    """How the optimum was found. Shadow prices: kg of one rim per SI unit of the limit."""

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

    `maneuver` is the one that sets it, empty if none does; `note` is what the figures rest on.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    margin: float | None
    maneuver: str = ""
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class ValidationRecord:
    """One simulated run. `passed` is None where it could not be judged; `reason` says why.

    `note` says how the turn was changed to suit the wheels; empty if it was not. `can_stand` says
    whether the legs bear this landing when level; None: no legs, or a file that does not say.
    """

    scenario: str
    ocs: bool
    passed: bool | None
    reason: str
    note: str
    metrics: Mapping[str, float | bool | None]
    can_stand: bool | None = None


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
    validation: tuple[ValidationRecord, ...]
    control: ControlRecord | None = None
    reality: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str]


def design_to_json(design: OcsDesign) -> bytes:
    """The artefact as indented UTF-8 JSON; numbers that are not finite are null."""
    return msgspec.json.format(msgspec.json.encode(design), indent=2) + b"\n"


def read_design(path: Path) -> OcsDesign:
    """Read a `design.json`.

    Raises:
        OcsError: the file cannot be read, or is not a design of this schema version.
    """
    try:
        content = read_plain_file(path, LARGEST)
        version = msgspec.json.decode(content, type=_Version).schema_version
    except OSError as error:
        raise OcsError(
            f"{path}: {error.strerror}", hint="give the path of a design.json"
        ) from error
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: not a design.json: {error}") from error
    if version != SCHEMA_VERSION:
        raise OcsError(
            f"{path}: schema_version {version}, but this version reads {SCHEMA_VERSION}",
            hint="run `ocs-design size` again to write it anew",
        )
    try:
        return msgspec.json.decode(content, type=OcsDesign)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: {error}", hint="run `ocs-design size` again") from error


class _Version(msgspec.Struct):
    schema_version: int
