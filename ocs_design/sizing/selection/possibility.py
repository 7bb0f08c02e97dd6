"""Whether there is any device, asked of many problems that are alike.

Which device is of no account, so that candidates need not be ranked: those are tried first whose
largest wheel exceeds what they need the most, and the first that is settled ends the search. Where
nothing is possible, nearly all candidates fall out by what they need with a wheel of no mass and by
the largest wheel in closed form.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, repeat

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_closed_form import largest_spin_inertia
from ocs_design.sizing.selection.bounds import least_inertia_of_any, needed_in_cells
from ocs_design.sizing.selection.cells import cells_of
from ocs_design.sizing.selection.drive_table import DriveTable, drive_table, known_pairs
from ocs_design.sizing.selection.lot import Lot, lot_of, rim_limits
from ocs_design.sizing.selection.outset import Outset, outset_of
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.settling import any_settles

# Of the incidence: wider than those of `bounds`, for all drives at once.
_CELLS = 6
# Candidates that are bounded, and settled, at once: few first, where any will do.
_FIRST, _BLOCK = 32, 512
_FIRST_SETTLED, _SETTLED = 4, 64
# Candidates that are settled before the answer is no: the most promising ones come first.
_MOST_SETTLED = 128


@dataclass(frozen=True, eq=False)
class Field:
    """Drives of a problem that are still in question.

    Attributes:
        problem: what is asked for, and the room for it.
        drives: n of them.
        needed: what their wheels need at the least, whatever they weigh [kg m^2], shape (n,).
    """

    problem: SelectionProblem
    drives: DriveTable
    needed: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem) -> "Field":
        """Of all motors and gears whose figures are known."""
        pairs = np.argwhere(known_pairs(problem.motors, problem.gears))
        return cls._standing(problem, drive_table(problem, pairs))

    def changed(self, problem: SelectionProblem) -> "Field":
        """The same drives for a problem that differs in a limit."""
        old, drives = self.problem, self.drives
        before, after = ((each.bus_voltage, each.wheel_speed_max) for each in (old, problem))
        if before != after:
            pairs = np.column_stack([drives.motor, drives.gear])
            drives = drive_table(problem, pairs)
        return self._standing(problem, drives)

    @classmethod
    def _standing(cls, problem: SelectionProblem, drives: DriveTable) -> "Field":
        """With what they need at the least, inf where no wheel would do."""
        inertia, cells = least_inertia_of_any(problem, drives), cells_of(problem.incidence, _CELLS)
        needed = needed_in_cells(problem, drives, inertia, cells, np.zeros(len(drives)))
        return cls(problem, drives, needed.min(axis=1))

    @property
    def possible(self) -> bool:
        """Whether any of the most promising has a device; what can only just be may be missed."""
        tried = 0
        for lot, outset in self._bounded():
            if any_settles(self.problem, lot, outset):
                return True
            tried += len(lot.drives)
            if tried >= _MOST_SETTLED:
                break
        return False

    @property
    def conceivable(self) -> bool:
        """Whether no bound rules all of them out: if not, nothing is possible."""
        return any(len(lot.drives) for lot, _ in self._bounded())

    def _bounded(self) -> Iterator[tuple[Lot, Outset]]:
        """Candidates that no bound rules out, the most promising first, few at first."""
        material, row = self._roomy()
        sizes = chain([_FIRST], repeat(_BLOCK))
        while row.size:
            size = next(sizes)
            lot = lot_of(self.problem, self.drives.take(row[:size]), material[:size])
            yield from _ruled_in(self.problem, lot, self.needed[row[:size]])
            material, row = material[size:], row[size:]

    def _roomy(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Candidates whose largest wheel is large enough, those with the most to spare first.

        Material and row of each.
        """
        kinds = np.arange(len(self.problem.materials))
        material, row = (each.ravel() for each in np.meshgrid(kinds, np.arange(len(self.drives))))
        own = self.drives.take(row)
        limits = rim_limits(self.problem, material, own.overspeed, own.hub_radius, own.mount_reach)
        largest = largest_spin_inertia(limits) + own.beside_rim
        spare = largest / np.maximum(self.needed[row], 1e-15)
        roomy = np.flatnonzero((largest > own.beside_rim) & (spare >= 1.0))
        order = roomy[np.argsort(-spare[roomy], kind="stable")]
        return material[order], row[order]


def _ruled_in(
    problem: SelectionProblem, lot: Lot, needed: FloatArray
) -> Iterator[tuple[Lot, Outset]]:
    """Those of these candidates that their own bounds leave, the most promising first."""
    outset = outset_of(problem, lot, needed)
    rows = np.flatnonzero(np.isfinite(outset.mass))
    sizes = chain([_FIRST_SETTLED], repeat(_SETTLED))
    while rows.size:
        size = next(sizes)
        some, rows = rows[:size], rows[size:]
        yield lot.take(some), outset.take(some)
