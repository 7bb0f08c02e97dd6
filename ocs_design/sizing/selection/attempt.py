"""What drives that cannot do what is required come to with the largest wheel that fits."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.drive.wheel_pair import (
    SlewReason,
    pair_slew_time,
    slew_reason,
    smallest_spin_inertia,
)
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.selection.bounds import RimFloor, least_inertia
from ocs_design.sizing.selection.cells import cells_of
from ocs_design.sizing.selection.demand import column, columns, needed_by_rate, pair_task, shares_of
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.web import web_axial_inertia


class Part(NamedTuple):
    """One part of the requirement, for n drives at k incidences.

    Attributes:
        name: of the maneuver, or "the rate change".
        incidence: at which it is done [rad], shape (k,).
        time: asked for [s]; inf: none is set.
        needed: smallest spin inertia that does it [kg m^2], shape (n, k); inf: none does.
        late: time with the largest wheel over that asked for, shape (n, k), or momentum asked for
            over that of the largest wheel.
        reason: see `SlewReason`, shape (n, k).
    """

    name: str
    incidence: FloatArray
    time: float
    needed: FloatArray
    late: FloatArray
    reason: NDArray[np.int_]


@dataclass(frozen=True, eq=False)
class Attempt:
    """Some drives at some incidences, each with the lightest module that it could have.

    Attributes:
        drives: n of them.
        incidence: k of them [rad].
        largest: spin inertia of the largest wheel that fits [kg m^2], shape (n,).
        weighty: the same if rims might weigh anything.
        parts: of the requirement.
    """

    drives: DriveTable
    incidence: FloatArray
    largest: FloatArray
    weighty: FloatArray
    parts: tuple[Part, ...]

    @property
    def late(self) -> FloatArray:
        """Of the part that is worst, shape (n, k)."""
        late: FloatArray = np.max([part.late for part in self.parts], axis=0)
        return late

    @property
    def needed(self) -> FloatArray:
        """By all parts [kg m^2], shape (n, k)."""
        needed: FloatArray = np.max([part.needed for part in self.parts], axis=0)
        return needed


def attempt(problem: SelectionProblem, floor: RimFloor, drives: DriveTable) -> Attempt:
    """What these drives come to."""
    cells = cells_of(problem.incidence)
    angles = np.array([(cell.low + cell.high) / 2.0 for cell in cells])
    unlimited = replace(problem.envelope, mass_max=np.inf)
    largest = largest_wheel(problem, problem.envelope) + drives.beside_rim
    stated = problem.requirement.spin_inertia
    if stated is not None:
        largest = np.full_like(largest, stated)
    return Attempt(
        drives=drives,
        incidence=angles,
        largest=largest,
        weighty=largest_wheel(problem, unlimited) + drives.beside_rim,
        parts=tuple(_parts(problem, floor, drives, angles, largest)),
    )


def largest_wheel(problem: SelectionProblem, room: Envelope) -> float:
    """Spin inertia of the largest rim of any material, whatever its hoop stress [kg m^2].

    With its web, without its hub and what is cut off it.

    As wide and tall as may be, and as thick as its mass allows; if it must be thicker, lower.
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
        beside = web_axial_inertia(inner) - density * cut
    inertia = np.where(inner >= bore, mass * (outer**2 + inner**2) / 2.0 + beside, 0.0)
    return float(inertia.max(initial=0.0))


def _parts(
    problem: SelectionProblem,
    floor: RimFloor,
    drives: DriveTable,
    angles: FloatArray,
    largest: FloatArray,
) -> Iterator[Part]:
    least = least_inertia(problem, floor, drives, np.zeros(len(drives)))
    inertia = column(least.inertia)
    shape = (len(drives), angles.size)
    for maneuver in problem.requirement.maneuvers:
        at = angles if maneuver.incidence is None else np.full(angles.shape, maneuver.incidence)
        shares = np.broadcast_to(shares_of(at), (*shape, 2))
        height = problem.requirement.standing_height
        yield _maneuver(maneuver, at, height, drives, inertia, shares=shares, largest=largest)
    rate = problem.requirement.rate_change
    if rate is not None:
        shares = np.broadcast_to(shares_of(angles), (*shape, 2))
        needed = needed_by_rate(rate, drives, inertia, shares)
        late = needed / largest[:, None]
        reason = np.where(np.isinf(needed), SlewReason.AXIS, SlewReason.SPEED)
        yield Part("the rate change", angles, np.inf, needed, late, reason)


def _maneuver(
    maneuver: Maneuver,
    incidence: FloatArray,
    standing_height: float,
    drives: DriveTable,
    inertia: TiltInertia,
    *,
    shares: FloatArray,
    largest: FloatArray,
) -> Part:
    task = pair_task([maneuver], standing_height, inertia, shares)
    line, armature = columns(drives.line), drives.armature[:, None]
    time = float(np.asarray(task.duration).item())
    needed = smallest_spin_inertia(task, line, armature)[0]
    taken = pair_slew_time(task, largest[:, None], line, armature)[0]
    late = np.divide(taken, time, out=np.full(taken.shape, np.inf), where=time > 0.0)
    return Part(maneuver.name, incidence, time, needed, late, slew_reason(task, line)[0])
