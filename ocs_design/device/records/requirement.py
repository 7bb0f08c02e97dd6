"""The robot and what is asked of its device, as `design.json` has them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ocs_design.common.arrays import Matrix, Vector, matrix, vector
from ocs_design.common.files import AnyPath
from ocs_design.common.records import recorded
from ocs_design.robot.robot import Mount, Robot


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
    def of(cls, robot: Robot, package_paths: Mapping[str, AnyPath] | None = None) -> "RobotRecord":
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
