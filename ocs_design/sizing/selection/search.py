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
    INTERVALS,
    PairBounds,
    incidence_intervals,
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

_SOLVED_AT_ONCE, _BOUNDED_AT_ONCE, _PAIRS_AT_ONCE = 24, 256, 1024
"""Numbers of candidates that are solved and bounded together, and of pairs searched together."""

_NEARLY_FEASIBLE = 0.998
"""Margin above which a candidate that is infeasible where it was solved may be feasible nearby."""

_REFINEMENT_GAIN, _REFINEMENT_GAIN_AT_ANGLE = 0.03, 0.003
"""Largest fraction of the mass that a refinement may save, and the same at a specified incidence,
where it saved at most 1e-4 on the robots tried."""


@dataclass(frozen=True)
class RankEntry:
    """Mass [kg] of one of the lightest devices, batch and row where it is stored, and its parts.

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
class SearchState(PairBounds):
    """State of a search: bounds, solved candidates and the ranking so far.

    Attributes:
        mass_max: mass above which devices are of no interest [kg].
        ranked: whether the next lightest are searched for too.
        batches: solved candidates. ranking: entries of the lightest devices, lightest first.
    """

    mass_max: float = np.inf
    ranked: bool = True
    batches: list[Solved] = field(default_factory=list)
    ranking: list[RankEntry] = field(default_factory=list)

    @property
    def lightest(self) -> float:
        """Mass of the lightest device so far [kg]; inf: none."""
        return self.ranking[0].mass if self.ranking else np.inf

    @property
    def listed_below(self) -> FloatArray:
        """Mass below which a device of each motor enters the ranking [kg], shape (motors,)."""
        if not self.ranked:
            return np.full(len(self.problem.motors), min(self.lightest, self.mass_max))
        best = _best_of_motors(self.ranking)
        # A new motor must be lighter than the last one listed; a listed one must improve on itself.
        last_listed = best[-1].mass if len(best) >= MOTORS else np.inf
        masses = np.full(len(self.problem.motors), last_listed)
        for entry in best:
            masses[entry.motor] = entry.mass
        last_ranked = self.ranking[RANKED - 1].mass if len(self.ranking) >= RANKED else np.inf
        listed_below: FloatArray = np.maximum(masses, last_ranked)
        return listed_below

    @property
    def devices(self) -> list[Solved]:
        """The lightest devices, in order of mass, one row each."""
        return [self.batches[entry.batch].take(np.array([entry.row])) for entry in self.ranking]

    def add(self, solved: Solved) -> None:
        """Add solved candidates, and rank those that belong among the lightest."""
        self.batches.append(solved)
        self._update_ranking([*self.ranking, *_entries(len(self.batches) - 1, solved)])

    def solve_best(self, drives: Drives, spin: FloatArray, bound: FloatArray) -> None:
        """Solve candidates in the order of their bounds, which become masses in place."""
        material, row = np.nonzero(bound < self.listed_below[drives.motor])
        candidates = Candidates(self.problem, drives.take(row), material)
        zeros = np.zeros_like(spin[row])
        guess = Guess(spin[row], bound[material, row], zeros, zeros)
        open_rows, unbounded = np.arange(row.size), np.ones(row.size, dtype=np.bool_)
        while True:
            open_rows = open_rows[
                guess.mass[open_rows] < self.listed_below[candidates.drives.motor[open_rows]]
            ]
            open_rows = open_rows[np.argsort(guess.mass[open_rows], kind="stable")]
            batch, to_bound = open_rows[:_SOLVED_AT_ONCE], open_rows[:_BOUNDED_AT_ONCE]
            if not batch.size:
                break
            if unbounded[batch].any():
                rows = to_bound[unbounded[to_bound]]
                unbounded[rows] = False
                bounds = initial_guess(candidates.take(rows), guess.spin_inertia[rows])
                guess = guess.put(rows, bounds)
                continue
            *_, solved = solve_stepwise(candidates.take(batch), guess.take(batch))
            self.add(solved)
            guess.mass[batch] = solved.mass
            open_rows = open_rows[_SOLVED_AT_ONCE:]
        bound[material, row] = guess.mass

    def refine(self, refine_one: Callable[[Candidates, FixedPoint], FixedPoint]) -> None:
        """Refine candidates that may be the lightest of all, or may be feasible and lighter.

        `refine_one`: finds the lightest device of one candidate near a point (`refinement.refine`).
        """
        gain = _REFINEMENT_GAIN if self.problem.incidence is None else _REFINEMENT_GAIN_AT_ANGLE
        for index, batch in enumerate(self.batches):
            promising = batch.mass < (1.0 + gain) * self.lightest
            nearly_feasible = ~batch.point.feasible & (batch.point.margin > _NEARLY_FEASIBLE)
            for row in np.flatnonzero(
                (promising | nearly_feasible) & (batch.guess.mass < self.lightest)
            ):
                rows = np.array([row])
                entry = batch.take(rows)
                point = refine_one(entry.candidates, entry.point)
                refined = replace(entry, point=replace(point, iterations=entry.point.iterations))
                if refined.mass[0] < entry.mass[0]:
                    self.batches[index] = self.batches[index].put(rows, refined)
                    pair = entry.candidates.drives.motor, entry.candidates.drives.gear
                    np.minimum.at(self.least, pair, refined.mass)
        self._update_ranking(
            [rank for i, batch in enumerate(self.batches) for rank in _entries(i, batch)]
        )

    def _update_ranking(self, entries: Sequence[RankEntry]) -> None:
        """Rank the lightest of these, and the lightest of each of the best motors."""
        best_of_parts: dict[tuple[int, int, int], RankEntry] = {}
        for entry in _ordered(entries):
            best_of_parts.setdefault(entry.parts, entry)
        ordered = list(best_of_parts.values())
        self.ranking = _ordered({*ordered[:RANKED], *_best_of_motors(ordered)})


def _entries(batch: int, solved: Solved) -> Iterator[RankEntry]:
    candidates, mass = solved.candidates, solved.mass
    drives = candidates.drives
    parts = np.stack([drives.motor, drives.gear, candidates.material], axis=1).tolist()
    widest = np.broadcast_to(candidates.limits.outer_radius_max, mass.shape)
    for row in np.flatnonzero(solved.point.feasible).tolist():
        motor, gear, material = parts[row]
        strength = candidates.problem.materials[material].yield_strength or 0.0
        yield RankEntry(
            float(mass[row]), batch, row, (motor, gear, material), float(widest[row]), strength
        )


def _ordered(entries: Iterable[RankEntry]) -> list[RankEntry]:
    """The lightest first; among equally heavy ones the safest, as in `devices_by_mass`."""

    def preference(entry: RankEntry) -> tuple[float, float, tuple[int, int, int], float, int, int]:
        return -entry.widest, -entry.strength, entry.parts, entry.mass, entry.batch, entry.row

    return lightest_first(entries, lambda entry: entry.mass, preference)


def _best_of_motors(ordered: Sequence[RankEntry]) -> list[RankEntry]:
    """The lightest of each of the best motors, lightest first."""
    best: dict[int, RankEntry] = {}
    for entry in ordered:
        best.setdefault(entry.motor, entry)
    return list(best.values())[:MOTORS]


def search(
    problem: SelectionProblem, mass_max: float = np.inf, *, ranked: bool = True
) -> SearchState:
    """The lightest devices, and a lower bound of the mass for every motor with every gear.

    Every motor with every gear is examined whose bound may put it in the list. None is refined yet
    (`SearchState.refine`): at a specified incidence the result is the lightest to within 0.1 % of
    its mass.

    Args:
        mass_max: only lighter devices need to be found [kg].
        ranked: False: only the lightest is searched for.
    """
    state = SearchState.of(problem)
    state.mass_max, state.ranked = mass_max, ranked
    least = np.where(state.known, state.least, np.nan)
    order = np.argsort(least, axis=None, kind="stable")[: int(state.known.sum())]
    pairs = np.stack(np.unravel_index(order, least.shape), axis=-1)
    # Every motor once with its lightest gear, then all.
    _, first = np.unique(pairs[:, 0], return_index=True)
    others = np.delete(pairs, first, axis=0)
    chunks = (
        others[start : start + _PAIRS_AT_ONCE] for start in range(0, len(others), _PAIRS_AT_ONCE)
    )
    webs = np.arange(len(problem.lightenings))
    for chunk in (pairs[first], *chunks):
        # Bound the pairs that may be ranked, then solve those that still may be.
        pairs_left = chunk[state.least[tuple(chunk.T)] < state.listed_below[chunk[:, 0]]]
        if not pairs_left.size:
            continue
        drives = drives_of(
            problem, np.repeat(pairs_left, webs.size, axis=0), np.tile(webs, len(pairs_left))
        )
        spin_inertia = np.zeros(len(drives))
        bound = np.full((len(problem.materials), len(drives)), -np.inf)
        for count in (1, INTERVALS):
            rows = np.flatnonzero(bound.min(axis=0) < state.listed_below[drives.motor])
            intervals, drives_left = (
                incidence_intervals(problem.incidence, count),
                drives.take(rows),
            )
            spin_inertia[rows] = least_spin_inertias(
                problem, drives_left, intervals, spin_inertia[rows]
            ).min(axis=1)
            bound[:, rows] = least_masses(state.floor, drives_left, spin_inertia[rows])
        state.solve_best(drives, spin_inertia, bound)
        for least, values in ((state.spin_inertia, spin_inertia), (state.least, bound.min(axis=0))):
            least[tuple(pairs_left.T)] = values.reshape(len(pairs_left), -1).min(axis=1)
    return state
