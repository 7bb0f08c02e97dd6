"""What a requirement asks of drives and their wheels, for many at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.drive.spin_root import capability, newton_step
from ocs_design.drive.wheel_pair import WheelPairTask, smallest_spin_inertia, spin_demand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.trunk import TrunkInertia


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
    inertia: FloatArray,
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
    requirement: Requirement, drives: DriveTable, inertia: FloatArray, shares: FloatArray
) -> FloatArray:
    """The spin inertia that everything together needs at the least [kg m^2], shape (n, k).

    Args:
        requirement: maneuvers and rate change.
        drives: n of them.
        inertia: no larger than that about roll and pitch [kg m^2], shape (n, 2).
        shares: no smaller than those of the design, one by one, shape (k, 2).
    """
    free = [maneuver for maneuver in requirement.maneuvers if maneuver.incidence is None]
    height, shape = requirement.standing_height, (len(drives), len(shares), 2)
    shares, whole = np.broadcast_to(shares, shape), np.broadcast_to(inertia[:, None, :], shape)
    needed: FloatArray = np.zeros(shape[:-1])
    if free:
        needed = needed_by_maneuvers(free, height, drives, whole, shares).max(axis=0)
    for maneuver in requirement.maneuvers:
        if maneuver.incidence is not None:
            own = np.broadcast_to(shares_of(np.array([maneuver.incidence])), (len(drives), 1, 2))
            one = needed_by_maneuvers([maneuver], height, drives, whole[:, :1], own)
            needed = np.maximum(needed, one[0])
    if requirement.rate_change is None:
        return needed
    return np.maximum(needed, needed_by_rate(requirement.rate_change, drives, whole, shares))


def needed_by_maneuvers(
    maneuvers: Sequence[Maneuver],
    standing_height: float,
    drives: DriveTable,
    inertia: FloatArray,
    shares: FloatArray,
) -> FloatArray:
    """The smallest spin inertia that does each maneuver in time [kg m^2], shape (m, n, k).

    Inertia [kg m^2] and shares of shape (n, k, 2).
    """
    task = pair_task(maneuvers, standing_height, inertia, shares)
    return smallest_spin_inertia(task, columns(drives.line), drives.armature[:, None])


def pair_task(
    maneuvers: Sequence[Maneuver], standing_height: float, inertia: FloatArray, shares: FloatArray
) -> WheelPairTask:
    """Maneuvers as what two wheels must do, fields of shape (m, n, k, ...).

    Shares (s, c) beyond the unit circle, n (s', c') with n > 1, do the same as (s', c') on what is
    smaller: momenta 1 / n, inertias 1 / n^2 of what they are (`drive.wheel_pair`).

    Args:
        maneuvers: m of them.
        standing_height: of the trunk over the ground [m].
        inertia: about roll and pitch [kg m^2], shape (n, k, 2), or (m, n, k, 2) where each has its
            own.
        shares: see `shares_of`; likewise.
    """
    each = np.broadcast_to(inertia, (len(maneuvers), *shares.shape[-3:]))
    stretch = np.hypot(shares[..., 0], shares[..., 1])[..., None]
    slews = [
        maneuver.slew(own, standing_height) for maneuver, own in zip(maneuvers, each, strict=True)
    ]
    return WheelPairTask(
        swept=np.stack([slew.swept for slew in slews]) / stretch,
        momentum=np.stack([slew.momentum for slew in slews]) / stretch,
        duration=np.array([slew.duration for slew in slews])[:, None, None],
        inertia=inertia / stretch**2,
        incidence=np.arctan2(shares[..., 0], shares[..., 1]),
    )


def needed_by_rate(
    rate_change: float, drives: DriveTable, inertia: FloatArray, shares: FloatArray
) -> FloatArray:
    """By a change of rate about either axis, one at a time, h = I d / (2 share W) [kg m^2].

    At the highest speed; no time is set (docs/theory.md, Lower bound on the wheels' inertia).
    """
    with np.errstate(divide="ignore"):
        wheels = inertia * rate_change / (2.0 * drives.top_speed[:, None, None] * shares)
    needed: FloatArray = wheels.max(axis=-1)
    return needed


def columns(line: DriveLine) -> DriveLine:
    """The same against a second axis, of incidences."""
    values = (line.stall_torque, line.no_load_speed, line.torque_limit, line.speed_max)
    return DriveLine(*(np.asarray(value)[:, None] for value in values))
