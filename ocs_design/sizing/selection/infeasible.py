"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import Infeasible
from ocs_design.requirement.maneuver import Maneuver, Slew
from ocs_design.sizing.limits import (
    BUS_VOLTAGE,
    RIM_LIMITS,
    TIME,
    WHEEL_SPEED,
    Limit,
    smallest_changes,
)
from ocs_design.sizing.selection.attempt import largest_wheel
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.rejections import promising_gears, rejections
from ocs_design.sizing.selection.result import Reason, Rejection
from ocs_design.sizing.selection.search import Found, is_possible

PRECISION = 0.03
"""Of the changes: within a third of that, relative. Each step searches anew."""

# Changes are looked for with the motors that come closest; only what they can do is promised.
_CLOSEST = 8
# A limit changed more than this is another project...
_MOST_CHANGE = 10.0
# ... and so is a mass changed more than by ten times every length.
_MOST_MASS_CHANGE = _MOST_CHANGE**3
# What no change of a limit mends.
_NO_LIMIT = {Reason.FIGURES, Reason.INCIDENCE}


def infeasible(found: Found, *, advise: bool) -> Infeasible:
    """The error for a problem that no motor solves; looks for changes that would do if asked to."""
    problem = found.problem
    reasons = rejections(found, ())
    closest = sorted(range(len(reasons)), key=lambda index: _distance(reasons[index]))
    nearest = reasons[closest[0]]
    narrowed = _narrowed(found, closest[:_CLOSEST])
    looking = advise and nearest.reason not in _NO_LIMIT
    changes = single_changes(narrowed) if looking else {}
    many = f"none of {len(reasons)} motors" if len(reasons) > 1 else f"motor {nearest.motor}"
    verdict = "can do it" if len(reasons) > 1 else "cannot do it"
    comes = f"; {nearest.motor} comes closest" if len(reasons) > 1 else ""
    largest = nearest.largest
    if largest is None:
        largest = largest_wheel(problem, problem.envelope)
    return Infeasible(
        f"{many[0].upper()}{many[1:]} {verdict} at {problem.bus_voltage:g} V{comes}: "
        f"{nearest.detail}.",
        binding=[str(nearest.reason)],
        required_spin_inertia=nearest.needed,
        largest_spin_inertia=largest,
        relaxations={limit.name: value for limit, value in changes.items()},
        hint=" ".join(_advice(narrowed, nearest.reason, changes)) if advise else "",
    )


def single_changes(problem: SelectionProblem) -> dict[Limit, float]:
    """For each limit that can mend it alone the value that just does, gentlest first [SI].

    Each is proved by selecting again.
    """

    def mends(limit: Limit, value: float) -> bool:
        """Whether there is a device with this limit changed."""
        return is_possible(with_limit(problem, limit, value))

    def hopeful(limit: Limit, value: float) -> bool:
        """Whether the largest change would do."""
        most = _MOST_MASS_CHANGE if limit.name == "wheel_mass_max" else _MOST_CHANGE
        return 0.0 < value < inf and mends(limit, limit.loosened(value, most))

    hopes = {limit: value for limit, value in limits_of(problem).items() if hopeful(limit, value)}
    return smallest_changes(hopes, mends, PRECISION)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Every limit that may be in the way, as it is [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.bus_voltage,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The same problem with one limit changed."""
    if limit is BUS_VOLTAGE:
        return replace(problem, bus_voltage=value)
    if limit is WHEEL_SPEED:
        return replace(problem, wheel_speed_max=value)
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
        """As of the whole."""
        return self.whole.momentum(inertia, standing_height)

    def slew(self, inertia: FloatArray, standing_height: float) -> Slew:
        """The same turn in its own time."""
        slew = self.whole.slew(inertia, standing_height)
        return replace(slew, duration=slew.duration * self.factor)

    @property
    def summary(self) -> str:
        """The whole, and its time."""
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


def _advice(
    problem: SelectionProblem, reason: Reason, changes: Mapping[Limit, float]
) -> Iterator[str]:
    """What would do, in sentences; `problem` is that of the closest motors."""
    if reason is Reason.FIGURES:
        yield (
            "Choose another motor (`ocs-design catalogue motors` marks what is missing), or state "
            "its figures in a file of your own with --motors."
        )
        return
    if changes:
        texts = [limit.loose_text(value) for limit, value in changes.items()]
        yield f"Any one of these alone would do: {'; '.join(texts)}."
    freed = problem.incidence is not None and is_possible(replace(problem, incidence=None))
    if freed:
        yield (
            "At another incidence there is a device: leave out --alpha and --alpha-criterion, or "
            "choose --alpha-criterion lightest."
        )
    elif reason is Reason.INCIDENCE:
        yield (
            "Wheels at 0 deg cannot roll the trunk, wheels at 90 deg cannot pitch it: ask for one "
            "of both, or for another incidence, here or of that maneuver."
        )
    elif not changes:
        yield (
            f"No single limit would do, not even changed {_MOST_CHANGE:.0f}-fold: "
            "loosen several, ask for less, or add stronger motors."
        )
