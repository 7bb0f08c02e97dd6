"""Advice when no motor suffices: the smallest single changes that make a device feasible.

Each change is tested by asking whether any device is feasible for a slightly different problem
(`is_feasible`). Which device does not matter, so candidates are not ranked: those whose largest
wheel exceeds their need the most are tried first, and the first that is solved ends the search.
Where nothing is feasible, nearly all candidates are ruled out by what they need with a massless
wheel and by the largest wheel in closed form.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, repeat

import numpy as np

from ocs_design.actuation.motor import DIRECT, Motor
from ocs_design.common.units import round_outwards
from ocs_design.common.wording import some_of
from ocs_design.requirement.bound import per_wheel, spin_demands
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.sizing.bound.rim_problem import largest_spin_inertia
from ocs_design.sizing.limits import (
    TIME,
    Limit,
    Progress,
    advice,
    ignore_progress,
    narrowed,
    smallest_changes,
)
from ocs_design.sizing.selection.bounds import (
    incidence_intervals,
    initial_guess,
    least_spin_inertias,
)
from ocs_design.sizing.selection.candidates import Candidates, Guess, drives_of, known_pairs
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
that `is_feasible` tries is feasible."""

LARGEST_FACTOR = 10.0
"""Largest factor by which a limit is changed; beyond it, the project is a different one."""

_LARGEST_FACTORS = {"wheel_mass_max": LARGEST_FACTOR**3, "r_max": 7.0, "time": 3.0}
"""Limits with another largest factor. Mass scales with the cube of length. Three times the duration
of a jump is nine times its height; beyond that, a humanoid would be advised to fall from 145 m.
Inertia scales with the fourth power of the radius, so the radius is changed less: larger wheels may
couple roll and pitch arbitrarily strongly, and no bound on what they need holds then."""

_GIVE_FIGURES = (
    "Choose another motor (`ocs-design catalogue motors` marks what is missing), or give its "
    "figures in your own file with --motors."
)


_INTERVALS = 6
"""Number of intervals of the incidence, fewer than in `bounds`, for all drives at once."""

_FIRST_BOUNDED, _BOUNDED = 32, 512
"""Sizes of the first and of later batches of candidates that are bounded together; any feasible one
will do, so the first batch is small."""

_FIRST_SOLVED, _SOLVED = 4, 64
"""Sizes of the first and of later batches of candidates that are solved together."""

_MOST_SOLVED = 128
"""Number of candidates, the most promising first, that are solved before the answer is no."""


def is_feasible(problem: SelectionProblem) -> bool:
    """Whether any of the most promising candidates has a device; others are not tried."""
    tried = 0
    for candidates, guess in _promising(problem):
        # The search ends at the first that has a device.
        if any(solved.point.feasible.any() for solved in solve_stepwise(candidates, guess)):
            return True
        tried += len(candidates)
        if tried >= _MOST_SOLVED:
            break
    return False


def is_conceivable(problem: SelectionProblem) -> bool:
    """Whether the bounds leave any candidate; if not, nothing is feasible."""
    return any(len(candidates) for candidates, _ in _promising(problem))


def _promising(problem: SelectionProblem) -> Iterator[tuple[Candidates, Guess]]:
    """Candidates that no bound rules out, the most promising first, few at first."""
    drives = drives_of(problem, np.argwhere(known_pairs(problem)))
    intervals = incidence_intervals(problem.incidence, _INTERVALS)
    # Least spin inertia of their wheels, whatever they weigh; inf where no wheel would do.
    least = least_spin_inertias(problem, drives, intervals, np.zeros(len(drives))).min(axis=1)
    candidates = Candidates.of_each_material(problem, drives)
    # Candidates whose largest wheel has the most margin come first; too small ones are dropped.
    inertia_beside_rim = candidates.drives.inertia_beside_rim
    needed = np.repeat(least, len(problem.materials))
    largest = largest_spin_inertia(candidates.limits) + inertia_beside_rim
    margin = largest / np.maximum(needed, 1e-15)
    large_enough = np.flatnonzero((largest > inertia_beside_rim) & (margin >= 1.0))
    order = large_enough[np.argsort(-margin[large_enough], kind="stable")]
    left, needed = candidates.take(order), needed[order]
    sizes = chain([_FIRST_BOUNDED], repeat(_BOUNDED))
    while len(left):
        size = next(sizes)
        block = left.take(np.arange(min(size, len(left))))
        guess = initial_guess(block, needed[:size])
        rows = np.flatnonzero(np.isfinite(guess.mass))
        solved = chain([_FIRST_SOLVED], repeat(_SOLVED))
        while rows.size:
            count = next(solved)
            yield block.take(rows[:count]), guess.take(rows[:count])
            rows = rows[count:]
        left, needed = left.take(np.arange(size, len(left))), needed[size:]


def advice_on(
    refused: Refused,
    progress: Progress = ignore_progress,
    *,
    default: bool = False,
    lightest: bool = True,
) -> Refused:
    """The refusal, with the single changes that would do.

    Args:
        default: whether the maneuvers are the defaults.
        lightest: whether the lightest incidence, not tried yet, may be the cure.
    """
    reason, problem = refused.nearest.reason, refused.problem
    changes: dict[Limit, float] = {}
    hints: list[str] = [_GIVE_FIGURES]
    if reason is not Reason.FIGURES:
        # Changing a limit does not help where the incidence is at fault.
        if reason is not Reason.INCIDENCE:
            changes = single_changes(problem, progress)
        nearest_motor = next(
            motor for motor in problem.motors if motor.name == refused.nearest.motor
        )
        motor_needed = needed_motor(problem, nearest_motor)
        hints = []
        if default:
            requirement = problem.requirement
            hints.append(defaults_text(requirement.maneuvers))
            feasible = [
                maneuver.name
                for maneuver in requirement.maneuvers
                if is_feasible(
                    replace(problem, requirement=replace(requirement, maneuvers=(maneuver,)))
                )
            ]
            if feasible:
                alone = "by itself" if len(feasible) == 1 else "one at a time"
                hints.append(f"Feasible {alone}: {some_of(feasible)}.")
        hints += [
            *_balanced_upset(problem),
            *([] if motor_needed is None else [motor_needed.text]),
            *_hints(problem, reason, changes, lightest=lightest),
        ]
    if refused.for_reserve:
        hints.append("A lower --reliability needs a smaller reserve.")
    refused.relaxations = {limit.name: value for limit, value in changes.items()}
    refused.hint = " ".join(hints)
    return refused


def _balanced_upset(problem: SelectionProblem) -> Iterator[str]:
    """Sentence on the largest upset that the drives can balance, all else as specified."""
    requirement = problem.requirement
    upset = [maneuver for maneuver in requirement.maneuvers if maneuver.disturbance_text]

    def can_balance(factor: float) -> bool:
        milder = requirement.changed(
            lambda maneuver: (
                maneuver.milder(1.0 / factor) if maneuver.disturbance_text else maneuver
            )
        )
        return is_feasible(replace(problem, requirement=milder))

    if not upset or not can_balance(LARGEST_FACTOR):
        return
    _, factor = narrowed(can_balance, 1.0, LARGEST_FACTOR, ADVICE_PRECISION)
    text = some_of(
        [
            f"{maneuver.milder(1.0 / factor).disturbance_text} for {maneuver.name}"
            for maneuver in upset
        ]
    )
    yield f"A device exists with {text}."


def single_changes(
    problem: SelectionProblem, progress: Progress = ignore_progress
) -> dict[Limit, float]:
    """Values of single limits that just make a device feasible, the gentlest change first [SI].

    Each is verified by searching for a device again, among all motors and gears of the problem; a
    change that only an unlikely drive could use may be missed (`is_feasible`).
    """
    return smallest_changes(
        limits_of(problem),
        lambda limit, value: is_feasible(with_limit(problem, limit, value)),
        precision=ADVICE_PRECISION,
        most=lambda limit: _LARGEST_FACTORS.get(limit.name, LARGEST_FACTOR),
        conceivable=lambda limit, value: is_conceivable(with_limit(problem, limit, value)),
        progress=progress,
    )


def _change_text(problem: SelectionProblem, limit: Limit, value: float) -> str:
    """A change in the user's terms: time is set by each maneuver's own keys.

    More time is advised only for the maneuvers that need it, out of those that this much more time
    makes feasible together.
    """
    if limit is not TIME:
        return limit.loose_text(value)
    present = problem.requirement.maneuvers
    slow = {maneuver.name for maneuver in present}
    for maneuver in present:
        names = slow - {maneuver.name}
        if names and is_feasible(with_time(problem, value, names)):
            slow = names
    slower = with_time(problem, value, slow).requirement.maneuvers
    pairs = zip(present, slower, strict=True)
    return " together with ".join(change_text(old, new) for old, new in pairs if old is not new)


def _hints(
    problem: SelectionProblem, reason: Reason, changes: Mapping[Limit, float], *, lightest: bool
) -> Iterator[str]:
    """Sentences on changes that would make a device feasible."""
    if changes:
        texts = [_change_text(problem, limit, value) for limit, value in changes.items()]
        yield advice(texts, "")
    layout = problem.layout
    if not layout.pairs and reason is Reason.INCIDENCE:
        yield (
            f"The wheels of {layout.text} cannot turn the robot about every required axis: "
            "require less, or choose another layout (--layout pair)."
        )
        return
    specified = layout.pairs and problem.incidence is not None
    if lightest and specified and is_feasible(replace(problem, incidence=None)):
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


def defaults_text(maneuvers: Sequence[Maneuver]) -> str:
    """Sentences that say that these maneuvers are the defaults, and how to specify others."""
    names = some_of([maneuver.name for maneuver in maneuvers])
    return (
        f"No maneuver was specified, so the defaults apply: {names}. Specify your own with "
        "--jump-height, --tilt, --fall or --kick; they replace the defaults."
    )


_TORQUE_FACTORS = 1.2 ** np.arange(1, 10)
"""Peak torques to try, relative to that which turns the robot alone in time: up to fivefold."""

_SPEED_FACTORS = (1.2, 1.6, 2.2)
"""No-load speeds to try, relative to that of the largest wheel with the robot's momentum."""

_SIMILAR_TORQUE = 1.1
"""Of two motors whose torques differ by at most this factor, the slower one is recommended."""

_TORQUE_DENSITY_FACTORS = (1.0, 2.0, 4.0)
"""Torque-to-mass ratios to try in turn, relative to the model's: where six motors weigh as much as
the robot, none built like the model would do, however large."""

_INCIDENCES = np.radians(np.arange(5.0, 90.0, 5.0))
"""Incidences to try where it is free; that which requires the least torque is taken [rad]."""

_STALL_RATIO_RANGE = (2.0, 10.0)
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
    Where the incidence is free, the motor is for the one that requires the least torque. None: no
    such motor would do, no time is set, or the wheels are not in pairs.
    """
    if not problem.layout.pairs or not (model.mass and model.peak_torque):
        return None

    def demand(incidence: float) -> tuple[float, float]:
        """Largest torque [N m] and momentum [N m s] of a wheel."""
        inertia = problem.robot.inertia
        demands = spin_demands(problem.requirement, lambda _: inertia, incidence)
        torque = max(demand.torque for demand in demands)
        momentum = max(per_wheel(demand.momentum, demand.incidence) for demand in demands)
        return torque / problem.layout.pairs, momentum / problem.layout.pairs

    if problem.incidence is None:
        problem = replace(problem, incidence=float(min(_INCIDENCES, key=demand)))
    assert problem.incidence is not None, "it was chosen"
    torque, momentum = demand(problem.incidence)
    largest = largest_wheel(problem, problem.envelope)
    if not (torque > 0.0 and np.isfinite(momentum) and largest > 0.0):
        return None

    direct = next((gear for gear in problem.gears if gear.room is None), DIRECT)

    def would_do(base: Motor, speed: float, peak: float) -> bool:
        motor = _scaled(base, peak, speed, problem.supply.voltage)
        return is_feasible(replace(problem, motors=(motor,), gears=(direct,)))

    for density_factor in _TORQUE_DENSITY_FACTORS:
        scaled_model, motors = replace(model, peak_torque=density_factor * model.peak_torque), []
        for speed_factor in _SPEED_FACTORS:
            speed = speed_factor * momentum / largest
            is_enough = partial(would_do, scaled_model, speed)
            highest = next(
                (peak for peak in (torque * _TORQUE_FACTORS).tolist() if is_enough(peak)), None
            )
            if highest is not None:
                _, peak = narrowed(
                    is_enough, highest / _TORQUE_FACTORS[0], highest, ADVICE_PRECISION
                )
                mass = model.mass * peak / (density_factor * model.peak_torque)
                heavier = model.name if density_factor > 1.0 else ""
                motors.append(NeededMotor(peak, speed, mass, problem.supply.voltage, heavier))
        weakest = min((motor.peak_torque for motor in motors), default=0.0)
        for motor in motors:
            if motor.peak_torque <= _SIMILAR_TORQUE * weakest:
                return motor
    return None


def _scaled(model: Motor, peak_torque: float, speed: float, voltage: float) -> Motor:
    """The model scaled to a peak torque [N m] and wound for a speed [rad/s] at a voltage [V]."""
    assert model.peak_torque is not None
    ratio = peak_torque / model.peak_torque
    stall = _STALL_RATIO_RANGE[0]
    if model.torque_constant and model.resistance and model.rated_voltage:
        stall_ratio = (
            model.rated_voltage * model.torque_constant / model.resistance / model.peak_torque
        )
        stall = float(np.clip(stall_ratio, *_STALL_RATIO_RANGE))
    constant = voltage / speed

    def scaled(figure: float | None, power: float) -> float | None:
        return None if figure is None else figure * ratio**power

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
