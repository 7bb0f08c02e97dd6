"""What a device may be that nobody can want, though it does all that is asked."""

from collections.abc import Iterator
from math import cos, sin, sqrt

from ocs_design.arrays import FloatArray
from ocs_design.design import Device
from ocs_design.exceptions import SpecificationError
from ocs_design.robot.mass_properties import MassProperties

HEAVY = 0.3
"""Share of the robot's mass; Solo12's lightest device is at 0.07, the paper's wheels at 0.08."""


COUPLED = 0.02
"""Share of sqrt(I_xx I_yy); of 14 public robots only ANYmal with its arm to one side has more."""


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
    found = (*_heavy(device.mass, robot.mass), *_coupled(robot.inertia, device.incidence))
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


def _coupled(inertia: FloatArray, incidence: float) -> Iterator[str]:
    """A turn in pitch by theta takes I_yy theta / cos of the busier wheel, and I_xy theta / sin."""
    product = abs(float(inertia[0, 1]))
    share = product / sqrt(inertia[0, 0] * inertia[1, 1])
    if share <= COUPLED:
        return
    sine, cosine = sin(incidence), cos(incidence)
    more = product * cosine / (inertia[1, 1] * sine) if sine > 0.0 else float("inf")
    asks = f"{more:.0%} more than" if more < 1.0 else "more than twice what"
    yield (
        f"the robot's I_xy is {share:.0%} of its roll and pitch inertia: whoever pitches rolls, "
        "which the closed forms take apart; to pitch alone asks the busier wheel for up to "
        f"{asks} they count. The flights are simulated with it: see that they pass, ask for more "
        "time or a larger --alpha, or move what is on one side"
    )
