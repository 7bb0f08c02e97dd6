"""Motor, gear, housing and foot of a module, with what holds them together."""

from ocs_design.drive.gear import Gear, GearRoom
from ocs_design.drive.motor import Motor
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.foot import plate_back
from ocs_design.sizing.housing import half_height
from ocs_design.sizing.mass_moments import MassMoments, point, round_body
from ocs_design.sizing.motor_mount import MotorMount, mount_of
from ocs_design.sizing.shell import shell_moments


def drive_moments(motor: Motor) -> MassMoments[float]:
    """Of a motor about its middle.

    A solid cylinder; a thin disc if its length is not known, a point without its diameter. Either
    errs on the side of less inertia, by little: a motor of 0.1 kg and 40 mm has 2e-5 kg m^2 about
    its axis, Solo12 5e-2 kg m^2.
    """
    mass, radius = motor.mass or 0.0, (motor.diameter or 0.0) / 2.0
    across = mass * (3.0 * radius**2 + (motor.length or 0.0) ** 2) / 12.0
    return round_body(mass, mass * radius**2 / 2.0, across)


def gear_moments(gear: Gear) -> MassMoments[float]:
    """Of a gear as a point, about the middle of the outside of the housing's floor."""
    along, up = gear_middle(gear)
    return point(gear.mass).shifted(along, up)


def gear_middle(gear: Gear) -> tuple[float, float]:
    """Along the axis from the outside of the floor, and above it [m]."""
    room = gear.room or GearRoom()
    return -(plate_back(0.0) + room.depth / 2.0), room.center


def behind_floor(motor: Motor, gear: Gear, mount: MotorMount) -> MassMoments[float]:
    """What does not depend on the wheel, about the middle of the outside of the housing's floor.

    The motor stands behind the foot's plate; its mount's holes go through floor and plate.
    """
    driving = drive_moments(motor).shifted(motor_middle(motor, mount), mount.up)
    return driving + gear_moments(gear) + mount.moments()


def motor_middle(motor: Motor, mount: MotorMount) -> float:
    """Along the axis from the outside of the housing's floor [m]; see `behind_floor`."""
    return -(plate_back(0.0) + mount.gap + (motor.length or 0.0) / 2.0)


def standing(motor: Motor, gear: Gear, outer_radius: float, height: float) -> Carrier:
    """All that stands still around a wheel of that outer radius and height [m]."""
    mount = mount_of(motor, gear.room)
    behind = behind_floor(motor, gear, mount).shifted(-half_height(height), 0.0)
    return Carrier.of(behind + shell_moments(outer_radius, height, mount.holes.reach))
