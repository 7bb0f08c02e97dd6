"""Lower bounds on the mass of every candidate, without a fixed point.

Each is proved by terms that only grow (docs/theory.md, The selection):

1. A maneuver asks for no less as the inertia grows. With q = h W the momentum of a wheel, h / I_red
   dq/dt is the motor's torque at the speed q / h. More inertia asks for more of q's integral, or
   gives the trunk less way (a larger I_red), or neither; never for less.
2. It asks for no less over a cell of incidences than with the largest sine and the largest cosine
   in it, each by itself: |P_x| / s + |P_y| / c falls and, by their balance, kappa = 2 (s |P_x| /
   I_xx + c |P_y| / I_yy) / (|P_x| / s + |P_y| / c) grows with either share.
3. The inertia of the whole is no less than with the lightest module for less spin inertia: mass,
   rim and distance only add to it (`trunk.least_trunk_inertia`).
4. The lightest module of more spin inertia is no lighter: of a module with the more, take height,
   then wall, then radius away, and every limit still holds.

So a bound on the spin inertia gives one on the mass, that one on the inertia, and that a better one
on the spin inertia; each pass tightens them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.housing import housing_height, housing_outer_radius
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.rim_closed_form import BORE_SHARE, smallest_spin_inertia
from ocs_design.sizing.selection.demand import bound_by_all
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.lot import rim_limits
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import Modules, least_trunk_inertia
from ocs_design.sizing.web import hub_of

CELLS = 18
"""Of the incidence: 5 deg each."""

_RIMS = 96
_OFF_THE_EDGE = 1.0 + 1e-10


@dataclass(frozen=True, eq=False)
class RimFloor:
    """The least mass of rim and housing by spin inertia, for every material.

    Attributes:
        spin_inertia: of the rim [kg m^2], increasing along axis 1, shape (materials, rims).
        mass: of the lightest rim with its housing [kg], never decreasing, inf where there is none.
    """

    spin_inertia: FloatArray
    mass: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem) -> "RimFloor":
        """Of rims that turn slowly: no hoop stress adds to their mass."""
        kinds = np.repeat(np.arange(len(problem.materials)), _RIMS)
        narrow = np.full(kinds.size, _narrowest_hub(problem))
        limits = rim_limits(problem, kinds, np.full(kinds.size, 1e-3), narrow)
        least = smallest_spin_inertia(limits) * _OFF_THE_EDGE
        room = problem.envelope
        disc = np.pi * limits.density * room.height_max * room.outer_radius_max**4 / 2.0
        steps = np.tile(np.linspace(0.0, 1.0, _RIMS), len(problem.materials))
        least = np.maximum(least, 1e-9 * disc)
        inertia = least * np.maximum(disc / least, 1.0) ** steps
        mass = np.nan_to_num(lightest_module(inertia, limits).mass, nan=np.inf)
        shape = (len(problem.materials), _RIMS)
        return cls(inertia.reshape(shape), mass.reshape(shape))

    def at(self, spin_inertia: FloatArray) -> FloatArray:
        """Of no more spin inertia than that, shape (materials, n)."""
        rows = [
            mass[np.maximum(np.searchsorted(grid, spin_inertia, side="right") - 1, 0)]
            for grid, mass in zip(self.spin_inertia, self.mass, strict=True)
        ]
        beyond = spin_inertia > self.spin_inertia[:, -1:]
        return np.where(beyond, np.inf, np.stack(rows))


def _narrowest_hub(problem: SelectionProblem) -> float:
    """Radius that no wheel's hub is below, on whichever motor and gear [m]."""
    if not problem.web:
        return 0.0
    return min(
        hub_of(motor, direct=direct).radius for motor in problem.motors for direct in (True, False)
    )


@dataclass(frozen=True)
class Cell:
    """A range of incidences [rad]; a single one if both are equal."""

    low: float
    high: float

    @property
    def shares(self) -> tuple[float, float]:
        """The largest sine and the largest cosine in it."""
        return float(np.sin(self.high)), float(np.cos(self.low))


def cells_of(incidence: float | None, count: int = CELLS) -> tuple[Cell, ...]:
    """All incidences in `count` equal cells; the one that is stated by itself."""
    if incidence is not None:
        return (Cell(incidence, incidence),)
    edges = np.linspace(0.0, np.pi / 2.0, count + 1)
    return tuple(Cell(float(a), float(b)) for a, b in pairwise(edges))


def least_spin_inertias(
    problem: SelectionProblem,
    floor: RimFloor,
    drives: DriveTable,
    cells: Sequence[Cell],
    below: FloatArray,
) -> FloatArray:
    """A better lower bound of what each drive's wheels need in each cell [kg m^2], shape (n, k).

    Args:
        problem: robot, requirement, envelope, place.
        floor: of its rims.
        drives: n of them. cells: k of them.
        below: a lower bound over all cells, as far as it is known [kg m^2], shape (n,).
    """
    inertia = least_inertia(problem, floor, drives, below)
    shares = np.array([cell.shares for cell in cells])
    needed = np.maximum(bound_by_all(problem.requirement, drives, inertia, shares), below[:, None])
    stated = problem.requirement.spin_inertia
    if stated is None:
        return needed
    return np.where(needed > stated * _OFF_THE_EDGE, np.inf, stated)


def least_inertia(
    problem: SelectionProblem, floor: RimFloor, drives: DriveTable, spin_inertia: FloatArray
) -> FloatArray:
    """Of the robot with modules of at least that spin inertia [kg m^2], shape (n, 2)."""
    room = problem.envelope
    rim = np.maximum(spin_inertia - drives.beside_rim, floor.spin_inertia[:, 0].min())
    mass = drives.mass + np.where(np.isfinite(rim), floor.at(rim).min(axis=0), 0.0)
    radius = max(room.inner_radius_min + room.wall_min, room.wall_min / (1.0 - BORE_SHARE))
    least = Modules(
        mass=np.where(np.isfinite(mass), mass, drives.mass),
        axial_inertia=drives.axial_inertia
        + drives.hub_share
        + np.where(np.isfinite(rim), rim, 0.0),
        # No body of revolution has less across its axis than half of what it has about it.
        transverse_inertia=drives.transverse_inertia + np.where(np.isfinite(rim), rim, 0.0) / 2.0,
        outer_radius=np.full(rim.shape, housing_outer_radius(radius)),
        height=np.full(rim.shape, housing_height(room.height_min)),
    )
    largest = least._replace(
        outer_radius=np.full(rim.shape, housing_outer_radius(room.outer_radius_max)),
        height=np.full(rim.shape, housing_height(room.height_max)),
    )
    return least_trunk_inertia(problem.robot, problem.place, least, largest)


def least_masses(floor: RimFloor, drives: DriveTable, spin_inertia: FloatArray) -> FloatArray:
    """Of whole devices [kg] in every material, shape (materials, n); inf: there is none."""
    rim = spin_inertia - drives.beside_rim
    lightest = np.where(np.isfinite(rim), floor.at(np.where(np.isfinite(rim), rim, 0.0)), np.inf)
    return 2.0 * (drives.mass + lightest)
