"""What a requirement asks of drives and their wheels, for many at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.spin_root import capability, newton_step
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_pair import WheelPairTask, spin_demand
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.bound import rate_momenta
from ocs_design.requirement.maneuver import Maneuver, Requirement
from ocs_design.sizing.selection.candidates import Drives
from ocs_design.sizing.selection.composite_inertia import CompositeInertia


class Margins(NamedTuple):
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


def margins_of(
    requirement: Requirement,
    drives: Drives,
    whole: CompositeInertia,
    spin_inertia: FloatArray,
    angle: FloatArray,
) -> tuple[list[Margins], list[Margins]]:
    """What wheels come to in each part of the requirement.

    Args:
        requirement: maneuvers and rate change.
        drives: n of them, each as part of its own `whole`.
        spin_inertia: of their wheels [kg m^2], shape (n,).
        angle: incidences of the design [rad], shape (n, k).

    Returns:
        Parts that are done at the design's incidence, shape (n, k), and those that are done at an
        incidence of their own, shape (n, 1).
    """
    shares, spin = shares_of(angle), spin_inertia[:, None]
    inertia = whole.at(shares)
    free = [maneuver for maneuver in requirement.maneuvers if maneuver.incidence is None]
    by_design = _tried(
        free,
        requirement,
        drives,
        spin_inertia=spin,
        inertia=inertia,
        shares=shares,
        begun=requirement.free and bool(requirement.reserves),
    )
    if requirement.rate_change is not None:
        needed = needed_by_rate(requirement.rate_change, drives, inertia, shares)
        by_design.append(Margins(spin / needed, needed))
    turned: list[Margins] = []
    for maneuver in requirement.maneuvers:
        if maneuver.incidence is not None:
            own = shares_of(np.full((len(drives), 1), maneuver.incidence))
            turned += _tried(
                [maneuver],
                requirement,
                drives,
                spin_inertia=spin,
                inertia=whole.at(own),
                shares=own,
                begun=bool(requirement.reserves),
            )
    return by_design, turned


def worst(parts: Sequence[Margins], shape: tuple[int, ...]) -> Margins:
    """Least margin and most that is asked for; infinite and none where there is no part."""
    margin, following = np.full(shape, np.inf), np.zeros(shape)
    for part in parts:
        margin = np.minimum(margin, part.margin)
        following = np.maximum(following, part.following)
    return Margins(margin, following)


def _tried(
    maneuvers: Sequence[Maneuver],
    requirement: Requirement,
    drives: Drives,
    *,
    spin_inertia: FloatArray,
    inertia: TiltInertia,
    shares: FloatArray,
    begun: bool,
) -> list[Margins]:
    """Margins of each maneuver, and of each that begins with a rate if any shall, shape (n, k)."""
    if not maneuvers:
        return []
    tasks = [
        pair_task(maneuvers, requirement, inertia, shares, begun=each)
        for each in ((False, True) if begun else (False,))
    ]
    found: list[Margins] = []
    for task in tasks:
        demand = spin_demand(task, columns(drives.line), drives.armature[:, None])
        can = capability(demand, spin_inertia)
        following = newton_step(demand, spin_inertia, can)
        with np.errstate(divide="ignore"):
            margin = can.sweep / demand.sweep
        found += [Margins(*both) for both in zip(margin, following, strict=True)]
    return found


def pair_task(
    maneuvers: Sequence[Maneuver],
    requirement: Requirement,
    inertia: TiltInertia,
    shares: FloatArray,
    *,
    begun: bool = False,
) -> WheelPairTask:
    """Maneuvers as what two wheels must do, fields of shape (m, n, k, ...).

    Args:
        maneuvers: m of them.
        requirement: that they are part of.
        inertia: of what they turn, shapes that broadcast against (n, k, 2) and (n, k).
        shares: see `shares_of`; (n, k, 2).
        begun: see `Requirement.slew`.
    """
    inertia = inertia.times(shares.shape[:-1])
    each = [inertia.within_reach(shares, maneuver.stray) for maneuver in maneuvers]
    slews = [
        requirement.slew(maneuver, own, begun=begun)
        for maneuver, own in zip(maneuvers, each, strict=True)
    ]
    return WheelPairTask(
        swept=np.stack([slew.swept for slew in slews]),
        momentum=np.stack([slew.momentum for slew in slews]),
        duration=np.array([slew.duration for slew in slews])[:, None, None],
        inertia=TiltInertia(*(np.stack(parts) for parts in zip(*each, strict=True))),
        incidence=np.arctan2(shares[..., 0], shares[..., 1]),
    )


def needed_by_rate(
    rate_change: float, drives: Drives, inertia: TiltInertia, shares: FloatArray
) -> FloatArray:
    """Spin inertia for a change of rate about either axis, one at a time [kg m^2], shape (n, k).

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
    """Inertia of n trunks against a second axis, of incidences."""
    return TiltInertia(inertia.diagonal[:, None, :], inertia.product[:, None])


def columns(line: DriveLine) -> DriveLine:
    """Lines of n drives against a second axis, of incidences."""
    return DriveLine(*(np.asarray(value)[:, None] for value in vars(line).values()))
