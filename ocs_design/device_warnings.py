"""What a device may be that nobody can want, though it does all that is asked."""

from collections.abc import Iterator

from ocs_design.design import Device
from ocs_design.exceptions import SpecificationError
from ocs_design.robot.mass_properties import MassProperties

HEAVY = 0.3
"""Share of the robot's mass; Solo12's lightest device is at 0.07, the paper's wheels at 0.08."""


def device_warnings(
    device: Device, robot: MassProperties, *, strict: bool = False
) -> tuple[str, ...]:
    """One sentence each.

    Args:
        device: that was designed.
        robot: without it, in B.
        strict: they are errors.

    Raises:
        SpecificationError: `strict`, and there is any.
    """
    found = tuple(_heavy(device.mass, robot.mass))
    if strict and found:
        raise SpecificationError(
            f"--strict: {'; '.join(found)}", hint="Ask for less, or allow larger wheels."
        )
    return found


def _heavy(mass: float, robot_mass: float) -> Iterator[str]:
    share = mass / robot_mass
    if share > HEAVY:
        yield (
            f"the device weighs {mass:.3g} kg, {share:.0%} of the robot: more than {HEAVY:.0%} is "
            "rarely wanted; its legs must carry it"
        )
