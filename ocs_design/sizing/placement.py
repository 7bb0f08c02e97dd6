"""Where the two modules stand on the trunk."""

from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

from ocs_design.arrays import FloatArray, frozen
from ocs_design.drive.gear import GearRoom
from ocs_design.robot.bounds import trunk_top
from ocs_design.robot.robot import Robot
from ocs_design.sizing.foot import base_radius, larger, plate_back, wheel_height
from ocs_design.sizing.housing import half_height, housing_outer_radius
from ocs_design.sizing.motor_mount import HeldMotor, mount_of

CLEARANCE = 1.1
"""Room kept around a wheel, over the radius of the sphere that it sweeps at any incidence."""

Real = TypeVar("Real", float, FloatArray)


class Size(NamedTuple, Generic[Real]):
    """How much room a module takes.

    Attributes:
        reach: radius that housing, motor and the foot's base stay within at any incidence [m].
        standing: of the wheel's centre over what it stands on [m].
    """

    reach: Real
    standing: Real


def wheel_size(outer_radius: Real, height: Real) -> Size[Real]:
    """Of a bare wheel, that turns freely over what carries it."""
    reach = sphere_radius(outer_radius, height)
    return Size(reach, CLEARANCE * reach)


def module_size(
    outer_radius: Real,
    height: Real,
    behind_depth: Real,
    behind_radius: Real,
    mount_reach: Real,
) -> Size[Real]:
    """Of a housing on its foot, around a wheel of that outer radius and height, with its motor.

    All in metres. What stands behind the foot's plate, motor, gear and cage, goes so far back and
    so far to both sides: how high it stands is no matter to a turn about the vertical.
    """
    half = half_height(height)
    housing = (housing_outer_radius(outer_radius) ** 2 + half**2) ** 0.5
    motor = ((plate_back(half) + behind_depth) ** 2 + behind_radius**2) ** 0.5
    base = base_radius(outer_radius, height, mount_reach)
    return Size(larger(larger(housing, motor), base), wheel_height(outer_radius))


def motor_size(
    motor: HeldMotor, room: GearRoom | None, outer_radius: Real, height: Real
) -> Size[Real]:
    """Of a module with this motor behind a gear of that room, as far as its size is known."""
    zero, mount = 0.0 * outer_radius, mount_of(motor, room)
    depth, radius = mount.behind(motor)
    return module_size(outer_radius, height, zero + depth, zero + radius, zero + mount.holes.reach)


@dataclass(frozen=True)
class Place:
    """Centres of both modules as their size grows, the right one mirrored in y.

    Attributes:
        origin: of the left one, if it had no size, in B [m].
        outward: how far it stands off, per radius of the sphere that it sweeps, in B.
        upright: whether it stands on what is below it, and so as high as its foot makes it.
    """

    origin: tuple[float, float, float]
    outward: tuple[float, float, float]
    upright: bool = False

    def __call__(self, outer_radius: float, height: float) -> FloatArray:
        """Centres of bare wheels in B for R and h [m], left first, shape (2, 3)."""
        return self.centers(wheel_size(outer_radius, height))

    def centers(self, size: Size[float]) -> FloatArray:
        """In B [m], left first, shape (2, 3)."""
        x, y, z = self.left(size)
        return frozen([[x, y, z], [x, -y, z]])

    def left(self, size: Size[Real]) -> tuple[Real, Real, Real]:
        """Centre of the left module in B [m], of numbers, arrays or CasADi's symbols alike."""
        (x, y, z), (along_x, along_y, along_z) = self.origin, self.outward
        reach, standing = size.reach, size.standing if self.upright else 0.0 * size.standing
        return x + along_x * reach, y + along_y * reach, z + along_z * reach + standing


def sphere_radius(outer_radius: Real, height: Real) -> Real:
    """Of the sphere around a cylinder, sqrt(R^2 + h^2 / 4) [m]."""
    # No function of numpy: symbols know only operators.
    square: Real = outer_radius**2 + height**2 / 4.0
    reach: Real = square**0.5
    return reach


def place_on_top(robot: Robot) -> Place:
    """On top of the trunk over the centre of mass, symmetric to the sagittal plane.

    Each module may be turned to any incidence without touching the trunk or the other one. Other
    parts of the robot are not looked at: see `free_place`.
    """
    # To the micrometre, so that no rounding error of the centre of mass reaches the files.
    forward = round(float(robot.com[0]), 6) + 0.0
    top = round(trunk_top(robot.tree, robot.trunk), 6)
    return Place(origin=(forward, 0.0, top), outward=(0.0, CLEARANCE, 0.0), upright=True)


def place_at(position: tuple[float, ...]) -> Place:
    """The left module at `position` in B [m], the right one mirrored in y."""
    x, y, z = position
    return Place(origin=(x, y, z), outward=(0.0, 0.0, 0.0))
