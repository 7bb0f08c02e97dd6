"""Where to look for candidates first: a lower bound of each with its own hub, mount and material.

The bounds of `bounds` hold for every wheel of a problem at once: that of the narrowest hub, at no
speed to speak of. Of a single candidate the lightest module of the spin inertia that its drive
needs is known, or that no wheel of it has room: it takes a hundredth of the time of its fixed
point.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray, put_rows
from ocs_design.sizing.housing import PlainDrum
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.module_radii import smallest_radius
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.selection.bounds import (
    least_inertia_around,
    needed_in_cells,
)
from ocs_design.sizing.selection.cells import cells_of
from ocs_design.sizing.selection.lot import Lot
from ocs_design.sizing.selection.problem import SelectionProblem

_OFF_THE_EDGE = 1.0 + 1e-10
# Of what is found to nine digits.
_SURELY = 1.0 - 1e-9


class Outset(NamedTuple):
    """Where to look for a candidate first; shape (n,) each.

    Attributes:
        spin_inertia: a lower bound [kg m^2].
        mass: a lower bound, of both modules [kg]; inf: there is none.
        angle: incidence [rad]. width: how far around it [rad]; 0: there only.
    """

    spin_inertia: FloatArray
    mass: FloatArray
    angle: FloatArray
    width: FloatArray

    def take(self, rows: NDArray[np.intp]) -> "Outset":
        """Those of these rows."""
        return Outset(*(column[rows] for column in self))

    def put(self, rows: NDArray[np.intp], others: "Outset") -> "Outset":
        """With others in these rows."""
        columns = zip(self, others, strict=True)
        return Outset(*(put_rows(own, rows, other) for own, other in columns))


def outset_of(problem: SelectionProblem, lot: Lot, spin_inertia: FloatArray) -> Outset:
    """Lower bounds of candidates, and the cell of incidences that asks for the least.

    Args:
        problem: robot, requirement, envelope, place.
        lot: n candidates.
        spin_inertia: a lower bound of their wheels' [kg m^2], shape (n,).
    """
    rim = _rim(lot, spin_inertia)
    alone = np.nan_to_num(lightest_module(rim, lot.limits, PlainDrum()).mass)
    # A wheel of more spin inertia is no smaller.
    radius = np.minimum(smallest_radius(rim, lot.limits), problem.envelope.outer_radius_max)
    inertia = least_inertia_around(problem, lot.drives, rim, radius, alone)
    cells = cells_of(problem.incidence)
    needed = needed_in_cells(problem, lot.drives, inertia, cells, spin_inertia)
    best = needed.argmin(axis=1)
    # A little beyond the best cell, as a bound need not lie where the best incidence does.
    low, high = np.array([(cell.low, cell.high) for cell in cells])[best].T
    spin = needed.min(axis=1)
    return Outset(spin, least_masses_of(lot, spin), (low + high) / 2.0, high - low)


def least_masses_of(lot: Lot, spin_inertia: FloatArray) -> FloatArray:
    """Of devices with wheels of at least that spin inertia [kg]; inf: no such wheel has room."""
    known = np.isfinite(spin_inertia)
    rim = _rim(lot, np.where(known, spin_inertia, 0.0))
    module = lightest_module(rim, lot.limits, lot.shell).mass
    mass = 2.0 * (lot.drives.mass + _SURELY * module)
    return np.where(known & (module > 0.0), mass, np.inf)


def _rim(lot: Lot, spin_inertia: FloatArray) -> FloatArray:
    """What rim and web must have of it [kg m^2], and at least what the smallest have."""
    least = smallest_spin_inertia(lot.limits) * _OFF_THE_EDGE
    return np.maximum(spin_inertia - lot.drives.beside_rim, least)
