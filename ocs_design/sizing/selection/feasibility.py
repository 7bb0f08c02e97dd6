"""Whether there is any device, asked of many problems that are alike.

Which device is of no account, so that candidates need not be ranked: those are tried first whose
largest wheel exceeds what they need the most, and the first that is solved ends the search. Where
nothing is possible, nearly all candidates fall out by what they need with a wheel of no mass and by
the largest wheel in closed form.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, repeat

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.rim import web_axial_inertia
from ocs_design.requirement.froude import Envelope
from ocs_design.sizing.bound.rim_problem import BORE_SHARE, largest_spin_inertia
from ocs_design.sizing.selection.bounds import (
    cells_of,
    initial_guess,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidates import Candidates, Drives, drives_of, known_pairs
from ocs_design.sizing.selection.fixed_point import Guess, solve_stepwise
from ocs_design.sizing.selection.problem import SelectionProblem

_CELLS = 6
"""Ranges of the incidence: wider than those of `bounds`, for all drives at once."""

_FIRST, _BLOCK = 32, 512
"""Candidates that are bounded at once: few first, where any will do."""

_FIRST_SOLVED, _SOLVED = 4, 64
"""Candidates that are solved at once."""

_MOST_SOLVED = 128
"""Candidates that are solved before the answer is no: the most promising ones come first."""


@dataclass(frozen=True, eq=False)
class Field:
    """Drives of a problem that are still in question.

    Attributes:
        problem: what is asked for, and the room for it.
        drives: n of them.
        needed: what their wheels need at the least, whatever they weigh [kg m^2], shape (n,); inf
            where no wheel would do.
    """

    problem: SelectionProblem
    drives: Drives
    needed: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem, drives: Drives | None = None) -> "Field":
        """All motors and gears whose figures are known, or these drives."""
        if drives is None:
            pairs = np.argwhere(known_pairs(problem.motors, problem.gears))
            drives = drives_of(problem, pairs)
        cells, nothing = cells_of(problem.incidence, _CELLS), np.zeros(len(drives))
        needed = least_spin_inertias(problem, drives, cells, nothing)
        return cls(problem, drives, needed.min(axis=1))

    def changed(self, problem: SelectionProblem) -> "Field":
        """Field of these drives for a problem that differs in a limit."""
        old, drives = self.problem, self.drives
        before, after = ((each.bus_voltage, each.wheel_speed_max) for each in (old, problem))
        if before != after:
            drives = drives_of(problem, np.column_stack([drives.motor, drives.gear]))
        return Field.of(problem, drives)

    @property
    def possible(self) -> bool:
        """Whether any of the most promising has a device; what can only just be may be missed."""
        tried = 0
        for candidates, guess in self._bounded():
            if any_solved(candidates, guess):
                return True
            tried += len(candidates)
            if tried >= _MOST_SOLVED:
                break
        return False

    @property
    def conceivable(self) -> bool:
        """Whether no bound rules all of them out: if not, nothing is possible."""
        return any(len(candidates) for candidates, _ in self._bounded())

    def _bounded(self) -> Iterator[tuple[Candidates, Guess]]:
        """Candidates that no bound rules out, the most promising first, few at first."""
        left, needed = self._roomy()
        sizes = chain([_FIRST], repeat(_BLOCK))
        solved = chain([_FIRST_SOLVED], repeat(_SOLVED))
        while len(left):
            size = next(sizes)
            some = left.take(np.arange(min(size, len(left))))
            guess = initial_guess(some, needed[:size])
            rows = np.flatnonzero(np.isfinite(guess.mass))
            solved = chain([_FIRST_SOLVED], repeat(_SOLVED))
            while rows.size:
                count = next(solved)
                yield some.take(rows[:count]), guess.take(rows[:count])
                rows = rows[count:]
            left, needed = left.take(np.arange(size, len(left))), needed[size:]

    def _roomy(self) -> tuple[Candidates, FloatArray]:
        """Candidates whose largest wheel is large enough, and what they need [kg m^2].

        Those with the most to spare come first.
        """
        kinds, rows = np.arange(len(self.problem.materials)), np.arange(len(self.drives))
        material, row = (each.ravel() for each in np.meshgrid(kinds, rows))
        every = Candidates(self.problem, self.drives.take(row), material)
        beside, needed = every.drives.beside_rim, self.needed[row]
        largest = largest_spin_inertia(every.limits) + beside
        spare = largest / np.maximum(needed, 1e-15)
        roomy = np.flatnonzero((largest > beside) & (spare >= 1.0))
        order = roomy[np.argsort(-spare[roomy], kind="stable")]
        return every.take(order), needed[order]


def any_solved(candidates: Candidates, guess: Guess) -> bool:
    """Whether any of the candidates has a device; closes in no further than to the first."""
    return any(solved.point.feasible.any() for solved in solve_stepwise(candidates, guess))


def largest_wheel(problem: SelectionProblem, room: Envelope) -> float:
    """Spin inertia of the largest rim of any material, whatever its hoop stress [kg m^2].

    With its web, without its hub and what is cut off it. As wide and tall as may be, and as thick
    as its mass allows; if it must be thicker, lower.
    """
    density = np.array([material.density for material in problem.materials])
    outer, layer = room.outer_radius_max, np.pi * density * room.height_max
    bore = max(room.inner_radius_min, BORE_SHARE * outer)
    square = np.maximum(outer**2 - room.mass_max / layer, bore**2)
    inner = np.minimum(np.sqrt(square), outer - room.wall_min)
    mass = np.minimum(layer * (outer**2 - inner**2), room.mass_max)
    beside = np.zeros_like(inner)
    if problem.web:
        cut = problem.cuts.axial_inertia(inner, np.full_like(inner, outer), 1.0)
        web = web_axial_inertia(inner, problem.web_densities, problem.web_thickness)
        beside = web - density * cut
    inertia = np.where(inner >= bore, mass * (outer**2 + inner**2) / 2.0 + beside, 0.0)
    return float(inertia.max(initial=0.0))
