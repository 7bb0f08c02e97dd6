"""What the maneuvers ask about roll and pitch at the design's incidence."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.requirement.requirement import Requirement


def design_momenta(requirement: Requirement, inertia: FloatArray) -> FloatArray:
    """Largest roll and largest pitch momentum [N m s], shape (2,).

    Maneuvers for which the device is turned by hand have no say in the design's incidence.

    Args:
        requirement: maneuvers and rate change.
        inertia: of the robot with its device, wheels braked [kg m^2], shape (3, 3).
    """
    found = [
        np.abs(maneuver.momentum(inertia, requirement.standing_height))
        for maneuver in requirement.maneuvers
        if maneuver.incidence is None
    ]
    if requirement.rate_change is not None:
        found.append(np.diag(inertia)[:2] * requirement.rate_change)
    largest: FloatArray = np.max([np.zeros(2), *found], axis=0)
    return largest
