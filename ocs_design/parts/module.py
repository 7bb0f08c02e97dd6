"""A module without its wheel: motor, gear, housing and foot, with their fasteners."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from ocs_design.actuation.motor import AnyMotor, Gear, GearRoom
from ocs_design.common.arrays import FloatArray
from ocs_design.parts import foot as feet
from ocs_design.parts import housing as housings
from ocs_design.parts.cage import NO_POSTS, Posts
from ocs_design.parts.foot import Foot, foot_mass_per_height
from ocs_design.parts.housing import (
    LID_SCREWS,
    Housing,
    PlainDrum,
    housing_mass_per_height,
    housing_moments,
)
from ocs_design.parts.moments import MassMoments, Real, flat_ring, point, ring, round_body
from ocs_design.parts.motor_mount import MotorMount, mount_of
from ocs_design.parts.printed import LID_SCREW, PLATE_THICKNESS, MountHoles, ear_axis, half_height
from ocs_design.parts.solids import Carrier


def part_name(part: str, module: str) -> str:
    """Readable name of a part, as in "left foot"; with a number "foot 1" or "foot left_1"."""
    return f"{part} {module}" if module[-1:].isdigit() else f"{module} {part}"


@dataclass(frozen=True, eq=False)
class Printed:
    """Drum, lid and foot, with their screws, and the posts of a cage.

    Attributes:
        mount_reach: reach of the holes in floor and plate, which determines the width of the foot's
            plate [m]; a scalar, or an array that broadcasts. No mass accounts for the holes.
        posts: of the motor's cage, whose floor is not in any mass either.
        guard_wall: of the steel ring in the housing [m]; 0: none.
        foot_plate: thickness of the foot's plate [m].
        room: least rim height that the housing is made for (`MotorMount.room`) [m].
    """

    mount_reach: float | FloatArray
    posts: Posts[Any] = NO_POSTS
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    room: float | FloatArray = 0.0

    def mass(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """Total mass [kg]."""
        foot = self._foot(outer_radius, height)
        ring = (housings.guard_ring(foot.housing),) if self.guard_wall else ()
        parts = (*housings.undrilled(foot.housing), *ring, feet.undrilled(foot))
        bought: FloatArray = LID_SCREWS.mass + foot.screws.mass + self.posts.mass(height)
        return sum((part.mass() for part in parts), bought)

    def mass_per_height(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """Change of its mass with the rim's height at constant R [kg/m]."""
        foot = self._foot(outer_radius, height)
        around: FloatArray = housing_mass_per_height(outer_radius, self.guard_wall)
        around = around + foot_mass_per_height(foot)
        around = np.where(height >= np.asarray(self.room), around, 0.0)
        return around + self.posts.mass_per_height()

    def moments(self, outer_radius: Real, height: Real) -> MassMoments[Real]:
        """Moments of everything except the posts (`Posts.moments`) about the wheel's centre.

        Screws are points, with their heads on lid and base. The trunk's screws, opposite each
        other, stay at 45 degrees to the lateral direction while the foot turns under them: as far
        forward as sideways. Their product of inertia cancels between the left and the right foot,
        and is left out.
        """
        foot: Foot[Real] = self._foot(outer_radius, height)
        housing, held = foot.housing, foot.screws
        along = housing.half_height - LID_SCREWS.centre
        lid = ring(LID_SCREWS.mass + 0.0 * along, ear_axis(housing.radius, LID_SCREW))
        up = foot.base - held.centre - foot.wheel_height
        trunk = flat_ring(held.mass + 0.0 * up, foot.slot_radius)
        base = feet.undrilled(foot).moments().shifted(0.0, -foot.wheel_height)
        drum = housing_moments(housing) + lid.shifted(along, 0.0)
        return drum + base + trunk.shifted(0.0, up)

    def _foot(self, outer_radius: Real, height: Real) -> Foot[Real]:
        """Foot under a housing for a rim of at least `room`."""
        reach: Any = np.asarray(self.mount_reach)
        tall: Any = np.maximum(height, self.room)
        housing = Housing(outer_radius, tall, MountHoles(reach), LID_SCREW, self.guard_wall)
        return Foot(housing, self.foot_plate)


Shell: TypeAlias = Printed | PlainDrum
"""Structure around a wheel, whose mass grows with the rim's outer radius and height [m]."""


def drive_moments(motor: AnyMotor) -> MassMoments[float]:
    """Moments of a motor about its middle.

    A solid cylinder; a thin disc if its length is not known, a point without a diameter. Both
    underestimate the inertia slightly: a motor of 0.1 kg and 40 mm has 2e-5 kg m^2 about its axis,
    Solo12 5e-2 kg m^2. Its controller, a board behind it, is a point in the middle too.
    """
    mass, radius = motor.mass or 0.0, (motor.diameter or 0.0) / 2.0
    across = mass * (3.0 * radius**2 + (motor.length or 0.0) ** 2) / 12.0
    return round_body(mass, mass * radius**2 / 2.0, across) + point(motor.controller_mass)


def gear_moments(gear: Gear, foot_plate: float) -> MassMoments[float]:
    """Moments of a gear as a point, about the middle of the outside of the housing's floor."""
    room = gear.room or GearRoom()
    return point(gear.mass).shifted(-(foot_plate + room.depth / 2.0), room.center)


def moments_at_floor(motor: AnyMotor, gear: Gear, mount: MotorMount) -> MassMoments[float]:
    """Moments of parts attached to the housing's floor, about the middle of its outside.

    Screws and gear, minus the mount's holes through floor and plate, and a motor behind the plate.
    They are the same for any wheel.
    """
    fixed = gear_moments(gear, mount.foot_plate) + mount.moments_at_floor()
    if mount.cage is not None:
        return fixed
    middle = mount.foot_plate + mount.gap + (motor.length or 0.0) / 2.0
    return fixed + drive_moments(motor).shifted(-middle, mount.up)


def moments_at_wheel(motor: AnyMotor, mount: MotorMount) -> MassMoments[float]:
    """Moments of parts positioned by the wheel's hub, about the wheel's middle.

    Screws, and a motor in its cage with the cage's floor; for the posts see `Posts`. They are the
    same for any rim.
    """
    if mount.cage is None:
        return mount.moments_at_wheel()
    middle = mount.cage.front + (motor.length or 0.0) / 2.0
    return mount.moments_at_wheel() + drive_moments(motor).shifted(-middle, 0.0)


def carrier_of(
    motor: AnyMotor,
    gear: Gear,
    outer_radius: float,
    height: float,
    guard_wall: float = 0.0,
    *,
    foot_plate: float = PLATE_THICKNESS,
    on_bell: bool = False,
) -> Carrier:
    """All stationary parts around a wheel of this outer radius and height [m]."""
    mount = mount_of(motor, gear.room, foot_plate, on_bell=on_bell)
    height = max(height, mount.room)
    fixed = moments_at_floor(motor, gear, mount).shifted(
        -half_height(height), 0.0
    ) + moments_at_wheel(motor, mount)
    shell = Printed(mount.holes.reach, NO_POSTS, guard_wall, foot_plate)
    around = shell.moments(outer_radius, height)
    return Carrier.of(fixed + mount.posts.moments(height) + around)
