"""What one more of each limit would buy, with the same motor, gear and material.

The device is sized anew with one limit looser and all else as it is, by the same programme that
polishes a selected one, from where it stands. A limit that nothing which holds the mass moves with
is worth nothing. What another drive would make of the change is not looked at here: that the
choice may jump is told by how much heavier the next drive is.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.limits import STRESS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.selection.changed_limits import limits_of, with_limit
from ocs_design.sizing.selection.drive_table import drive_table
from ocs_design.sizing.selection.lot import lot_of
from ocs_design.sizing.selection.polishing import HELD, Programme, coordinates, lightest
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate

_UNITS = {STRESS: 0.1, TIME: 0.01, WHEEL_SPEED: 100.0}
"""What an engineer would change these by, in the limit's own unit; all others by one."""

_LEAST_LEFT = 0.5
"""Of a limit that is loosened downwards."""

_HOLDS, _MOVES = 1e-6, 1e-9
"""Logarithms of ratios: slack of what holds the mass, and what of it counts as moved."""

_ENOUGH = 0.01
"""Of the first steps: gives the mass to some 1e-7 of what is bought."""


@dataclass(frozen=True)
class Price:
    """One limit, a little looser.

    Attributes:
        limit: which one. value: as it is [SI]. changed: the looser one [SI].
        mass_change: of the whole device [kg], at most 0.
    """

    limit: Limit
    value: float
    changed: float
    mass_change: float


def mass_prices(problem: SelectionProblem, chosen: Candidate) -> Iterator[Price]:
    """Of every limit that is stated.

    Args:
        problem: that was solved.
        chosen: its lightest device, as it was selected.
    """
    alone = replace(
        problem, motors=(chosen.motor,), gears=(chosen.gear,), materials=(chosen.material,)
    )
    programme = _programme(alone)
    start = coordinates(_shape(chosen), chosen.incidence)
    for limit, value in limits_of(problem).items():
        if np.isfinite(value) and value > 0.0:
            changed = _loosened(limit, value)
            looser = _programme(with_limit(alone, limit, changed))
            change = (
                _change(programme, looser, start) if _is_felt(programme, looser, start) else 0.0
            )
            yield Price(limit, value, changed, float(change * chosen.mass))


def _loosened(limit: Limit, value: float) -> float:
    step = _UNITS.get(limit, 1.0) / limit.per_si
    return value + step if limit.loosens_upwards else max(value - step, _LEAST_LEFT * value)


def _is_felt(programme: Programme, looser: Programme, point: FloatArray) -> bool:
    """Whether anything that holds the mass moves."""
    (_, held), (_, moved) = programme(point[None]), looser(point[None])
    return bool(np.any((held < _HOLDS) & (np.abs(moved - held) > _MOVES)))


def _change(programme: Programme, looser: Programme, start: FloatArray) -> float:
    """Of the mass, as a part of it."""
    (before, _), found = programme(start[None]), lightest(looser, start, smallest=_ENOUGH)
    if found.violation > HELD:
        return 0.0
    return min(float(np.expm1(found.value - before[0])), 0.0)


def _programme(alone: SelectionProblem) -> Programme:
    """Of a problem with a single motor, gear and material."""
    first = np.zeros(1, dtype=np.intp)
    return Programme(alone, lot_of(alone, drive_table(alone, first.repeat(2)[None]), first))


def _shape(chosen: Candidate) -> ModuleShape:
    figures = (
        chosen.inner_radius,
        chosen.outer_radius,
        chosen.height,
        chosen.rim_mass,
        chosen.web_mass,
        chosen.printed_mass,
    )
    return ModuleShape(*(np.array([figure]) for figure in figures))
