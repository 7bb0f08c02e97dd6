"""What a requirement asks of drives and their wheels, for many at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.drive.spin_root import capability, newton_step
from ocs_design.drive.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.drive.wheel_pair import (
    WheelPairBound,
    WheelPairTask,
    smallest_spin_inertia,
    spin_demand,
)
from ocs_design.requirement.bound import rate_momenta
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.selection.cells import Cell
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.trunk import LeastInertia, TrunkInertia


class Reach(NamedTuple):
    """What wheels of some spin inertia come to, by each part of the requirement.

    Attributes:
        margin: what they do over what is asked for; at least 1 if they are in time.
        following: a better guess at the smallest spin inertia that is [kg m^2]: from below no
            larger than it; inf: there is none.
    """

    margin: FloatArray
    following: FloatArray


def shares_of(incidence: FloatArray) -> FloatArray:
    """Shares of a wheel's momentum on roll and on pitch, sin and cos, shape (..., 2)."""
    return np.stack([np.sin(incidence), np.cos(incidence)], axis=-1)


def reach(
    requirement: Requirement,
    drives: DriveTable,
    trunk: TrunkInertia,
    spin_inertia: FloatArray,
    angle: FloatArray,
) -> tuple[Reach, Reach]:
    """What wheels come to in the worst part that is done at the design's incidence, shape (n, k).

    And in the worst maneuver that has an incidence of its own, shape (n, 1). Where there is no such
    part, the margin is infinite and nothing is asked for.

    Args:
        requirement: maneuvers and rate change.
        drives: n of them, each on its own `trunk`.
        spin_inertia: of their wheels [kg m^2], shape (n,).
        angle: incidences of the design [rad], shape (n, k).
    """
    by_design, turned = _parts(requirement, drives, trunk, spin_inertia, angle)
    return _worst(by_design, angle.shape), _worst(turned, (len(drives), 1))


def margins(
    requirement: Requirement,
    drives: DriveTable,
    trunk: TrunkInertia,
    spin_inertia: FloatArray,
    angle: FloatArray,
) -> FloatArray:
    """Of each part of the requirement, see `Reach`, shape (n, parts); one incidence per drive.

    Args:
        requirement: maneuvers and rate change.
        drives: n of them, each on its own `trunk`.
        spin_inertia: of their wheels [kg m^2], shape (n,).
        angle: incidence of the design [rad], shape (n,).
    """
    by_design, turned = _parts(requirement, drives, trunk, spin_inertia, angle[:, None])
    return np.column_stack([part.margin for part in (*by_design, *turned)])


def _parts(
    requirement: Requirement,
    drives: DriveTable,
    trunk: TrunkInertia,
    spin_inertia: FloatArray,
    angle: FloatArray,
) -> tuple[list[Reach], list[Reach]]:
    """Those that are done at the design's incidence, (n, k), and those at their own, (n, 1)."""
    shares, spin = shares_of(angle), spin_inertia[:, None]
    inertia = trunk.at(shares)
    free = [maneuver for maneuver in requirement.maneuvers if maneuver.incidence is None]
    height = requirement.standing_height
    by_design = _tried(free, height, drives, spin_inertia=spin, inertia=inertia, shares=shares)
    if requirement.rate_change is not None:
        needed = needed_by_rate(requirement.rate_change, drives, inertia, shares)
        by_design.append(Reach(spin / needed, needed))
    turned: list[Reach] = []
    for maneuver in requirement.maneuvers:
        if maneuver.incidence is not None:
            own = shares_of(np.full((len(drives), 1), maneuver.incidence))
            turned += _tried(
                [maneuver], height, drives, spin_inertia=spin, inertia=trunk.at(own), shares=own
            )
    return by_design, turned


def _tried(
    maneuvers: Sequence[Maneuver],
    standing_height: float,
    drives: DriveTable,
    *,
    spin_inertia: FloatArray,
    inertia: TiltInertia,
    shares: FloatArray,
) -> list[Reach]:
    """Of each maneuver, shape (n, k)."""
    if not maneuvers:
        return []
    task = pair_task(maneuvers, standing_height, inertia, shares)
    demand = spin_demand(task, columns(drives.line), drives.armature[:, None])
    can = capability(demand, spin_inertia)
    following = newton_step(demand, spin_inertia, can)
    with np.errstate(divide="ignore"):
        margin = can.sweep / demand.sweep
    return [Reach(*both) for both in zip(margin, following, strict=True)]


def _worst(parts: Sequence[Reach], shape: tuple[int, ...]) -> Reach:
    """The least margin and the most that is asked for."""
    worst = Reach(np.full(shape, np.inf), np.zeros(shape))
    for part in parts:
        margin = np.minimum(worst.margin, part.margin)
        worst = Reach(margin, np.maximum(worst.following, part.following))
    return worst


def bound_by_all(
    requirement: Requirement, drives: DriveTable, least: LeastInertia, cells: Sequence[Cell]
) -> FloatArray:
    """The spin inertia that everything together needs at the least [kg m^2], shape (n, k).

    Args:
        requirement: maneuvers and rate change.
        drives: n of them. least: what they turn.
        cells: of the design's incidence, k of them.
    """
    line, armature = columns(drives.line), drives.armature[:, None]
    height, needed = requirement.standing_height, np.zeros((len(drives), len(cells)))
    for maneuver in requirement.maneuvers:
        own = maneuver.incidence
        task = bound_task(maneuver, height, least, cells if own is None else [Cell(own, own)])
        needed = np.maximum(needed, smallest_spin_inertia(task, line, armature))
    if requirement.rate_change is None:
        return needed
    shares = np.array([cell.shares for cell in cells])
    alone = column(TiltInertia.uncoupled(least.inertia.diagonal))
    return np.maximum(needed, needed_by_rate(requirement.rate_change, drives, alone, shares))


def pair_task(
    maneuvers: Sequence[Maneuver], standing_height: float, inertia: TiltInertia, shares: FloatArray
) -> WheelPairTask:
    """Maneuvers as what two wheels must do, fields of shape (m, n, k, ...).

    Args:
        maneuvers: m of them.
        standing_height: of the trunk over the ground [m].
        inertia: of what they turn, shapes that broadcast against (n, k, 2) and (n, k).
        shares: see `shares_of`; (n, k, 2).
    """
    inertia = inertia.times(shares.shape[:-1])
    each = [inertia.within_reach(shares, maneuver.stray) for maneuver in maneuvers]
    slews = [
        maneuver.slew(own, standing_height) for maneuver, own in zip(maneuvers, each, strict=True)
    ]
    return WheelPairTask(
        swept=np.stack([slew.swept for slew in slews]),
        momentum=np.stack([slew.momentum for slew in slews]),
        duration=np.array([slew.duration for slew in slews])[:, None, None],
        inertia=TiltInertia(*(np.stack(parts) for parts in zip(*each, strict=True))),
        incidence=np.arctan2(shares[..., 0], shares[..., 1]),
    )


def bound_task(
    maneuver: Maneuver, standing_height: float, least: LeastInertia, cells: Sequence[Cell]
) -> WheelPairBound:
    """A maneuver as what two wheels must do at the least, fields of shape (n, k, ...).

    Shares (s, c) beyond the unit circle, n (s', c') with n > 1, do the same as (s', c') on what is
    smaller: momenta 1 / n, inertias 1 / n^2 of what they are (`drive.wheel_pair`).

    Args:
        maneuver: to be done.
        standing_height: of the trunk over the ground [m].
        least: what they turn, n of them.
        cells: of the incidence, k of them.
    """
    shares = np.array([cell.shares for cell in cells])
    stretch = np.hypot(shares[:, 0], shares[:, 1])
    diagonal, product = column(least.inertia)
    slew = maneuver.slew(TiltInertia.uncoupled(diagonal), standing_height)
    return WheelPairBound(
        swept=slew.swept / stretch[:, None],
        momentum=slew.momentum / stretch[:, None],
        duration=slew.duration,
        inertia=TiltInertia(diagonal / stretch[:, None] ** 2, product / stretch**2),
        incidence=np.arctan2(shares[:, 0], shares[:, 1]),
        turn=maneuver.turn * stretch[:, None],
        spread=least.spread[:, None] / stretch**2,
        reached=np.array([cell.least_shares for cell in cells]) > OUT_OF_REACH,
    )


def needed_by_rate(
    rate_change: float, drives: DriveTable, inertia: TiltInertia, shares: FloatArray
) -> FloatArray:
    """By a change of rate about either axis, one at a time [kg m^2], shape (n, k).

    h = d (|J_xi| / s + |J_yi| / c) / (2 W) at the highest speed; no time is set
    (docs/theory.md, Lower bound on the wheels' inertia).
    """
    held = held_by_rate(rate_change, inertia, shares).max(axis=-1)
    needed: FloatArray = held / drives.top_speed[:, None]
    return needed


def held_by_rate(rate_change: float, inertia: TiltInertia, shares: FloatArray) -> FloatArray:
    """Momentum of the busier wheel for a change of the rate of roll, and of pitch, (..., 2)."""
    momenta = rate_momenta(inertia, rate_change)
    asked, levers = np.broadcast_arrays(momenta, 2.0 * shares[..., None, :])
    held = np.divide(asked, levers, out=np.full(asked.shape, np.inf), where=levers > 0.0)
    return np.asarray(np.where(asked == 0.0, 0.0, held).sum(axis=-1))


def column(inertia: TiltInertia) -> TiltInertia:
    """Of n trunks against a second axis, of incidences."""
    return TiltInertia(inertia.diagonal[:, None, :], inertia.product[:, None])


def columns(line: DriveLine) -> DriveLine:
    """The same against a second axis, of incidences."""
    values = (line.stall_torque, line.no_load_speed, line.torque_limit, line.speed_max)
    return DriveLine(*(np.asarray(value)[:, None] for value in values))
