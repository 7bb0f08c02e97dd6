"""Advice when no motor suffices: the smallest single changes that make a device feasible.

Each change is tested by asking whether any device is feasible for a slightly different problem
(`Field`). Which device does not matter, so candidates are not ranked: those whose largest wheel
exceeds their need the most are tried first, and the first that is solved ends the search. Where
nothing is feasible, nearly all candidates are ruled out by what they need with a massless wheel and
by the largest wheel in closed form.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, repeat

import numpy as np

from ocs_design.actuation.motor import DIRECT, Motor
from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import round_outwards
from ocs_design.common.wording import some_of
from ocs_design.requirement.bound import per_wheel, spin_demands
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.bound.rim_problem import largest_spin_inertia
from ocs_design.sizing.limits import (
    TIME,
    Limit,
    Progress,
    advice,
    narrowed,
    smallest_changes,
    unseen,
)
from ocs_design.sizing.selection.bounds import (
    incidence_intervals,
    initial_guess,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidates import (
    Candidates,
    Guess,
    drives_of,
    known_pairs,
)
from ocs_design.sizing.selection.drives import Drives
from ocs_design.sizing.selection.fixed_point import solve_stepwise
from ocs_design.sizing.selection.problem import (
    Reason,
    SelectionProblem,
    limits_of,
    with_limit,
    with_time,
)
from ocs_design.sizing.selection.rejections import Refused, largest_wheel

ADVICE_PRECISION = 0.03
"""Relative precision of the changes: with a change smaller by more than this, none of the drives
that `Field.possible` tries is feasible."""

MOST_ADVISED = 10.0
"""Largest factor by which a limit is changed; beyond it, the project is a different one."""

_MOST_ADVISED = {"wheel_mass_max": MOST_ADVISED**3, "r_max": 7.0, "time": 3.0}
"""Limits with another largest factor. Mass scales with the cube of length. Three times the duration
of a jump is nine times its height; beyond that, a humanoid would be advised to fall from 145 m.
Inertia scales with the fourth power of the radius, so the radius is changed less: larger wheels may
couple roll and pitch arbitrarily strongly, and no bound on what they need holds then."""

_STATE_FIGURES = (
    "Choose another motor (`ocs-design catalogue motors` marks what is missing), or give its "
    "figures in your own file with --motors."
)


_INTERVALS = 6
"""Number of intervals of the incidence, fewer than in `bounds`, for all drives at once."""

_FIRST, _BLOCK = 32, 512
"""Sizes of the first and of later batches of candidates that are bounded together; any feasible one
will do, so the first batch is small."""

_FIRST_SOLVED, _SOLVED = 4, 64
"""Sizes of the first and of later batches of candidates that are solved together."""

_MOST_SOLVED = 128
"""Number of candidates, the most promising first, that are solved before the answer is no."""


@dataclass(frozen=True, eq=False)
class Field:
    """Drives of a problem that are still being considered.

    Attributes:
        problem: requirement and envelope.
        drives: n of them.
        needed: least spin inertia of their wheels, whatever they weigh [kg m^2], shape (n,); inf
            where no wheel would do.
    """

    problem: SelectionProblem
    drives: Drives
    needed: FloatArray

    @classmethod
    def of(cls, problem: SelectionProblem, drives: Drives | None = None) -> "Field":
        """All motors and gears whose figures are known, or these drives."""
        if drives is None:
            pairs = np.argwhere(known_pairs(problem))
            drives = drives_of(problem, pairs)
        intervals, nothing = (
            incidence_intervals(problem.incidence, _INTERVALS),
            np.zeros(len(drives)),
        )
        needed = least_spin_inertias(problem, drives, intervals, nothing)
        return cls(problem, drives, needed.min(axis=1))

    def changed(self, problem: SelectionProblem) -> "Field":
        """Field of these drives for a problem that differs in a limit."""
        old, drives = self.problem, self.drives
        before, after = ((each.bus_voltage, each.wheel_speed_max) for each in (old, problem))
        if before != after:
            drives = drives_of(problem, np.column_stack([drives.motor, drives.gear]))
        return Field.of(problem, drives)

    def value_of(self, limit: Limit) -> float:
        """Present value of one of the problem's limits [SI]."""
        return limits_of(self.problem)[limit]

    def with_limit(self, limit: Limit, value: float) -> "Field":
        """Field of these drives with one of the problem's limits changed [SI]."""
        return self.changed(with_limit(self.problem, limit, value))

    def with_requirement(self, requirement: Requirement) -> "Field":
        """Field of these drives for another requirement."""
        return self.changed(replace(self.problem, requirement=requirement))

    @property
    def possible(self) -> bool:
        """Whether any of the most promising candidates has a device; others are not tried."""
        tried = 0
        for candidates, guess in self._bounded():
            # The search ends at the first that has a device.
            if any(each.point.feasible.any() for each in solve_stepwise(candidates, guess)):
                return True
            tried += len(candidates)
            if tried >= _MOST_SOLVED:
                break
        return False

    @property
    def conceivable(self) -> bool:
        """Whether the bounds leave any candidate; if not, nothing is possible."""
        return any(len(candidates) for candidates, _ in self._bounded())

    def change_text(self, limit: Limit, value: float) -> str:
        """A change in the user's terms: time is set by each maneuver's own keys.

        More time is advised only for the maneuvers that need it, out of those that this much more
        time makes feasible together.
        """
        if limit is not TIME:
            return limit.loose_text(value)
        before = self.problem.requirement.maneuvers
        slow = {maneuver.name for maneuver in before}
        for maneuver in before:
            fewer = slow - {maneuver.name}
            if fewer and self.changed(with_time(self.problem, value, fewer)).possible:
                slow = fewer
        after = with_time(self.problem, value, slow).requirement.maneuvers
        both = zip(before, after, strict=True)
        return " together with ".join(change_text(old, new) for old, new in both if old is not new)

    def _bounded(self) -> Iterator[tuple[Candidates, Guess]]:
        """Candidates that no bound rules out, the most promising first, few at first."""
        every = Candidates.of_each_material(self.problem, self.drives)
        # Candidates whose largest wheel has the most margin come first; too small ones are dropped.
        beside = every.drives.inertia_beside_rim
        needed = np.repeat(self.needed, len(self.problem.materials))
        largest = largest_spin_inertia(every.limits) + beside
        spare = largest / np.maximum(needed, 1e-15)
        roomy = np.flatnonzero((largest > beside) & (spare >= 1.0))
        order = roomy[np.argsort(-spare[roomy], kind="stable")]
        left, needed = every.take(order), needed[order]
        sizes = chain([_FIRST], repeat(_BLOCK))
        while len(left):
            size = next(sizes)
            some = left.take(np.arange(min(size, len(left))))
            guess = initial_guess(some, needed[:size])
            rows = np.flatnonzero(np.isfinite(guess.mass))
            solved = chain([_FIRST_SOLVED], repeat(_SOLVED))
            while rows.size:
                count = next(solved)
                yield some.take(rows[:count]), guess.take(rows[:count])
                rows = rows[count:]
            left, needed = left.take(np.arange(size, len(left))), needed[size:]


def advice_on(
    refused: Refused,
    progress: Progress = unseen,
    *,
    default: bool = False,
    lightest: bool = True,
) -> Refused:
    """The refusal, with the single changes that would do.

    Args:
        refused: problem that no motor can solve, and why.
        progress: called with the fraction done. default: whether the maneuvers are the defaults.
            lightest: whether the lightest incidence, not tried yet, may be the cure.
    """
    reason, problem = refused.nearest.reason, refused.problem
    changes: dict[Limit, float] = {}
    hints: list[str] = [_STATE_FIGURES]
    if reason is not Reason.FIGURES:
        field = Field.of(problem)
        # Changing a limit does not help where the incidence is at fault.
        if reason is not Reason.INCIDENCE:
            changes = single_changes(field, progress)
        model = next(each for each in problem.motors if each.name == refused.nearest.motor)
        needed = needed_motor(problem, model)
        hints = []
        if default:
            asked = problem.requirement
            hints.append(unasked(asked.maneuvers))
            fine = [
                each.name
                for each in asked.maneuvers
                if field.with_requirement(replace(asked, maneuvers=(each,))).possible
            ]
            if fine:
                alone = "by itself" if len(fine) == 1 else "one at a time"
                hints.append(f"Feasible {alone}: {some_of(fine)}.")
        hints += [
            *_caught(field),
            *([] if needed is None else [needed.text]),
            *_hints(field, reason, changes, lightest=lightest),
        ]
    if refused.for_reserve:
        hints.append("A lower --reliability needs a smaller reserve.")
    refused.relaxations = {limit.name: value for limit, value in changes.items()}
    refused.hint = " ".join(hints)
    return refused


def _caught(field: Field) -> Iterator[str]:
    """Sentence on the largest upset that the drives can balance, all else as specified."""
    requirement = field.problem.requirement
    asked = [each for each in requirement.maneuvers if each.upset]

    def does(factor: float) -> bool:
        less = requirement.changed(lambda each: each.milder(1.0 / factor) if each.upset else each)
        return field.with_requirement(less).possible

    if not asked or not does(MOST_ADVISED):
        return
    _, factor = narrowed(does, 1.0, MOST_ADVISED, ADVICE_PRECISION)
    text = some_of([f"{each.milder(1.0 / factor).upset} for {each.name}" for each in asked])
    yield f"A device exists with {text}."


def single_changes(field: Field, progress: Progress = unseen) -> dict[Limit, float]:
    """Values of single limits that just make a device feasible, the gentlest change first [SI].

    Each is verified by searching for a device again, among all motors and gears of the problem; a
    change that only an unlikely drive could use may be missed (`Field.possible`).
    """
    return smallest_changes(
        field,
        limits_of(field.problem),
        lambda changed: changed.possible,
        precision=ADVICE_PRECISION,
        most=lambda limit: _MOST_ADVISED.get(limit.name, MOST_ADVISED),
        conceivable=lambda changed: changed.conceivable,
        progress=progress,
    )


def _hints(
    field: Field, reason: Reason, changes: Mapping[Limit, float], *, lightest: bool
) -> Iterator[str]:
    """Sentences on changes that would make a device feasible."""
    if changes:
        texts = [field.change_text(limit, value) for limit, value in changes.items()]
        yield advice(texts, "")
    layout = field.problem.layout
    if not layout.pairs and reason is Reason.INCIDENCE:
        yield (
            f"The wheels of {layout.text} cannot turn the robot about every required axis: "
            "require less, or choose another layout (--layout pair)."
        )
        return
    free = replace(field.problem, incidence=None)
    specified = layout.pairs and field.problem.incidence is not None
    if lightest and specified and field.changed(free).possible:
        yield (
            "Other incidences are feasible: leave out --alpha and choose "
            "--alpha-criterion lightest."
        )
    elif reason is Reason.INCIDENCE:
        yield (
            "Wheels at 0 deg cannot roll the trunk, wheels at 90 deg cannot pitch it: require only "
            "one of the two, or set another incidence, for the device or for that maneuver."
        )
    elif not changes:
        yield advice([], "loosen several, ask for less, or add stronger motors.")


def unasked(maneuvers: Sequence[Maneuver]) -> str:
    """Sentences that say that these maneuvers are the defaults, and how to specify others."""
    names = some_of([each.name for each in maneuvers])
    return (
        f"No maneuver was specified, so the defaults apply: {names}. Specify your own with "
        "--jump-height, --tilt, --fall or --kick; they replace the defaults."
    )


_STRONGER = 1.2 ** np.arange(1, 10)
"""Peak torques to try, relative to that which turns the robot alone in time: up to fivefold."""

_FASTER = (1.2, 1.6, 2.2)
"""No-load speeds to try, relative to that of the largest wheel with the robot's momentum."""

_AS_WEAK = 1.1
"""Of two motors whose torques differ by at most this factor, the slower one is recommended."""

_DENSER = (1.0, 2.0, 4.0)
"""Torque-to-mass ratios to try in turn, relative to the model's: where six motors weigh as much as
the robot, none built like the model would do, however large."""

_ANGLES = np.radians(np.arange(5.0, 90.0, 5.0))
"""Incidences to try where it is free; that which requires the least torque is taken [rad]."""

_STALL = (2.0, 10.0)
"""Assumed range of a winding's ratio of stall torque to peak torque."""


@dataclass(frozen=True)
class NeededMotor:
    """Direct-drive motor that would make a device feasible.

    Attributes:
        peak_torque: peak torque [N m]. no_load_speed: at the supply's voltage [rad/s].
        mass: at most [kg].
        voltage: of the supply [V].
        heavier: motor whose torque-to-mass ratio is too low at any size; empty: it suffices.
    """

    peak_torque: float
    no_load_speed: float
    mass: float
    voltage: float
    heavier: str = ""

    @property
    def text(self) -> str:
        """Sentence on what to look for."""
        torque, mass = (
            round_outwards(value, upwards=True, digits=2) for value in (self.peak_torque, self.mass)
        )
        rpm = round(self.no_load_speed * 30.0 / np.pi, -2)
        return (
            f"A motor with about {torque:.3g} N m peak torque and {rpm:,.0f} rpm no-load speed at "
            f"{self.voltage:g} V, weighing at most {mass:.3g} kg, would do."
            + (
                f" Motors with the torque-to-mass ratio of {self.heavier} would not do at any size."
                if self.heavier
                else ""
            )
        )


def needed_motor(problem: SelectionProblem, model: Motor) -> NeededMotor | None:
    """The weakest motor that would do, built like `model` or with more torque for its mass.

    Torque and mass scale with the cube of a motor's dimensions. Its speed is that at which the
    largest wheel has the required momentum, or somewhat more where that allows a much weaker motor.

    Args:
        problem: problem that no motor solves. Where its incidence is free, the motor is for the one
            that requires the least torque.
        model: a motor whose figures are known.

    Returns:
        The motor; None: no such motor would do, no time is set, or the wheels are not in pairs.
    """
    if not problem.layout.pairs or not (model.mass and model.peak_torque):
        return None

    def asked(incidence: float) -> tuple[float, float]:
        """Largest torque [N m] and momentum [N m s] of a wheel."""
        demands = spin_demands(problem.requirement, problem.robot.inertia, incidence)
        torque = max(demand.torque for demand in demands)
        momentum = max(per_wheel(demand.momentum, demand.incidence) for demand in demands)
        return torque / problem.layout.pairs, momentum / problem.layout.pairs

    if problem.incidence is None:
        problem = replace(problem, incidence=float(min(_ANGLES, key=asked)))
    assert problem.incidence is not None, "it was chosen"
    (torque, momentum), largest = asked(problem.incidence), largest_wheel(problem, problem.envelope)
    if not (torque > 0.0 and np.isfinite(momentum) and largest > 0.0):
        return None

    direct = next((gear for gear in problem.gears if gear.room is None), DIRECT)

    def does(built: Motor, speed: float, peak: float) -> bool:
        motor = _scaled(built, peak, speed, problem.bus_voltage)
        return Field.of(replace(problem, motors=(motor,), gears=(direct,))).possible

    for denser in _DENSER:
        own, found = replace(model, peak_torque=denser * model.peak_torque), []
        for faster in _FASTER:
            speed = faster * momentum / largest
            enough = partial(does, own, speed)
            high = next((peak for peak in (torque * _STRONGER).tolist() if enough(peak)), None)
            if high is not None:
                _, peak = narrowed(enough, high / _STRONGER[0], high, ADVICE_PRECISION)
                mass = model.mass * peak / (denser * model.peak_torque)
                heavier = model.name if denser > 1.0 else ""
                found.append(NeededMotor(peak, speed, mass, problem.bus_voltage, heavier))
        weakest = min((need.peak_torque for need in found), default=0.0)
        for need in found:
            if need.peak_torque <= _AS_WEAK * weakest:
                return need
    return None


def _scaled(model: Motor, peak_torque: float, speed: float, voltage: float) -> Motor:
    """The model scaled to a peak torque [N m] and wound for a speed [rad/s] at a voltage [V]."""
    assert model.peak_torque is not None
    larger = peak_torque / model.peak_torque
    stall = _STALL[0]
    if model.torque_constant and model.resistance and model.rated_voltage:
        own = model.rated_voltage * model.torque_constant / model.resistance / model.peak_torque
        stall = float(np.clip(own, *_STALL))
    constant = voltage / speed

    def scaled(figure: float | None, power: float) -> float | None:
        return None if figure is None else figure * larger**power

    return replace(
        model,
        mass=scaled(model.mass, 1.0),
        diameter=scaled(model.diameter, 1.0 / 3.0),
        length=scaled(model.length, 1.0 / 3.0),
        rotor_inertia=scaled(model.rotor_inertia, 5.0 / 3.0),
        torque_constant=constant,
        resistance=voltage * constant / (stall * peak_torque),
        rated_voltage=voltage,
        no_load_speed=speed,
        speed_max=None,
        peak_torque=peak_torque,
        peak_current=None,
        continuous_torque=None,
        mounting=None,
    )
