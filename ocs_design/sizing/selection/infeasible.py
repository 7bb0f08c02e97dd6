"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import Infeasible
from ocs_design.requirement.maneuver import Maneuver, Slew
from ocs_design.sizing.limits import RIM_LIMITS, Limit, smallest_changes
from ocs_design.sizing.selection.attempt import largest_rim
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import promising_gears, rejections
from ocs_design.sizing.selection.result import Reason, Rejection
from ocs_design.sizing.selection.search import Found, is_possible

PRECISION = 0.03
"""Of the changes: within a third of that, relative. Each step searches anew."""

BUS_VOLTAGE = Limit("bus_voltage", "bus_voltage", "bus_voltage", True, "V", 1.0)
TIME = Limit("time", "time for every maneuver", "", True, "times what is given", 1.0)

_ENVELOPE = tuple(limit for limit in RIM_LIMITS if limit.name in {"r_max", "h_max"})
# Changes are looked for with the motors that come closest; only what they can do is promised.
_CLOSEST = 8
# A limit changed more than this is another project.
_MOST_CHANGE = 10.0


def infeasible(found: Found, *, advise: bool) -> Infeasible:
    """The error for a problem that no motor solves; looks for changes that would do if asked to."""
    problem = found.problem
    reasons = rejections(found, ())
    closest = sorted(range(len(reasons)), key=lambda index: _distance(reasons[index]))
    nearest = reasons[closest[0]]
    changes = single_changes(_narrowed(found, closest[:_CLOSEST])) if advise else {}
    many = f"none of {len(reasons)} motors" if len(reasons) > 1 else f"motor {nearest.motor}"
    verdict = "can do it" if len(reasons) > 1 else "cannot do it"
    comes = f"; {nearest.motor} comes closest" if len(reasons) > 1 else ""
    needed = found.spin_inertia[closest[0]]
    return Infeasible(
        f"{many[0].upper()}{many[1:]} {verdict} at {problem.bus_voltage:g} V{comes}: "
        f"{nearest.detail}.",
        binding=[str(nearest.reason)],
        required_spin_inertia=float(needed[np.isfinite(needed)].max(initial=0.0)),
        largest_spin_inertia=largest_rim(problem, problem.envelope),
        relaxations={limit.name: value for limit, value in changes.items()},
        hint=_advice(changes) if advise else "",
    )


def single_changes(problem: SelectionProblem) -> dict[Limit, float]:
    """For each limit that can mend it alone the value that just does, gentlest first [SI].

    Each is proved by selecting again.
    """
    values = {
        **{limit: limit.value(problem.envelope) for limit in _ENVELOPE},
        BUS_VOLTAGE: problem.bus_voltage,
        TIME: 1.0,
    }

    def mends(limit: Limit, value: float) -> bool:
        """Whether there is a device with this limit changed."""
        return is_possible(with_limit(problem, limit, value))

    def hopeful(limit: Limit) -> bool:
        """Whether the largest change would do."""
        return mends(limit, limit.loosened(values[limit], _MOST_CHANGE))

    hopes = {limit: value for limit, value in values.items() if hopeful(limit)}
    return smallest_changes(hopes, mends, PRECISION)


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The same problem with one limit changed."""
    if limit is BUS_VOLTAGE:
        return replace(problem, bus_voltage=value)
    if limit is TIME:
        requirement = problem.requirement
        slower = tuple(slowed(maneuver, value) for maneuver in requirement.maneuvers)
        return replace(problem, requirement=replace(requirement, maneuvers=slower))
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def slowed(maneuver: Maneuver, factor: float) -> Maneuver:
    """The same maneuver with more time for it."""
    return _Slowed(
        name=maneuver.name,
        gravity=maneuver.gravity,
        incidence=maneuver.incidence,
        whole=maneuver,
        factor=factor,
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class _Slowed(Maneuver):
    """`whole` with `factor` times its duration; nothing else of it changes."""

    whole: Maneuver
    factor: float

    def momentum(self, inertia: FloatArray, standing_height: float) -> FloatArray:
        return self.whole.momentum(inertia, standing_height)

    def slew(self, inertia: FloatArray, standing_height: float) -> Slew:
        slew = self.whole.slew(inertia, standing_height)
        return replace(slew, duration=slew.duration * self.factor)

    @property
    def summary(self) -> str:
        return f"{self.whole.summary}, in {self.factor:.4g} times the time"


def _distance(rejection: Rejection) -> tuple[bool, float]:
    """How far a motor is from being possible."""
    return rejection.reason is Reason.FIGURES, rejection.shortfall


def _narrowed(found: Found, motors: Sequence[int]) -> SelectionProblem:
    """Only these motors and the gears that suit them best."""
    problem = found.problem
    known = [motor for motor in motors if found.known[motor].any()]
    gears = {gear for motor in known for gear in promising_gears(found, motor)}
    return replace(
        problem,
        motors=[problem.motors[motor] for motor in known],
        gears=[problem.gears[gear] for gear in sorted(gears)],
    )


def _advice(changes: Mapping[Limit, float]) -> str:
    """The changes as a sentence."""
    if not changes:
        return (
            f"No single limit would do, not even changed {_MOST_CHANGE:.0f}-fold: "
            "loosen several, ask for less, or add stronger motors."
        )
    texts: Sequence[str] = [limit.loose_text(value) for limit, value in changes.items()]
    return f"Any one of these alone would do: {'; '.join(texts)}."
