"""What the maneuvers ask about roll and pitch at the design's incidence."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.requirement.requirement import Requirement


def design_momenta(requirement: Requirement, inertia: FloatArray) -> FloatArray:
    """Largest roll and largest pitch momentum [N m s], shape (2,).

    Maneuvers for which the device is turned by hand have no say in the design's incidence. What is
    asked about an axis for the sake of the coupling alone counts where the turn would else end off
    level: the cube root of next to nothing is much.

    Args:
        requirement: maneuvers and rate change.
        inertia: of the robot with its device, wheels braked [kg m^2], shape (3, 3).
    """
    whole, height = TiltInertia.of(inertia), requirement.standing_height
    alone = TiltInertia.uncoupled(whole.diagonal)
    found = [
        maneuver.momentum(whole if whole.strays(maneuver.stray).any() else alone, height)
        for maneuver in requirement.maneuvers
        if maneuver.incidence is None
    ]
    if requirement.rate_change is not None:
        found.append(whole.diagonal * requirement.rate_change)
    largest: FloatArray = np.max([np.zeros(2), *found], axis=0)
    return largest
