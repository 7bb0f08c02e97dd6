"""Lower bounds on the mass of every candidate, without a fixed point.

Each is proved by terms that only grow (docs/theory.md, The selection):

1. A maneuver asks for no less as the inertia grows. With q = h W the momentum of a wheel, h / I_red
   dq/dt is the motor's torque at the speed q / h. More inertia asks for more of q's integral, or
   gives the trunk less way (a larger I_red), or neither; never for less.
2. It asks for no less over a cell of incidences than with the largest sine and the largest cosine
   in it, each by itself: |P_x| / s + |P_y| / c falls and, by their balance, kappa = 2 (s |P_x| /
   I_xx + c |P_y| / I_yy) / (|P_x| / s + |P_y| / c) grows with either share. Where roll and pitch
   are coupled, each of |P_x|, |P_y| and kappa is at its own best (`drive.wheel_pair`).
3. The inertia of the whole is no less than with the lightest wheel in a plain drum for less spin
   inertia, and its motor behind it: mass, rim and distance only add to it
   (`trunk.least_trunk_inertia`).
4. The lightest module of more spin inertia is no lighter: of a module with the more, take height,
   then wall, then radius away, and every limit still holds. Housing and foot grow with both.

So a bound on the spin inertia gives one on the mass, that one on the inertia, and that a better one
on the spin inertia; each pass tightens them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.requirement.envelope import Envelope
from ocs_design.sizing.foot import PLATE_THICKNESS
from ocs_design.sizing.housing import PlainDrum, half_height
from ocs_design.sizing.lightest_module import lightest_module
from ocs_design.sizing.motor_mount import mount_of
from ocs_design.sizing.placement import module_size
from ocs_design.sizing.rim_closed_form import BORE_SHARE, smallest_spin_inertia
from ocs_design.sizing.selection.cells import Cell
from ocs_design.sizing.selection.demand import bound_by_all
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.lot import rim_limits
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import Least, LeastInertia, least_trunk_inertia
from ocs_design.sizing.shell import Printed
from ocs_design.sizing.web import WEB_DENSITY, WEB_THICKNESS, hub_of

_RIMS = 96
_OFF_THE_EDGE = 1.0 + 1e-10


@dataclass(frozen=True, eq=False)
class RimFloor:
    """The least mass of a rim with what stands around it by spin inertia, for every material.

    Attributes:
        spin_inertia: of the rim [kg m^2], increasing along axis 1, shape (materials, rims).
        mass: of the lightest rim with its housing and foot [kg], never decreasing, inf where there
            is none.
        about_center: likewise, with a plain drum alone, which stands about the wheel's centre.
    """

    spin_inertia: FloatArray
    mass: FloatArray
    about_center: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem) -> "RimFloor":
        """Of rims that turn slowly: no hoop stress adds to their mass."""
        kinds = np.repeat(np.arange(len(problem.materials)), _RIMS)
        narrow, least_reach = _narrowest_hub(problem), _narrowest_mount(problem)
        limits = rim_limits(
            problem,
            kinds,
            np.full(kinds.size, 1e-3),
            np.full(kinds.size, narrow),
            np.full(kinds.size, least_reach),
        )
        least = smallest_spin_inertia(limits) * _OFF_THE_EDGE
        room = problem.envelope
        disc = np.pi * limits.density * room.height_max * room.outer_radius_max**4 / 2.0
        steps = np.tile(np.linspace(0.0, 1.0, _RIMS), len(problem.materials))
        least = np.maximum(least, 1e-9 * disc)
        inertia = least * np.maximum(disc / least, 1.0) ** steps
        shape = (len(problem.materials), _RIMS)
        masses = (
            np.nan_to_num(lightest_module(inertia, limits, shell).mass, nan=np.inf).reshape(shape)
            for shell in (Printed(least_reach), PlainDrum())
        )
        return cls(inertia.reshape(shape), *masses)

    def at(self, spin_inertia: FloatArray) -> FloatArray:
        """Mass of no more spin inertia than that, shape (materials, n)."""
        return self._looked_up(self.mass, spin_inertia)

    def about_center_at(self, spin_inertia: FloatArray) -> FloatArray:
        """Likewise, of what stands about the wheel's centre."""
        return self._looked_up(self.about_center, spin_inertia)

    def _looked_up(self, masses: FloatArray, spin_inertia: FloatArray) -> FloatArray:
        rows = [
            mass[np.maximum(np.searchsorted(grid, spin_inertia, side="right") - 1, 0)]
            for grid, mass in zip(self.spin_inertia, masses, strict=True)
        ]
        beyond = spin_inertia > self.spin_inertia[:, -1:]
        return np.where(beyond, np.inf, np.stack(rows))


def _narrowest_hub(problem: SelectionProblem) -> float:
    """Radius that no wheel's hub is below, on whichever motor and gear [m]."""
    if not problem.web:
        return 0.0
    direct = (
        max(hub_of(motor).radius, mount_of(motor, None).head_reach) for motor in problem.motors
    )
    return min(*direct, *(hub_of(motor, direct=False).radius for motor in problem.motors))


def _narrowest_mount(problem: SelectionProblem) -> float:
    """Reach that the holes of no motor's mount are below [m]."""
    if any(gear.room is not None for gear in problem.gears):
        return 0.0
    return min(mount_of(motor, None).holes.reach for motor in problem.motors)


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
    return needed_in_cells(
        problem, drives, least_inertia(problem, floor, drives, below), cells, below
    )


def needed_in_cells(
    problem: SelectionProblem,
    drives: DriveTable,
    inertia: LeastInertia,
    cells: Sequence[Cell],
    below: FloatArray,
) -> FloatArray:
    """What each drive's wheels need in each cell on a trunk of at least that inertia, shape (n, k).

    Args:
        problem: requirement. drives: n of them.
        inertia: of each.
        cells: k of them. below: as for `least_spin_inertias`.
    """
    needed = np.maximum(bound_by_all(problem.requirement, drives, inertia, cells), below[:, None])
    stated = problem.requirement.spin_inertia
    if stated is None:
        return needed
    return np.where(needed > stated * _OFF_THE_EDGE, np.inf, stated)


def least_inertia(
    problem: SelectionProblem, floor: RimFloor, drives: DriveTable, spin_inertia: FloatArray
) -> LeastInertia:
    """Of the robot with modules of at least that spin inertia, see `least_trunk_inertia`."""
    rim = np.maximum(spin_inertia - drives.beside_rim, floor.spin_inertia[:, 0].min())
    known = np.isfinite(rim)
    about_center = np.where(known, floor.about_center_at(rim).min(axis=0), 0.0)
    about_center = np.where(np.isfinite(about_center), about_center, 0.0)
    radius = np.full_like(rim, _smallest_radius(problem.envelope))
    return least_inertia_around(problem, drives, np.where(known, rim, 0.0), radius, about_center)


def least_inertia_of_any(problem: SelectionProblem, drives: DriveTable) -> LeastInertia:
    """Likewise, of modules with any wheel."""
    nothing = np.zeros(len(drives))
    radius = np.full(len(drives), _smallest_radius(problem.envelope))
    return least_inertia_around(problem, drives, nothing, radius, nothing)


def _smallest_radius(room: Envelope) -> float:
    """That no rim is below [m]."""
    return max(room.inner_radius_min + room.wall_min, room.wall_min / (1.0 - BORE_SHARE))


def least_inertia_around(
    problem: SelectionProblem,
    drives: DriveTable,
    rim: FloatArray,
    radius: FloatArray,
    about_center: FloatArray,
) -> LeastInertia:
    """Of the robot with modules whose rims have no less, see `least_trunk_inertia`.

    Args:
        problem: robot, envelope, place. drives: n of them.
        rim: spin inertia of rim and web [kg m^2]. radius: of the rim [m].
        about_center: mass of rim, web and drum [kg].
    """
    room, zero = problem.envelope, np.zeros_like(rim)
    motor = drives.behind_depth, drives.behind_radius, drives.mount_reach
    behind = drives.behind.mass + drives.mount_mass
    # The holes stand by less than that behind the floor.
    holes = drives.mount_mass * PLATE_THICKNESS
    least = Least(
        mass=np.maximum(about_center + drives.hub_mass - drives.mount_mass, 0.0),
        # No body of revolution has less across its axis than half of what it has about it.
        inertia=np.minimum(drives.hub_share, drives.hub_across) + rim / 2.0,
        behind=behind,
        depth=half_height(room.height_max) + (holes - drives.behind.y) / behind,
        above=(drives.behind.z + zero) / behind,
        smallest=module_size(radius, zero + room.height_min, *motor),
        largest=module_size(zero + room.outer_radius_max, zero + room.height_max, *motor),
        heaviest=_heaviest(problem, drives),
    )
    return least_trunk_inertia(problem.robot, problem.place, least)


def _heaviest(problem: SelectionProblem, drives: DriveTable) -> FloatArray:
    """That no module is beyond: as wide, as high and as dense as may be [kg], shape (n,)."""
    room, density = problem.envelope, max(material.density for material in problem.materials)
    radius, height = np.full(len(drives), room.outer_radius_max), room.height_max
    rim = np.minimum(room.mass_max, np.pi * density * radius**2 * height)
    web = np.pi * WEB_THICKNESS * WEB_DENSITY * radius**2
    shell = Printed(drives.mount_reach).mass(radius, np.full_like(radius, height))
    return np.asarray(drives.mass + rim + web + shell)


def least_masses(floor: RimFloor, drives: DriveTable, spin_inertia: FloatArray) -> FloatArray:
    """Of whole devices [kg] in every material, shape (materials, n); inf: there is none."""
    rim = spin_inertia - drives.beside_rim
    lightest = np.where(np.isfinite(rim), floor.at(np.where(np.isfinite(rim), rim, 0.0)), np.inf)
    return 2.0 * (drives.mass + lightest)
