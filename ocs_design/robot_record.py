"""The robot in `design.json`."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ocs_design.arrays import Matrix, Vector, matrix, vector
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
    def of(cls, robot: Robot, package_paths: Mapping[str, Path] | None = None) -> "RobotRecord":
        """The record of a robot that was read."""
        return cls(
            name=robot.name,
            source=robot.source,
            sha256=robot.sha256,
            format=str(robot.format),
            trunk=robot.trunk,
            floating_base=robot.floating_base,
            posture_name=robot.posture_name,
            posture=dict(robot.posture),
            legs=tuple(leg.name for leg in robot.legs),
            standing_height=robot.standing_height,
            mass=robot.mass,
            com=vector(robot.com),
            inertia=matrix(robot.inertia),
            warnings=robot.warnings,
            mount=None if robot.mount is None else MountRecord.of(robot.mount),
            package_paths={name: str(path) for name, path in (package_paths or {}).items()},
        )
