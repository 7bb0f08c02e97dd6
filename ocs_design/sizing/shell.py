"""What stands around one wheel and counts while its rim is chosen: housing and foot together."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.foot import (
    TRUNK_SCREWS,
    foot_mass,
    foot_mass_per_height,
    foot_moments,
    trunk_screw_moments,
)
from ocs_design.sizing.housing import (
    LID_SCREWS,
    housing_mass,
    housing_mass_per_height,
    housing_moments,
    lid_screw_moments,
)
from ocs_design.sizing.mass_moments import MassMoments, Real

SHELL_SCREWS = LID_SCREWS.mass + TRUNK_SCREWS.mass
"""Of lid and foot [kg]."""


class Shell(Protocol):
    """Whose mass grows with the rim's outer radius and height [m]."""

    def mass(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """[kg]."""

    def mass_per_height(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """dm/dh at constant R [kg/m]."""


@dataclass(frozen=True, eq=False)
class Printed:
    """Drum, lid and foot, with their screws.

    Attributes:
        mount_reach: of the holes in floor and plate, which the foot's plate is as wide as [m]; a
            scalar, or an array that broadcasts. The holes themselves are not in any mass.
    """

    mount_reach: float | FloatArray

    def mass(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """[kg]."""
        reach = np.asarray(self.mount_reach)
        parts = housing_mass(outer_radius, height) + foot_mass(outer_radius, height, reach)
        return parts + SHELL_SCREWS

    def mass_per_height(self, outer_radius: FloatArray, height: FloatArray) -> FloatArray:
        """dm/dh at constant R [kg/m]."""
        reach = np.asarray(self.mount_reach)
        of_foot = foot_mass_per_height(outer_radius, height, reach)
        return housing_mass_per_height(outer_radius) + of_foot

    def take(self, rows: NDArray[np.intp]) -> "Printed":
        """Those of these rows."""
        return Printed(np.asarray(self.mount_reach)[rows])


def shell_moments(outer_radius: Real, height: Real, mount_reach: Real) -> MassMoments[Real]:
    """Of drum, lid and foot about the wheel's centre, with their screws, no mount's holes."""
    housing = housing_moments(outer_radius, height) + lid_screw_moments(outer_radius, height)
    foot = foot_moments(outer_radius, height, mount_reach)
    return housing + foot + trunk_screw_moments(outer_radius, height)
