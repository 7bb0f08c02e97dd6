"""No motor can do it: what is missing, and the smallest single changes that would do."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from ocs_design.actuation.motor import DIRECT, Motor
from ocs_design.common.errors import Infeasible
from ocs_design.common.units import round_outwards
from ocs_design.requirement.bound import per_wheel, spin_demands
from ocs_design.requirement.kinds import change_text
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import Balance
from ocs_design.robot.links import listed
from ocs_design.sizing.changes import Progress, advice, smallest_changes, unseen
from ocs_design.sizing.limits import TIME, Limit
from ocs_design.sizing.selection.feasibility import Field, largest_wheel
from ocs_design.sizing.selection.problem import SelectionProblem, limits_of, with_limit, with_time
from ocs_design.sizing.selection.result import Reason, Rejection

PRECISION = 0.03
"""Precision of the changes, relative: with less by more than that none of the drives that
`Field.possible` tries can do it."""

MOST_CHANGE = 10.0
"""A limit changed by more than this factor is another project."""

_MOST_CHANGES = {"wheel_mass_max": MOST_CHANGE**3, "r_max": 7.0, "time": 3.0}
"""Other factors: a mass goes with the cube of every length. Three times the time of a jump is nine
times its height: beyond, a humanoid is told to fall from 145 m. A radius, with whose fourth power
the inertia goes, is changed less: wheels beyond may couple roll and pitch by anything, and no bound
of what they need survives that."""

NO_ROOM = frozenset({Reason.ENVELOPE, Reason.STRESS, Reason.MASS})
"""Reasons that are a wheel's, not a motor's."""

_STATE_FIGURES = (
    "Choose another motor (`ocs-design catalogue motors` marks what is missing), or state its "
    "figures in a file of your own with --motors."
)


class Refused(Infeasible):
    """No motor can do it; what would do is not looked for yet, which takes longer than the search.

    Attributes:
        problem: that no motor solves. nearest: the motor that comes closest.
    """

    def __init__(self, problem: SelectionProblem, rejections: Iterable[Rejection]) -> None:
        # How far a motor is from being possible; last, those whose figures are missing.
        nearest = min(rejections, key=lambda one: (one.reason is Reason.FIGURES, one.shortfall))
        largest = nearest.largest
        count, voltage = len(problem.motors), f"{problem.bus_voltage:g} V"
        if (wheels := len(problem.layout)) != 2:
            voltage += " with one wheel" if wheels == 1 else f" with {wheels} wheels"
        who = (
            f"Motor {nearest.motor} cannot do it at {voltage}"
            if count == 1
            else f"None of {count} motors can do it at {voltage}; {nearest.motor} comes closest"
        )
        super().__init__(
            f"{who}: {nearest.detail}.",
            binding=[str(nearest.reason)],
            required_spin_inertia=nearest.needed,
            largest_spin_inertia=(
                largest_wheel(problem, problem.envelope) if largest is None else largest
            ),
            relaxations={},
        )
        self.problem, self.nearest = problem, nearest

    @property
    def for_reserve(self) -> bool:
        """Whether a device that keeps nothing does it."""
        return any(kept.short for kept in self.problem.requirement.reserves.values())

    def advised(
        self, progress: Progress = unseen, *, default: bool = False, lightest: bool = True
    ) -> Infeasible:
        """The error with the single changes that would do.

        Args:
            progress: is told the share that is done.
            default: whether nobody asked for these maneuvers.
            lightest: whether the lightest incidence may be a cure, as nobody has tried it.
        """
        reason = self.nearest.reason
        changes: dict[Limit, float] = {}
        hints: Iterable[str] = [_STATE_FIGURES]
        if reason is not Reason.FIGURES:
            field = Field.of(self.problem)
            # No change of a limit mends an incidence.
            if reason is not Reason.INCIDENCE:
                changes = single_changes(field, progress)
            hints = [
                *_caught(field),
                *self._motor_hint(),
                *_hints(field, reason, changes, lightest=lightest),
            ]
            if default:
                hints = [_default_hint(field), *hints]
        if self.for_reserve:
            hints = [*hints, "A lower --reliability keeps less in reserve."]
        return Infeasible(
            self.message,
            binding=self.binding,
            required_spin_inertia=self.required_spin_inertia,
            largest_spin_inertia=self.largest_spin_inertia,
            relaxations={limit.name: value for limit, value in changes.items()},
            hint=" ".join(hints),
        )

    def _motor_hint(self) -> Iterator[str]:
        """What motor would do, as heavy for its torque as the nearest."""
        model = next(each for each in self.problem.motors if each.name == self.nearest.motor)
        needed = needed_motor(self.problem, model)
        if needed is not None:
            yield needed.text


def _caught(field: Field) -> Iterator[str]:
    """The largest part of what is to be balanced that the drives catch, the rest as asked."""
    requirement = field.problem.requirement
    asked = [each for each in requirement.maneuvers if isinstance(each, Balance)]

    def does(part: float) -> bool:
        """Whether there is a device for this part of it."""
        maneuvers = tuple(
            each.times(part) if isinstance(each, Balance) else each
            for each in requirement.maneuvers
        )
        less = replace(requirement, maneuvers=maneuvers)
        return field.changed(replace(field.problem, requirement=less)).possible

    low, high = 1.0 / MOST_CHANGE, 1.0
    if not asked or not does(low):
        return
    while high > (1.0 + PRECISION) * low:
        middle = sqrt(low * high)
        low, high = (middle, high) if does(middle) else (low, middle)
    told = listed([f"{each.times(low).upset} for {each.name}" for each in asked])
    yield f"With {told} there is a device."


def single_changes(field: Field, progress: Progress = unseen) -> dict[Limit, float]:
    """Values of the limits that can mend it alone and just do, gentlest first [SI].

    Each is proved by looking for a device again, among all motors and gears of the problem; what
    only an unlikely one of them could do may be missed (`Field.possible`).
    """

    def changed(limit: Limit, value: float) -> Field:
        """The drives with one limit at another value."""
        return field.changed(with_limit(field.problem, limit, value))

    return smallest_changes(
        limits_of(field.problem),
        lambda limit, value: changed(limit, value).possible,
        precision=PRECISION,
        most=lambda limit: _MOST_CHANGES.get(limit.name, MOST_CHANGE),
        conceivable=lambda limit, value: changed(limit, value).conceivable,
        progress=progress,
    )


def slowed_maneuvers(field: Field, factor: float) -> SelectionProblem:
    """The problem with `factor` times the time for those maneuvers that need it.

    Args:
        field: of a problem that has a solution if all have so much more time.
        factor: above 1.
    """
    problem = field.problem
    slow = [maneuver.name for maneuver in problem.requirement.maneuvers]
    for name in tuple(slow):
        fewer = set(slow) - {name}
        if fewer and field.changed(with_time(problem, factor, fewer)).possible:
            slow.remove(name)
    return with_time(problem, factor, set(slow))


def _hints(
    field: Field, reason: Reason, changes: Mapping[Limit, float], *, lightest: bool
) -> Iterator[str]:
    """Sentences on what would do."""
    if changes:
        texts = [_change_text(field, limit, value) for limit, value in changes.items()]
        yield advice(texts, MOST_CHANGE, "")
    layout = field.problem.layout
    if not layout.pairs and reason is Reason.INCIDENCE:
        yield (
            f"The wheels of {layout.text} do not reach every axis that is asked for: ask for "
            "less, or take another layout (--layout pair)."
        )
        return
    free = replace(field.problem, incidence=None)
    stated = layout.pairs and field.problem.incidence is not None
    if lightest and stated and field.changed(free).possible:
        yield (
            "At another incidence there is a device: leave out --alpha and choose "
            "--alpha-criterion lightest."
        )
    elif reason is Reason.INCIDENCE:
        yield (
            "Wheels at 0 deg cannot roll the trunk, wheels at 90 deg cannot pitch it: ask for one "
            "of both, or for another incidence, here or of that maneuver."
        )
    elif not changes:
        yield advice([], MOST_CHANGE, "loosen several, ask for less, or add stronger motors.")


def _default_hint(field: Field) -> str:
    """Which maneuvers nobody asked for, and which of them can be done as they are."""
    problem = field.problem
    asked = problem.requirement
    fine = [
        each.name
        for each in asked.maneuvers
        if field.changed(replace(problem, requirement=replace(asked, maneuvers=(each,)))).possible
    ]
    texts = [
        unasked(asked.maneuvers),
        f"{listed(fine)} can be done as it is." if len(fine) == 1 else "",
        f"{listed(fine)} can be done, each by itself." if len(fine) > 1 else "",
    ]
    return " ".join(filter(None, texts))


def unasked(maneuvers: Sequence[Maneuver]) -> str:
    """That these are the default, and how to ask for others."""
    names = listed([each.name for each in maneuvers])
    return (
        f"Nobody asked for {names}: they are the default. State what you need with --jump-height, "
        "--tilt, --fall or --kick, and only that is asked."
    )


def _change_text(field: Field, limit: Limit, value: float) -> str:
    """A change as the user states it: time is a matter of each maneuver's own keys."""
    if limit is not TIME:
        return limit.loose_text(value)
    before = field.problem.requirement.maneuvers
    after = slowed_maneuvers(field, value).requirement.maneuvers
    both = zip(before, after, strict=True)
    return " together with ".join(change_text(old, new) for old, new in both if old is not new)


_STRONGER = 1.2 ** np.arange(1, 10)
"""Peak torques that are tried, over that which turns the robot alone in time: up to fivefold."""

_FASTER = (1.2, 1.6, 2.2)
"""Speeds without load that are tried, over that of the largest wheel with the robot's momentum."""

_AS_WEAK = 1.1
"""A slower motor is named in place of one that may be weaker by this factor at most."""

_STALL = (2.0, 10.0)
"""Stall torque over peak torque that a winding is taken to have, least and most."""


@dataclass(frozen=True)
class NeededMotor:
    """Motor with which there would be a device, its wheel on its shaft.

    Attributes:
        peak_torque: [N m]. no_load_speed: at the supply's voltage [rad/s].
        mass: at most [kg].
        voltage: of the supply [V].
    """

    peak_torque: float
    no_load_speed: float
    mass: float
    voltage: float

    @property
    def text(self) -> str:
        """Sentence on what to look for."""
        torque, mass = (
            round_outwards(value, upwards=True, digits=2) for value in (self.peak_torque, self.mass)
        )
        rpm = round(self.no_load_speed * 30.0 / np.pi, -2)
        return (
            f"A motor of about {torque:.3g} N m peak torque and {rpm:,.0f} rpm without load at "
            f"{self.voltage:g} V, of at most {mass:.3g} kg, would do."
        )


def needed_motor(problem: SelectionProblem, model: Motor) -> NeededMotor | None:
    """The weakest motor that would do, built as `model` is.

    Torque and mass grow with the third power of a motor's lengths. Its speed is that with which the
    largest wheel has the momentum asked for, and somewhat more where that lets it be much weaker.

    Args:
        problem: that no motor solves, at a stated incidence.
        model: a motor whose figures are known.

    Returns:
        None: no such motor would do, or no time is set, or the wheels are no pairs.
    """
    incidence = problem.incidence
    if not problem.layout.pairs or incidence is None or not (model.mass and model.peak_torque):
        return None
    demands = spin_demands(problem.requirement, problem.robot.inertia, incidence)
    pairs = problem.layout.pairs
    momentum = max(per_wheel(demand.momentum, demand.incidence) for demand in demands) / pairs
    torque = max(demand.torque for demand in demands) / pairs
    largest = largest_wheel(problem, problem.envelope)
    if not (torque > 0.0 and np.isfinite(momentum) and largest > 0.0):
        return None
    found = []
    for faster in _FASTER:
        speed = faster * momentum / largest
        peak = _least_torque(problem, model, torque, speed)
        if peak is not None:
            mass = model.mass * peak / model.peak_torque
            found.append(NeededMotor(peak, speed, mass, problem.bus_voltage))
    weakest = min((need.peak_torque for need in found), default=0.0)
    return next((need for need in found if need.peak_torque <= _AS_WEAK * weakest), None)


def _least_torque(
    problem: SelectionProblem, model: Motor, torque: float, speed: float
) -> float | None:
    """Least peak torque that does with this speed without load [N m]; None: none that is tried.

    Args:
        torque: that turns the robot alone in time [N m].
        speed: [rad/s].
    """

    def does(peak: float) -> bool:
        motor = _scaled(model, peak, speed, problem.bus_voltage)
        return Field.of(replace(problem, motors=(motor,), gears=(DIRECT,))).possible

    high = next((peak for peak in (torque * _STRONGER).tolist() if does(peak)), None)
    if high is None:
        return None
    low = high / _STRONGER[0]
    while high > (1.0 + PRECISION) * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if does(middle) else (middle, high)
    return float(high)


def _scaled(model: Motor, peak_torque: float, speed: float, voltage: float) -> Motor:
    """The model enlarged to a peak torque [N m], and wound for a speed [rad/s] at a voltage."""
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
