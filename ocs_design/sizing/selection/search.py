"""Branch and bound over motors, gears and materials; the incidence is solved for.

Every pair of a motor and a gear carries a lower bound on the mass of its lightest device. It starts
as what motor, gear and the smallest wheel weigh, is tightened step by step (`bounds`), and becomes
the mass itself where the fixed point is solved (`fixed_point`), for the most promising candidates
first. A candidate is left out once its bound exceeds the tenth lightest device that is known, and
is none of a motor that may be among the five with the lightest devices: so the ten lightest and the
lightest of the five best motors are found whatever the order.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.sizing.motor_mount import mount_of
from ocs_design.sizing.selection.bounds import (
    RimFloor,
    least_masses,
    least_spin_inertias,
)
from ocs_design.sizing.selection.cells import CELLS, cells_of
from ocs_design.sizing.selection.drive_table import DriveTable, drive_table, known_pairs
from ocs_design.sizing.selection.lot import lot_of
from ocs_design.sizing.selection.outset import Outset, outset_of
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.settling import Settled, refine, settle

RANKED = 10
"""Devices that a selection lists at least."""

MOTORS = 5
"""Motors of which it lists the lightest device: not every motor can be bought."""

_BATCH = 24
# Candidates that are bounded at once before the next are settled.
_AHEAD = 256
_CHUNK = 1024

Indices = NDArray[np.intp]


@dataclass(frozen=True, order=True)
class Rank:
    """One of the lightest devices: its mass [kg], where it is settled, and of which motor."""

    mass: float
    lot: int
    row: int
    motor: int


@dataclass(eq=False)
class Found:
    """What a search knows so far.

    Attributes:
        problem: that is searched. floor: of its rims.
        known: whether a motor behind a gear has all figures, shape (motors, gears).
        least: lower bound of the mass of any device of motor and gear [kg], shape (motors, gears);
            inf: there is none.
        spin_inertia: lower bound of that of its wheels [kg m^2], as far as it was looked for.
        lots: settled candidates. places: of the lightest, lightest first.
    """

    problem: SelectionProblem
    floor: RimFloor
    known: NDArray[np.bool_]
    least: FloatArray
    spin_inertia: FloatArray
    lots: list[Settled] = field(default_factory=list)
    places: list[Rank] = field(default_factory=list)

    @classmethod
    def nothing(cls, problem: SelectionProblem) -> "Found":
        """Before the search."""
        floor = RimFloor.of(problem)
        motors = np.array([motor.mass or 0.0 for motor in problem.motors])
        mounts = np.array([mount_of(motor, None).moments().mass for motor in problem.motors])
        gears = np.array([gear.mass for gear in problem.gears])
        direct = np.array([gear.room is None for gear in problem.gears])
        drives = motors[:, None] + np.where(direct, mounts[:, None], 0.0) + gears
        least = 2.0 * (drives + floor.mass.min(initial=np.inf))
        known = known_pairs(problem.motors, problem.gears)
        least = np.where(known, least, np.inf)
        return cls(problem, floor, known, least, np.zeros(known.shape))

    @property
    def lightest(self) -> float:
        """Mass of the lightest device so far [kg]."""
        return self.places[0].mass if self.places else np.inf

    @property
    def enough(self) -> FloatArray:
        """Mass that a device of each motor must stay below to be listed [kg], shape (motors,)."""
        masses = np.full(len(self.problem.motors), -np.inf)
        best = _best_of_motors(self.places)
        # A motor is listed below the last that is, and then with what is lighter yet.
        masses[:] = best[-1].mass if len(best) >= MOTORS else np.inf
        for rank in best:
            masses[rank.motor] = rank.mass
        tenth = self.places[RANKED - 1].mass if len(self.places) >= RANKED else np.inf
        enough: FloatArray = np.maximum(masses, tenth)
        return enough

    def add(self, settled: Settled) -> None:
        """List what belongs among the lightest."""
        self.lots.append(settled)
        self._list([*self.places, *_ranks(len(self.lots) - 1, settled)])

    def refine(self) -> None:
        """Look more closely at what may be the lightest of all, and list anew."""
        for index, settled in enumerate(self.lots):
            refined = refine(self.problem, settled, self.lightest)
            self.lots[index] = refined
            pair = refined.lot.drives.motor, refined.lot.drives.gear
            np.minimum.at(self.least, pair, refined.mass)
        self._list([rank for index, lot in enumerate(self.lots) for rank in _ranks(index, lot)])

    def _list(self, ranks: Sequence[Rank]) -> None:
        """The lightest of these, and the lightest of each of the best motors."""
        ordered = sorted(ranks)
        self.places = sorted({*ordered[:RANKED], *_best_of_motors(ordered)})


def _ranks(lot: int, settled: Settled) -> Iterator[Rank]:
    for row in np.flatnonzero(settled.mass < np.inf):
        yield Rank(float(settled.mass[row]), lot, int(row), int(settled.lot.drives.motor[row]))


def _best_of_motors(ordered: Sequence[Rank]) -> list[Rank]:
    """The lightest of each of the best motors, lightest first."""
    best: dict[int, Rank] = {}
    for rank in ordered:
        best.setdefault(rank.motor, rank)
    return list(best.values())[:MOTORS]


def search(problem: SelectionProblem) -> Found:
    """The lightest devices, and for every motor and gear how light its lightest is at least."""
    found = Found.nothing(problem)
    for pairs in _chunks(found):
        worth = pairs[found.least[tuple(pairs.T)] < found.enough[pairs[:, 0]]]
        if worth.size:
            _examine(found, worth)
    found.refine()
    return found


def _chunks(found: Found) -> Iterator[Indices]:
    """Pairs of motor and gear, shape (n, 2): every motor once with its lightest gear, then all."""
    least = np.where(found.known, found.least, np.nan)
    order = np.argsort(least, axis=None, kind="stable")
    order = order[: int(found.known.sum())]
    pairs = np.stack(np.unravel_index(order, least.shape), axis=-1)
    _, first = np.unique(pairs[:, 0], return_index=True)
    yield pairs[first]
    rest = np.delete(pairs, first, axis=0)
    for start in range(0, len(rest), _CHUNK):
        yield rest[start : start + _CHUNK]


def _examine(found: Found, pairs: Indices) -> None:
    """Bound these pairs, and settle those that may be listed."""
    problem = found.problem
    drives = drive_table(problem, pairs)
    spin = np.zeros(len(drives))
    bound = np.full((len(problem.materials), len(drives)), -np.inf)
    for count in (1, CELLS, CELLS):
        worth = np.flatnonzero(bound.min(axis=0) < found.enough[drives.motor])
        cells = cells_of(problem.incidence, count)
        some = drives.take(worth)
        needed = least_spin_inertias(problem, found.floor, some, cells, spin[worth])
        spin[worth] = needed.min(axis=1)
        bound[:, worth] = least_masses(found.floor, some, spin[worth])
    found.spin_inertia[drives.motor, drives.gear] = spin
    _settle_best(found, drives, spin, bound)
    found.least[drives.motor, drives.gear] = bound.min(axis=0)


def _settle_best(found: Found, drives: DriveTable, spin: FloatArray, bound: FloatArray) -> None:
    """Settle candidates in the order of their bounds, which become masses in place."""
    material, row = np.nonzero(bound < found.enough[drives.motor])
    lot = lot_of(found.problem, drives.take(row), material)
    nowhere = np.zeros_like(spin[row])
    outset = Outset(spin[row], bound[material, row], nowhere, nowhere)
    left, rough = np.arange(row.size), np.ones(row.size, dtype=np.bool_)
    while True:
        left = left[outset.mass[left] < found.enough[lot.drives.motor[left]]]
        left = left[np.argsort(outset.mass[left], kind="stable")]
        some, ahead = left[:_BATCH], left[:_AHEAD]
        if not some.size:
            break
        if rough[some].any():
            closer = ahead[rough[ahead]]
            rough[closer] = False
            bounds = outset_of(found.problem, lot.take(closer), outset.spin_inertia[closer])
            outset = outset.put(closer, bounds)
            continue
        settled = settle(found.problem, lot.take(some), outset.take(some))
        found.add(settled)
        outset.mass[some] = settled.mass
        left = left[_BATCH:]
    bound[material, row] = outset.mass
