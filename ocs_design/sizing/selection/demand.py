"""Demand of a requirement on wheels and their drives, for many candidates at once."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.spin_root import capability, newton_step
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, gauge, spin_demand, without_each
from ocs_design.common.arrays import FloatArray
from ocs_design.device.records.selection import TaskDemand
from ocs_design.requirement.bound import AXES, rate_momenta, roll_momentum_per_rate
from ocs_design.requirement.maneuver import Maneuver, Slew
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.selection.composite_inertia import CompositeInertia
from ocs_design.sizing.selection.drives import Drives
from ocs_design.sizing.selection.problem import Candidate

ROLL_CANCELLED = 0.35
"""Fraction of all wheels' roll momentum at top speed that can cancel a roll at lift-off while they
turn a flip. In simulation (docs/theory.md, A roll at lift-off): robots fail above 0.36 with
Solo12's lightest device, 0.40 and 0.45 with Romeo's of two and four wheels, 0.47 with TALOS's of
four."""


HEADINGS = 5
"""Number of headings at which the momentum of a trunk that yaws is evaluated: between two that are
0.35 rad apart it is at most 1.5 % larger."""


class Margins(NamedTuple):
    """Margin of wheels of some spin inertia in one part of the requirement.

    Attributes:
        margin: capability relative to the demand; at least 1 if they are in time.
        improved: better estimate of the smallest sufficient spin inertia [kg m^2]; from below it
            does not overshoot; inf: none suffices.
    """

    margin: FloatArray
    improved: FloatArray


class _AtAngle(NamedTuple):
    """Devices at angles of their layout, shapes (n, k, ...): inertia, I_zz [kg m^2] and axes."""

    inertia: TiltInertia
    yaw_inertia: FloatArray
    axes: FloatArray

    @classmethod
    def of(cls, composite: CompositeInertia, angle: FloatArray) -> "_AtAngle":
        """Devices of these composite inertias at angles [rad], shape (n, k)."""
        return cls(*composite.at(angle), composite.layout.axes(angle))


def margins_of(
    requirement: Requirement,
    drives: Drives,
    composite: CompositeInertia,
    spin_inertia: FloatArray,
    angle: FloatArray,
) -> tuple[list[Margins], list[Margins]]:
    """Margins of wheels in each part of the requirement.

    Args:
        drives: n of them, each as part of its own `composite`.
        spin_inertia: of their wheels [kg m^2], shape (n,).
        angle: of the design's layout [rad], shape (n, k).

    Returns:
        Margins of the parts at the design's angle, shape (n, k), and of those at an incidence of
        their own, shape (n, 1).
    """
    spin, with_rate = spin_inertia[:, None], bool(requirement.reserves)

    def margins_at(
        maneuvers: Sequence[Maneuver], device: _AtAngle, *, with_rate: bool
    ) -> list[Margins]:
        """Margins of each maneuver, and with a rate also of each starting with its reserve's."""
        if not maneuvers:
            return []
        # All at once: for few candidates, a NumPy call costs more than its work.
        have_rate = [False] * len(maneuvers) + [True] * (len(maneuvers) * with_rate)
        cases = [*maneuvers, *maneuvers] if with_rate else maneuvers
        task = wheel_task(cases, requirement, *device, with_rate=have_rate)
        demand = spin_demand(task, columns(drives.line), drives.armature[:, None])
        capacity = capability(demand, spin)
        improved = newton_step(demand, spin, capacity)
        with np.errstate(divide="ignore"):
            margin = capacity.sweep / demand.sweep
        return [Margins(*both) for both in zip(margin, improved, strict=True)]

    at_design, at_own = list[Margins](), list[Margins]()
    as_designed = _AtAngle.of(composite, angle)
    unspecified = [maneuver for maneuver in requirement.maneuvers if maneuver.incidence is None]
    for headed in (False, True):
        maneuvers = [maneuver for maneuver in unspecified if maneuver.has_heading_demand == headed]
        at_design += margins_at(
            maneuvers, as_designed, with_rate=requirement.incidence_is_free and with_rate
        )
    if requirement.rate_change is not None:
        one_stops = requirement.detection is not None
        needed = rate_change_spin_inertia(
            requirement.rate_change,
            drives,
            as_designed.inertia,
            as_designed.axes[..., :2, :],
            one_stops=one_stops,
        )
        at_design.append(Margins(spin / needed, needed))
    for maneuver in requirement.maneuvers:
        device = as_designed
        if maneuver.incidence is not None:
            device = _AtAngle.of(composite, np.full((len(drives), 1), maneuver.incidence))
            at_own += margins_at([maneuver], device, with_rate=with_rate)
        reserve = requirement.reserve(maneuver)
        if reserve.roll > 0.0:
            momentum = roll_cancelling_momentum(reserve.roll, *device, requirement)
            needed = momentum / drives.top_speed[:, None]
            with np.errstate(divide="ignore"):
                margins = Margins(spin / needed, needed)
            (at_design if maneuver.incidence is None else at_own).append(margins)
    return at_design, at_own


def worst_case(parts: Sequence[Margins], shape: tuple[int, ...]) -> Margins:
    """Least margin and largest demand; infinity and 0 where there is no part."""
    margin, improved = np.full(shape, np.inf), np.zeros(shape)
    for part in parts:
        margin = np.minimum(margin, part.margin)
        improved = np.maximum(improved, part.improved)
    return Margins(margin, improved)


def wheel_task(
    maneuvers: Sequence[Maneuver],
    requirement: Requirement,
    inertia: TiltInertia,
    yaw_inertia: ArrayLike,
    axes: FloatArray,
    *,
    with_rate: Sequence[bool] | None = None,
) -> WheelTask:
    """Wheel tasks of maneuvers, fields of shape (m, n, k, ...).

    Args:
        maneuvers: m of them, all headed or none.
        inertia: of robot and device, shapes that broadcast against (n, k, 2) and (n, k).
        yaw_inertia: I_zz of robot and device, broadcasting against (n, k) [kg m^2]; used only if
            headed.
        axes: of the wheels, shape (n, k, 3, w).
        with_rate: see `Requirement.slew`, for each; None: False for all.
    """
    headed = maneuvers[0].has_heading_demand
    axes = axes if headed else axes[..., :2, :]
    inertia, reach = inertia.times(axes.shape[:-2]), np.abs(axes[..., :2, :]).max(axis=-1)
    inertias = [
        maneuver.turned(inertia).within_reach(reach, maneuver.tilt_per_drift)
        for maneuver in maneuvers
    ]
    have_rate = [False] * len(maneuvers) if with_rate is None else with_rate
    slews = [
        requirement.slew(maneuver, turned_inertia, with_rate=has_rate)
        for maneuver, turned_inertia, has_rate in zip(maneuvers, inertias, have_rate, strict=True)
    ]
    one_stops = requirement.detection is not None
    at_headings = [
        _at_worst_heading(slew, yaw_inertia, axes, one_stops=one_stops) for slew in slews
    ]
    swept, momentum = (np.stack(each) for each in zip(*at_headings, strict=True))
    if headed:
        headings, whole = [], np.broadcast_to(yaw_inertia, axes.shape[:-2])
        for maneuver, has_rate in zip(maneuvers, have_rate, strict=True):
            reserve = requirement.reserve(maneuver)
            headings.append(
                np.multiply(
                    maneuver.heading(whole),
                    reserve.demand_with_rate if has_rate else reserve.demand,
                )
            )
        turned, held_up = np.stack(headings, axis=1)[..., None]
        swept = np.concatenate([swept, turned], axis=-1)
        momentum = np.concatenate([momentum, held_up], axis=-1)
    return WheelTask(
        swept=swept,
        momentum=momentum,
        duration=np.array([slew.duration for slew in slews])[:, None, None],
        inertia=TiltInertia(*(np.stack(parts) for parts in zip(*inertias, strict=True))),
        axes=axes,
        one_stops=one_stops,
        yaw_inertia=np.asarray(yaw_inertia) if headed else None,
        initial_speed=np.array([slew.initial_speed for slew in slews])[:, None, None],
        one_way=np.array([slew.one_way for slew in slews])[:, None, None],
    )


def _at_worst_heading(
    slew: Slew, yaw_inertia: ArrayLike, axes: FloatArray, *, one_stops: bool
) -> tuple[FloatArray, FloatArray]:
    """Swept and momentum of a slew, in B at that heading where they ask most of the wheels.

    The trunk yaws, and they stand still in space (docs/theory.md, Disturbances).
    """
    if not np.any(slew.yaw):
        return slew.swept, slew.momentum
    headings = slew.headings(np.broadcast_to(yaw_inertia, axes.shape[:-2]), HEADINGS)
    swept, momentum = (
        seen_at(headings, each[..., None, :]) for each in (slew.swept, slew.momentum)
    )
    remaining = [
        wheels[..., None, :, :] for wheels in (without_each(axes) if one_stops else (axes,))
    ]
    busiest = np.max([gauge(wheels, momentum).busiest for wheels in remaining], axis=0)
    worst = np.argmax(busiest, axis=-1)[..., None, None]

    def at_worst(seen: FloatArray) -> FloatArray:
        return np.take_along_axis(seen, worst, axis=-2)[..., 0, :]

    return at_worst(swept), at_worst(momentum)


def seen_at(heading: FloatArray, fixed: FloatArray) -> FloatArray:
    """A vector that is fixed in space, in B after a change of heading.

    Args:
        heading: angle by which the trunk has yawed [rad], shape (...).
        fixed: about roll and pitch, and yaw if need be, in B before that, shape (..., 2 or 3).
    """
    cosine, sine = np.cos(heading), np.sin(heading)
    x, y, *about_yaw = np.moveaxis(fixed, -1, 0)
    seen = np.broadcast_arrays(cosine * x + sine * y, cosine * y - sine * x, *about_yaw)
    return np.stack(seen, axis=-1)


def rate_change_spin_inertia(
    rate_change: float,
    drives: Drives,
    inertia: TiltInertia,
    axes: FloatArray,
    *,
    one_stops: bool = False,
) -> FloatArray:
    """Spin inertia for a change of rate about either axis, one at a time [kg m^2], shape (n, k).

    h = phi(J_i d) / W at the highest speed, without a time limit (docs/theory.md, Lower bound on
    the wheels' inertia).
    """
    momentum = rate_change_momenta(rate_change, inertia, axes, one_stops=one_stops).max(axis=-1)
    spin_inertia: FloatArray = momentum / drives.top_speed[:, None]
    return spin_inertia


def rate_change_momenta(
    rate_change: float, inertia: TiltInertia, axes: FloatArray, *, one_stops: bool = False
) -> FloatArray:
    """Momentum of the busiest wheel for a change of roll rate, and of pitch rate, (..., 2).

    `one_stops`: with any one of the wheels missing.
    """
    momenta = rate_momenta(inertia, rate_change)
    # Both relative signs of the momenta.
    signed = momenta[..., None, :] * np.array([[1.0, 1.0], [1.0, -1.0]])
    remaining = without_each(axes) if one_stops else (axes,)
    busiest = [
        gauge(wheels[..., None, None, :, :], signed).busiest.max(axis=-1) for wheels in remaining
    ]
    return np.asarray(np.max(busiest, axis=0))


def rate_demands(
    requirement: Requirement, device: Candidate, inertia: TiltInertia
) -> Iterator[TaskDemand]:
    """Demand of a change of rate on the device, about roll and pitch; empty without one."""
    if requirement.rate_change is None:
        return
    incidence, one_stops = device.incidence, requirement.detection is not None
    axes, top_speed = device.layout.axes(incidence)[:2], float(device.line.reserved().top_speed)
    momenta = rate_change_momenta(requirement.rate_change, inertia, axes, one_stops=one_stops)
    for axis, momentum in zip(AXES, momenta.tolist(), strict=True):
        spin_inertia, peak_speed = momentum / top_speed, momentum / device.spin_inertia
        yield TaskDemand(
            f"rate change, {axis}", incidence, spin_inertia, None, None, peak_speed, None
        )


def roll_cancelling_momentum(
    rate: float,
    inertia: TiltInertia,
    yaw_inertia: ArrayLike,
    axes: FloatArray,
    requirement: Requirement,
) -> FloatArray:
    """Momentum that each wheel must absorb to cancel a roll at lift-off in a flip [N m s], (...).

    It is 0 if the wheels also control yaw. If they do not control roll, it is inf while the
    incidence is still to be chosen, and 0 at a specified incidence.

    Args:
        rate: of roll at lift-off [rad/s].
        inertia, yaw_inertia: of robot and device, and its I_zz [kg m^2], shapes (..., 2) and (...).
        axes: of the wheels, shape (..., 3, n).
    """
    required = roll_momentum_per_rate(inertia.diagonal[..., 0], yaw_inertia) * rate / ROLL_CANCELLED
    remaining = (axes,) if requirement.detection is None else without_each(axes)
    roll, _, yaw = np.moveaxis(
        np.min([np.abs(wheels).sum(axis=-1) for wheels in remaining], axis=0), -1, 0
    )
    controlled = roll > OUT_OF_REACH
    momentum = np.where(controlled, required / np.where(controlled, roll, 1.0), np.inf)
    not_required = (yaw > OUT_OF_REACH) | ~(controlled | requirement.incidence_is_free)
    return np.where(not_required | (required == 0.0), 0.0, momentum)


def column(inertia: TiltInertia) -> TiltInertia:
    """Inertia of n trunks with a second array axis for incidences."""
    return TiltInertia(inertia.diagonal[:, None, :], inertia.product[:, None])


def columns(line: DriveLine) -> DriveLine:
    """Voltage lines of n drives with a second array axis for incidences."""
    return DriveLine(**{name: np.asarray(limit)[:, None] for name, limit in vars(line).items()})
