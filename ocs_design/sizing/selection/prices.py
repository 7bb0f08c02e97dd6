"""Mass that slightly looser limits save, with the same motor, gear and material.

The device is sized anew with one limit looser and all else as it is, by the programme that refines
a selected one, from where it stands. A limit that is not active is worth nothing. What another
drive would make of the change is not looked at here: that the choice may jump is told by how much
heavier the next drive is.
"""

from collections.abc import Iterator

import numpy as np

from ocs_design.device.records.selection import PriceRecord
from ocs_design.sizing.limits import STRESS, TIME, WHEEL_SPEED
from ocs_design.sizing.selection.candidates import Candidates, drives_of
from ocs_design.sizing.selection.device import of_parts
from ocs_design.sizing.selection.problem import SelectionProblem, limits_of, with_limit
from ocs_design.sizing.selection.refinement import Programme, lightest
from ocs_design.sizing.selection.result import Candidate

_UNITS = {STRESS: 0.1, TIME: 0.01, WHEEL_SPEED: 100.0}
"""Changes that an engineer would make, in the limit's own unit; all others by one."""

_LEAST_LEFT = 0.5
"""Share of a limit that is left where it is loosened downwards."""

_HELD = 1e-6
"""Relative violation of a limit that does not matter to a price."""

_HOLDS, _MOVES = 1e-6, 1e-9
"""Slack of an active limit, and change of it that counts as moved; logarithms of ratios."""


def mass_prices(problem: SelectionProblem, chosen: Candidate) -> Iterator[PriceRecord]:
    """Prices of all limits that are stated, with the same motor, gear and material.

    Args:
        problem: that was solved.
        chosen: its lightest device, as it was selected.
    """
    alone = of_parts(problem, chosen)
    wall = chosen.outer_radius - chosen.inner_radius
    sizes = np.log([chosen.outer_radius, chosen.height, wall])
    start = np.append(sizes, chosen.incidence)
    (before,), (held,) = _programme(alone)(start[None])
    for limit, value in limits_of(problem).items():
        if not (np.isfinite(value) and value > 0.0):
            continue
        step = _UNITS.get(limit, 1.0) / limit.per_si
        changed = value + step if limit.loosens_upwards else max(value - step, _LEAST_LEFT * value)
        looser = _programme(with_limit(alone, limit, changed))
        _, (moved,) = looser(start[None])
        change = 0.0
        if np.any((held < _HOLDS) & (np.abs(moved - held) > _MOVES)):
            found = lightest(looser, start)
            if found.violation <= _HELD:
                change = min(float(np.expm1(found.value - before)), 0.0)
        yield PriceRecord(
            limit=limit.name,
            value=value,
            changed=changed,
            mass_change=float(change * chosen.modules_mass),
        )


def _programme(alone: SelectionProblem) -> Programme:
    """Programme of a problem with a single motor, gear and material."""
    first = np.zeros(1, dtype=np.intp)
    return Programme(Candidates(alone, drives_of(alone, first.repeat(2)[None]), first))
