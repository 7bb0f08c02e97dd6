"""What of a module stands still with the trunk: motor, gear and housing."""

from dataclasses import dataclass

from ocs_design.drive.gear import Gear
from ocs_design.drive.motor import Motor
from ocs_design.sizing.housing import (
    housing_axial_inertia,
    housing_mass,
    housing_transverse_inertia,
)


@dataclass(frozen=True)
class Carrier:
    """A body of revolution about the wheel's axis, its centre of mass at the wheel's centre.

    Attributes:
        mass: [kg].
        axial_inertia: about the wheel's axis, the rotor held still [kg m^2].
        transverse_inertia: about any axis across it through its centre of mass [kg m^2].
    """

    mass: float
    axial_inertia: float
    transverse_inertia: float


def drive_carrier(motor: Motor, gear: Gear) -> Carrier:
    """Of motor and gear alone.

    The motor is a solid cylinder; a thin disc if its length is not known, a point without its
    diameter. The gear is a point. Either errs on the side of less inertia, by little: a motor of
    0.1 kg and 40 mm has 2e-5 kg m^2 about its axis, Solo12 5e-2 kg m^2.
    """
    mass, radius = motor.mass or 0.0, (motor.diameter or 0.0) / 2.0
    return Carrier(
        mass=mass + gear.mass,
        axial_inertia=mass * radius**2 / 2.0,
        transverse_inertia=mass * (3.0 * radius**2 + (motor.length or 0.0) ** 2) / 12.0,
    )


def housed(drive: Carrier, outer_radius: float, height: float) -> Carrier:
    """Motor and gear in the housing of a wheel of that outer radius and height [m]."""
    return Carrier(
        mass=drive.mass + housing_mass(outer_radius, height),
        axial_inertia=drive.axial_inertia + housing_axial_inertia(outer_radius, height),
        transverse_inertia=drive.transverse_inertia
        + housing_transverse_inertia(outer_radius, height),
    )
