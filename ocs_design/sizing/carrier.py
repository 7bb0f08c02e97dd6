"""What of a module stands still with the trunk, as one body."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.mass_moments import MassMoments


@dataclass(frozen=True)
class Carrier:
    """A body that is symmetric to the vertical plane through a wheel's axis.

    With the mass and both inertias alone it is a body of revolution at the wheel's centre.

    Attributes:
        mass: [kg].
        axial_inertia: about the axis through its centre of mass that is parallel to the wheel's,
            the rotor held still [kg m^2].
        transverse_inertia: about the horizontal one across it [kg m^2].
        vertical_inertia: about the vertical one [kg m^2]; None: as about the other across.
        product_of_inertia: entry yz of its inertia tensor, y along the wheel's axis away from the
            other module, z up [kg m^2].
        along, up: of its centre of mass from the wheel's centre [m]; negative: towards the other
            module, below the axis.
    """

    mass: float
    axial_inertia: float
    transverse_inertia: float
    vertical_inertia: float | None = None
    product_of_inertia: float = 0.0
    along: float = 0.0
    up: float = 0.0

    @classmethod
    def of(cls, moments: MassMoments[float]) -> "Carrier":
        """From its mass and moments about the wheel's centre."""
        mass = moments.mass
        along, up = (moments.y / mass, moments.z / mass) if mass else (0.0, 0.0)
        xx, yy, zz = moments.xx, moments.yy - mass * along**2, moments.zz - mass * up**2
        return cls(
            mass=float(mass),
            axial_inertia=float(xx + zz),
            transverse_inertia=float(yy + zz),
            vertical_inertia=float(xx + yy),
            product_of_inertia=float(mass * along * up - moments.yz),
            along=float(along),
            up=float(up),
        )

    @property
    def inertia(self) -> FloatArray:
        """About its centre of mass in the module's frame [kg m^2], shape (3, 3)."""
        across, upright = self.transverse_inertia, self.vertical_inertia
        found = np.diag([across, self.axial_inertia, across if upright is None else upright])
        found[1, 2] = found[2, 1] = self.product_of_inertia
        return found

    def mass_properties(self) -> MassProperties:
        """In the module's frame (`mass_moments`)."""
        return MassProperties(self.mass, np.array([0.0, self.along, self.up]), self.inertia)
