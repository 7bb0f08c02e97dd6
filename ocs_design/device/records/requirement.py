"""Records of the robot and of the requirement on its device in `design.json`."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from math import isfinite, nan
from typing import Annotated, Any

import numpy as np

from ocs_design.common.arrays import FloatArray, Matrix, Vector, matrix, vector
from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath
from ocs_design.common.ranges import Length, NotNegative, Positive, Range
from ocs_design.common.records import recorded
from ocs_design.requirement.bound import SpinDemand
from ocs_design.requirement.kinds import MANEUVER_KINDS, kind_of
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.values import Choice, Quantities, Quantity
from ocs_design.robot.robot import Mount, Robot


@dataclass(frozen=True, kw_only=True)
class MountRecord:
    """Placement of the base frame B on the robot's own link; see `robot.Mount`.

    Attributes:
        link: of the robot's file.
        rotation: from B to the link's frame. position: of B's origin in that frame [m].
    """

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
    """The robot alone, in the base frame B; see `robot.Robot`.

    Attributes:
        name: from the file, or given.
        source: path of the file as given, `-` for standard input, `by hand`.
        sha256: of the bytes that were read; empty by hand.
        format: `urdf` (also from xacro), `mjcf` or `manual`.
        trunk: link that carries the device; B is its frame, unless `mount` says otherwise.
        floating_base: link of the tree's root.
        posture_name: `zero`, `stand`, or the name of a keyframe or SRDF state, with ` + joints` if
            some were set one by one.
        posture: value of every moving joint [rad or m].
        legs: link of each foot.
        standing_height: of B's origin above the feet [m]; None without legs.
        mass: [kg]. com: centre of mass in B [m].
        inertia: about the centre of mass, in B, joints held at `posture` [kg m^2].
        warnings: about the file, one sentence each.
        mount: how B is fixed to the file's own link; None if `trunk` is a link of the file.
        package_paths: folder of each package of `package://` addresses, as given.
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
    standing_height: Length | None
    mass: Positive
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
    """A required maneuver.

    Attributes:
        kind: as in `[[maneuver]]` of a specification. name: unique.
        gravity: during it [m/s^2]; 0 in orbit.
        incidence: to which the modules are turned by hand for it [rad]; None: the design's.
        parameters: the other keys of its kind, as in a specification (SI).
    """

    kind: str
    name: str
    gravity: float
    incidence: float | None
    parameters: Mapping[str, float | str | tuple[float, ...]]

    @classmethod
    def of(cls, maneuver: Maneuver) -> "ManeuverRecord":
        """The record of a required maneuver."""
        word, kind = kind_of(maneuver)
        common = {field.name for field in fields(Maneuver)}
        parameters = {
            name: value
            for name, value in asdict(maneuver).items()
            if name in kind.values and name not in common
        }
        return recorded(cls, maneuver, kind=word, parameters=parameters)

    def maneuver(self) -> Maneuver:
        """The required maneuver.

        Raises:
            OcsError: its kind is unknown, or does not have these fields, or one has an impossible
                value or contradicts the others.
        """
        kind, specified = MANEUVER_KINDS.get(self.kind), set(self.parameters)
        common = {field.name for field in fields(Maneuver)}
        if (
            kind is None
            or not set(kind.required) - common <= specified <= set(kind.values) - common
        ):
            raise OcsError(f"maneuver {self.name!r}: no {self.kind} with these figures is known")
        defaults = {field.name: field.default for field in fields(kind.maneuver)}
        recorded_values = {**self.parameters, "gravity": self.gravity, "incidence": self.incidence}
        for name, value in recorded_values.items():
            match kind.values[name]:
                case Choice(words=words):
                    possible = value in words
                case Quantities(counts=counts):
                    possible = isinstance(value, tuple) and len(value) in counts
                case Quantity(sign=sign, most=most):
                    figure = value if isinstance(value, float | int) else nan
                    possible = isfinite(figure) and sign.allows(figure) and abs(figure) <= most
            # A default means that nothing is specified, as a height of 0 in orbit.
            if not possible and value != defaults[name]:
                raise OcsError(
                    f"maneuver {self.name!r}: {name} of a {self.kind} cannot be {value!r}"
                )
        figures: dict[str, Any] = {**self.parameters}
        maneuver = kind.maneuver(
            name=self.name, gravity=self.gravity, incidence=self.incidence, **figures
        )
        if (contradiction := next(iter(maneuver.contradictions()), None)) is not None:
            raise OcsError(contradiction, hint="run `ocs-design size` again")
        return maneuver


@dataclass(frozen=True, kw_only=True)
class AxisInertia:
    """Inertia that the wheels must provide about each axis, in the one-wheel model.

    Attributes:
        pitch, roll: largest momentum about the axis over `wheel_speed_max` [kg m^2].
    """

    pitch: NotNegative
    roll: NotNegative

    @classmethod
    def of(cls, momenta: Sequence[FloatArray], wheel_speed_max: float) -> "AxisInertia":
        """Largest momenta of roll and pitch [N m s] over the highest speed [rad/s]."""
        roll, pitch = np.max(momenta, axis=0, initial=0.0) / wheel_speed_max
        return cls(pitch=float(pitch), roll=float(roll))


@dataclass(frozen=True, kw_only=True)
class RequirementRecord:
    """Requirement on the device, and all assumptions behind it.

    Attributes:
        maneuvers: all that are required.
        rate_change: of the trunk, about roll or pitch alone [rad/s]; None: not required.
        wheel_speed_max: highest speed of a wheel relative to the trunk [rad/s].
        required_inertia: by the paper's bound, whatever the incidence.
        spin_inertia_by_hand: of one wheel, if specified directly [kg m^2]; None: it is not.
        demands: of each maneuver, or of the rate change about each axis, on the wheels.
        assumptions: what was not specified, one sentence each.
        reliability: share of sampled robots that must pass; None: not required.
        detection: time until a stopped drive is detected [s], where the device must land level
            after any one stops; None: not required.
    """

    maneuvers: tuple[ManeuverRecord, ...]
    rate_change: NotNegative | None
    wheel_speed_max: Positive
    required_inertia: AxisInertia
    spin_inertia_by_hand: NotNegative | None
    demands: tuple[SpinDemand, ...]
    assumptions: tuple[str, ...]
    reliability: Annotated[float, Range(0.5, 1.0)] | None = None
    detection: NotNegative | None = None
