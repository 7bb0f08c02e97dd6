"""Branch and bound over motors, gears and materials; the incidence is solved for.

Every pair of a motor and a gear carries a lower bound on the mass of its lightest device, which is
tightened step by step (`bounds`) and becomes the mass itself where the fixed point is solved
(`fixed_point`), for the most promising candidates first (docs/theory.md, The selection).
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.sizing.selection.bounds import (
    CELLS,
    PairBounds,
    cells_of,
    initial_guess,
    least_masses,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidates import Candidates, Guess, drives_of
from ocs_design.sizing.selection.drives import Drives
from ocs_design.sizing.selection.fixed_point import FixedPoint, Solved, solve_stepwise
from ocs_design.sizing.selection.problem import SelectionProblem, lightest_first

RANKED = 10
"""Least number of devices that a selection lists."""

MOTORS = 5
"""Number of motors whose lightest device it lists: not every motor can be bought."""

_BATCH = 24
_AHEAD = 256
"""Number of candidates bounded at once before the next are solved."""

_CHUNK = 1024
_PROMISING = 0.998
"""Margin above which a candidate that is infeasible where it was solved may be feasible nearby."""

_FALL, _FALL_STATED = 0.03, 0.003
"""Largest fraction of the mass that a refinement may save, and the same at a specified incidence,
where it saved at most 1e-4 on the robots tried."""


@dataclass(frozen=True)
class Rank:
    """Entry of one of the lightest devices: mass [kg], batch and row where it is stored, and parts.

    Attributes:
        parts: indices of motor, gear and material.
        widest: largest outer radius of its rim, or of a ring that its bond holds [m].
        strength: of the material [Pa]; 0: unknown.
    """

    mass: float
    batch: int
    row: int
    parts: tuple[int, int, int]
    widest: float
    strength: float

    @property
    def motor(self) -> int:
        """Index of the motor."""
        return self.parts[0]


@dataclass(eq=False)
class Found(PairBounds):
    """Results of a search so far.

    Attributes:
        batches: solved candidates. places: entries of the lightest, lightest first.
        below: mass above which devices are of no interest [kg].
        ranks: whether the next lightest are searched for too.
    """

    batches: list[Solved] = field(default_factory=list)
    places: list[Rank] = field(default_factory=list)
    below: float = np.inf
    ranks: bool = True

    @property
    def lightest(self) -> float:
        """Mass of the lightest device so far [kg]; inf: none."""
        return self.places[0].mass if self.places else np.inf

    @property
    def enough(self) -> FloatArray:
        """Mass below which a device of each motor is listed [kg], shape (motors,)."""
        if not self.ranks:
            return np.full(len(self.problem.motors), min(self.lightest, self.below))
        best = _best_of_motors(self.places)
        # A new motor must be lighter than the last one listed; a listed one must improve on itself.
        last = best[-1].mass if len(best) >= MOTORS else np.inf
        masses = np.full(len(self.problem.motors), last)
        for rank in best:
            masses[rank.motor] = rank.mass
        tenth = self.places[RANKED - 1].mass if len(self.places) >= RANKED else np.inf
        enough: FloatArray = np.maximum(masses, tenth)
        return enough

    @property
    def devices(self) -> list[Solved]:
        """The lightest devices, in order of mass, one row each."""
        return [self.batches[rank.batch].take(np.array([rank.row])) for rank in self.places]

    def add(self, solved: Solved) -> None:
        """Add solved candidates, and list those that belong among the lightest."""
        self.batches.append(solved)
        self._list([*self.places, *_ranks(len(self.batches) - 1, solved)])

    def solve_best(self, drives: Drives, spin: FloatArray, bound: FloatArray) -> None:
        """Solve candidates in the order of their bounds, which become masses in place."""
        material, row = np.nonzero(bound < self.enough[drives.motor])
        candidates = Candidates(self.problem, drives.take(row), material)
        nowhere = np.zeros_like(spin[row])
        guess = Guess(spin[row], bound[material, row], nowhere, nowhere)
        left, rough = np.arange(row.size), np.ones(row.size, dtype=np.bool_)
        while True:
            left = left[guess.mass[left] < self.enough[candidates.drives.motor[left]]]
            left = left[np.argsort(guess.mass[left], kind="stable")]
            some, ahead = left[:_BATCH], left[:_AHEAD]
            if not some.size:
                break
            if rough[some].any():
                closer = ahead[rough[ahead]]
                rough[closer] = False
                bounds = initial_guess(candidates.take(closer), guess.spin_inertia[closer])
                guess = guess.put(closer, bounds)
                continue
            *_, solved = solve_stepwise(candidates.take(some), guess.take(some))
            self.add(solved)
            guess.mass[some] = solved.mass
            left = left[_BATCH:]
        bound[material, row] = guess.mass

    def refine(self, by: Callable[[Candidates, FixedPoint], FixedPoint]) -> None:
        """Refine candidates that may be the lightest of all, or may be feasible and lighter.

        Args:
            by: finds the lightest device of one candidate near a point (`refinement.refine`).
        """
        fall = _FALL if self.problem.incidence is None else _FALL_STATED
        for index, batch in enumerate(self.batches):
            near = batch.mass < (1.0 + fall) * self.lightest
            hope = ~batch.point.feasible & (batch.point.margin > _PROMISING)
            for row in np.flatnonzero((near | hope) & (batch.guess.mass < self.lightest)):
                at = np.array([row])
                one = batch.take(at)
                point = by(one.candidates, one.point)
                better = replace(one, point=replace(point, iterations=one.point.iterations))
                if better.mass[0] < one.mass[0]:
                    self.batches[index] = self.batches[index].put(at, better)
                    pair = one.candidates.drives.motor, one.candidates.drives.gear
                    np.minimum.at(self.least, pair, better.mass)
        self._list([rank for i, batch in enumerate(self.batches) for rank in _ranks(i, batch)])

    def _list(self, ranks: Sequence[Rank]) -> None:
        """List the lightest of these, and the lightest of each of the best motors."""
        lightest: dict[tuple[int, int, int], Rank] = {}
        for rank in _ordered(ranks):
            lightest.setdefault(rank.parts, rank)
        ordered = list(lightest.values())
        self.places = _ordered({*ordered[:RANKED], *_best_of_motors(ordered)})


def _ranks(batch: int, solved: Solved) -> Iterator[Rank]:
    candidates, mass = solved.candidates, solved.mass
    drives = candidates.drives
    parts = np.stack([drives.motor, drives.gear, candidates.material], axis=1).tolist()
    widest = np.broadcast_to(candidates.limits.outer_radius_max, mass.shape)
    for row in np.flatnonzero(solved.point.feasible).tolist():
        motor, gear, material = parts[row]
        strength = candidates.problem.materials[material].yield_strength or 0.0
        yield Rank(
            float(mass[row]), batch, row, (motor, gear, material), float(widest[row]), strength
        )


def _ordered(ranks: Iterable[Rank]) -> list[Rank]:
    """The lightest first; among equally heavy ones the safest, as in `devices_by_mass`."""

    def preference(rank: Rank) -> tuple[float, float, tuple[int, int, int], float, int, int]:
        return -rank.widest, -rank.strength, rank.parts, rank.mass, rank.batch, rank.row

    return lightest_first(ranks, lambda rank: rank.mass, preference)


def _best_of_motors(ordered: Sequence[Rank]) -> list[Rank]:
    """The lightest of each of the best motors, lightest first."""
    best: dict[int, Rank] = {}
    for rank in ordered:
        best.setdefault(rank.motor, rank)
    return list(best.values())[:MOTORS]


def search(problem: SelectionProblem, below: float = np.inf, *, ranks: bool = True) -> Found:
    """The lightest devices, and a lower bound of the mass for every motor with every gear.

    Every motor with every gear is examined whose bound may put it in the list. None is refined yet
    (`Found.refine`): at a specified incidence the result is the lightest to within 0.1 % of its
    mass.

    Args:
        problem: see `SelectionProblem`.
        below: only lighter devices need to be found [kg]. ranks: False: only the lightest is
            searched for.
    """
    found = Found.of(problem)
    found.below, found.ranks = below, ranks
    least = np.where(found.known, found.least, np.nan)
    order = np.argsort(least, axis=None, kind="stable")[: int(found.known.sum())]
    pairs = np.stack(np.unravel_index(order, least.shape), axis=-1)
    # Every motor once with its lightest gear, then all.
    _, first = np.unique(pairs[:, 0], return_index=True)
    rest = np.delete(pairs, first, axis=0)
    chunks = (rest[start : start + _CHUNK] for start in range(0, len(rest), _CHUNK))
    webs = np.arange(len(problem.lightenings))
    for some in (pairs[first], *chunks):
        # Bound those that may be listed, then solve those that still may be.
        asked = some[found.least[tuple(some.T)] < found.enough[some[:, 0]]]
        if not asked.size:
            continue
        drives = drives_of(problem, np.repeat(asked, webs.size, axis=0), np.tile(webs, len(asked)))
        spin = np.zeros(len(drives))
        bound = np.full((len(problem.materials), len(drives)), -np.inf)
        for count in (1, CELLS):
            worth = np.flatnonzero(bound.min(axis=0) < found.enough[drives.motor])
            cells, left = cells_of(problem.incidence, count), drives.take(worth)
            spin[worth] = least_spin_inertias(problem, left, cells, spin[worth]).min(axis=1)
            bound[:, worth] = least_masses(found.floor, left, spin[worth])
        found.solve_best(drives, spin, bound)
        for least, values in ((found.spin_inertia, spin), (found.least, bound.min(axis=0))):
            least[tuple(asked.T)] = values.reshape(len(asked), -1).min(axis=1)
    return found
