"""Rims with their webs and shells, many at once."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray, put_rows


class ModuleShape(NamedTuple):
    """Hollow cylinders in their shells; NaN where no rim meets the limits.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m], all of one shape.
        rim_mass, web_mass, shell_mass: [kg].
    """

    inner_radius: FloatArray
    outer_radius: FloatArray
    height: FloatArray
    rim_mass: FloatArray
    web_mass: FloatArray
    shell_mass: FloatArray

    @property
    def mass(self) -> FloatArray:
        """Of rim, web and shell [kg]."""
        return self.rim_mass + self.web_mass + self.shell_mass

    def take(self, rows: NDArray[np.intp]) -> "ModuleShape":
        """Those of these rows."""
        return ModuleShape(*(values[rows] for values in self))

    def put(self, rows: NDArray[np.intp], others: "ModuleShape") -> "ModuleShape":
        """With others in these rows."""
        columns = zip(self, others, strict=True)
        return ModuleShape(*(put_rows(own, rows, other) for own, other in columns))
