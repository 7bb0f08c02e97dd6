"""The trajectory program: maneuvers of one robot, and the device's dimensions if they are free.

Momentum is conserved in free flight. With its value H_0 in the world, an attitude R and wheel
speeds W tell everything else:

    I w = R^T H_0 - h A W
    ((h + a) 1 - h^2 A^T I^-1 A) W_dot = tau + h A^T I^-1 (w x R^T H_0)

so that a quaternion and n speeds are the state, for any layout of n wheels (docs/theory.md, The
maneuver as an optimal control problem). About a pivot gravity changes the momentum about it,
H_0_dot = m g l x e in the world, and it is part of the state.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache
from math import isfinite
from threading import Lock
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.maneuver import End
from ocs_design.sizing.trajectory.boundary import Boundary
from ocs_design.sizing.trajectory.collocation import (
    DEGREE,
    TORQUE_DEGREE,
    bernstein_product,
    collocation,
)
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.motion import FixedAxisTurn, Motion

IPOPT_OPTIONS: dict[str, Any] = {
    "ipopt.tol": 1e-8,
    "ipopt.acceptable_iter": 0,
    # Bounds are bounds: a rim is not to stick out of its envelope by 1e-8 of it.
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.linear_solver": "mumps",
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
}

PLAN_OPTIONS: dict[str, Any] = {
    # A plan need not be the best to eight digits, but must hold its equations: peaks are flat, and
    # some plans that exist were given up for the last two digits of their power.
    "ipopt.tol": 1e-5,
    "ipopt.constr_viol_tol": 1e-8,
    # What cannot be done is found out sooner.
    "ipopt.expect_infeasible_problem": "yes",
    "ipopt.max_resto_iter": 25,
}
"""Beside `IPOPT_OPTIONS`, where no dimension is free."""

ITERATIONS_MAX = 200
"""A program that is solved takes 5 to 150."""

GUESSED_MAX = 60
"""Most iterations: with a guess of its own a turn takes 8 to 35, without a solution all of them."""

WINDING = 0.5
"""How far the integral of the rate about the maneuver's axis may be from its angle [rad].

It keeps the search from leaving out a whole turn; the attitude at the end is asked for exactly.
"""

EFFORT_WEIGHT = 1e-4
"""Weight of each maneuver's mean squared torque beside another objective, both around one.

Of all ways through a maneuver that does not decide, it makes the gentlest the only one; without it
IPOPT wanders among them. It costs less of the objective than the collocation's own error.
"""

POWER_EFFORT = 0.2
"""Weight of the mean squared torque beside the peak power, each over its limit.

The power alone would have the torque at its limit wherever the wheels are slow."""

_PUSH_STEPS = 8

_ONE_AT_A_TIME = Lock()
"""A program that is kept holds the numbers of the turn that it solves."""


class Plant(NamedTuple):
    """A gyrostat whose figures may depend on the dimensions, see `Gyrostat`.

    Attributes:
        inertia: I_tot, wheels braked [kg m^2], (3, 3).
        axes: A, (3, n).
        spin_inertia, armature: [kg m^2].
    """

    inertia: ca.MX
    axes: ca.MX
    spin_inertia: ca.MX
    armature: ca.MX

    @classmethod
    def of(cls, gyrostat: Gyrostat) -> "Plant":
        """A gyrostat of numbers."""
        figures = (gyrostat.inertia, gyrostat.axes, gyrostat.spin_inertia, gyrostat.armature)
        return cls(*(ca.MX(ca.DM(figure)) for figure in figures))


@dataclass(frozen=True, eq=False)
class Turn:
    """One maneuver in the program.

    Attributes:
        asked: its boundary value problem.
        gyrostat: robot and device where the search begins, at the incidence of the maneuver.
        plant: the same as a function of the dimensions, (m, 1); None: nothing of it is free.
        guess: where the search begins; None: a turn about a fixed axis.
    """

    asked: Boundary
    gyrostat: Gyrostat
    plant: Callable[[ca.MX], Plant] | None = None
    guess: Motion | None = None

    @cached_property
    def outline(self) -> FixedAxisTurn:
        """The turn about a fixed axis that starts like the maneuver."""
        start = after_push(self.asked)(self.gyrostat.inertia)
        return FixedAxisTurn.of(self.asked, *(np.asarray(part).ravel() for part in start))


@dataclass(frozen=True, eq=False)
class Dimensions:
    """The device's dimensions that are free.

    Attributes:
        start, lower, upper: scaled to be around one, shape (m,).
        objective: to be minimised, around one, of the dimensions.
        excess: what must not be positive, scaled, of the dimensions; None: nothing.
    """

    start: FloatArray
    lower: FloatArray
    upper: FloatArray
    objective: Callable[[ca.MX], ca.MX]
    excess: Callable[[ca.MX], ca.MX] | None = None


@dataclass(frozen=True, eq=False)
class Solution:
    """The outcome of the program.

    Attributes:
        motions: of each turn.
        dimensions: found, shape (m,).
        solved: whether IPOPT found a local optimum; all else means nothing if not.
        status: IPOPT's own word. iterations: of all passes.
        violation: largest, of the program's constraints, scaled.
        cost: what was minimised.
    """

    motions: tuple[Motion, ...]
    dimensions: FloatArray
    solved: bool
    status: str
    iterations: int
    violation: float
    cost: float


def solve(
    turns: Sequence[Turn],
    line: DriveLine,
    passes: Sequence[int],
    dimensions: Dimensions | None = None,
) -> Solution:
    """Least peak power, or the best dimensions with which every turn can be done.

    Where no power is limited, it is the least effort.

    Where a finer pass fails the one before it counts.

    Args:
        turns: of one robot and device.
        line: what of the drives may be used.
        passes: number of intervals of each pass: even ones in the first, from then on short where
            the torques change.
        dimensions: None: those of the gyrostats.
    """
    guesses = [turn.guess or turn.outline.motion(turn.gyrostat, passes[0]) for turn in turns]
    if dimensions is None and isfinite(float(line.power_max)) and turns[0].guess is None:
        guesses = [guesses[0].uneven(turns[0].gyrostat)]
    solution = _solve(turns, guesses, line, dimensions)
    for intervals in passes[1:] if solution.solved else ():
        if dimensions is not None:
            dimensions = replace(dimensions, start=solution.dimensions)
        guesses = [motion.refined(intervals) for motion in solution.motions]
        finer = _solve(turns, guesses, line, dimensions)
        best = finer if finer.solved else solution
        solution = replace(best, iterations=solution.iterations + finer.iterations)
        if not finer.solved:
            break
    return solution


def _solve(
    turns: Sequence[Turn],
    guesses: Sequence[Motion],
    line: DriveLine,
    dimensions: Dimensions | None,
) -> Solution:
    """Solve on the intervals of the guesses."""
    if dimensions is None:
        with _ONE_AT_A_TIME:
            return _planned(turns[0], guesses[0], line)
    program = ca.Opti()
    free = program.variable(len(dimensions.start))
    program.set_initial(free, dimensions.start)
    program.subject_to(program.bounded(dimensions.lower, free, dimensions.upper))
    if dimensions.excess is not None:
        program.subject_to(dimensions.excess(free) <= 0.0)
    objective, found = dimensions.objective(free), []
    for turn, guess in zip(turns, guesses, strict=True):
        plant = Plant.of(turn.gyrostat) if turn.plant is None else turn.plant(free)
        shape, numbers = Shape.of(turn, line, guess), _numbers(turn, plant, line, guess)
        variables = _transcribe(program, shape, numbers)
        variables.begin(program, turn, guess, numbers)
        objective += EFFORT_WEIGHT * variables.effort
        found.append(variables)
    program.minimize(objective)
    # One flat graph is quicker; splines of the dimensions have none.
    program.solver("ipopt", IPOPT_OPTIONS | _options(guessed=turns[0].guess is not None))
    return _solved(program, found, guesses, free)


def _planned(turn: Turn, guess: Motion, line: DriveLine) -> Solution:
    """One turn of a device that stands, by the program of its shape."""
    numbers = _numbers(turn, Plant.of(turn.gyrostat), line, guess)
    values = {name: ca.sparsify(ca.evalf(each)) for name, each in numbers.items()}
    patterns = ((name, tuple(each.sparsity().compress())) for name, each in values.items())
    program, parameters, variables = _plan_program(Shape.of(turn, line, guess), tuple(patterns))
    for name, parameter in parameters.items():
        program.set_value(parameter, values[name].nonzeros())
    variables.begin(program, turn, guess, values)
    return _solved(program, [variables], [guess], ca.MX(0, 1))


@lru_cache(maxsize=16)
def _plan_program(
    shape: "Shape", patterns: tuple[tuple[str, tuple[int, ...]], ...]
) -> tuple[ca.Opti, dict[str, ca.MX], "_Variables"]:
    """Program of all turns of a shape, with the numbers that are not zero as its parameters.

    To derive a program takes as long as 40 iterations.

    Args:
        shape: of the turns. patterns: each number's name, and where it is not zero.
    """
    program, parameters, numbers = ca.Opti(), {}, {}
    for name, pattern in patterns:
        where = ca.Sparsity.compressed(pattern)
        numbers[name] = ca.MX(*where.shape)
        if where.nnz():
            parameters[name] = program.parameter(where.nnz())
            numbers[name] = ca.MX(where, parameters[name])
    variables = _transcribe(program, shape, numbers)
    # Without a supply that limits it nothing is known of the power, and effort alone counts.
    peak = 0.0 if variables.peak is None else variables.peak / POWER_EFFORT
    program.minimize(variables.effort + peak)
    options = _options(guessed=shape.guessed) | {"expand": True} | PLAN_OPTIONS
    if shape.power_limited:
        # A peak is flat at many instants at once: half the time where the barrier falls steadily.
        options["ipopt.mu_strategy"] = "monotone"
        options["ipopt.mu_linear_decrease_factor"] = 0.1
        options["ipopt.mu_superlinear_decrease_power"] = 1.6
    program.solver("ipopt", IPOPT_OPTIONS | options)
    return program, parameters, variables


def _options(*, guessed: bool) -> dict[str, Any]:
    """Options of every program."""
    most = GUESSED_MAX if guessed else ITERATIONS_MAX
    return {"ipopt.max_iter": most, "detect_simple_bounds": True}


def _solved(
    program: ca.Opti, found: Sequence["_Variables"], guesses: Sequence[Motion], free: ca.MX
) -> Solution:
    """What IPOPT makes of a program."""
    try:
        program.solve()
    except RuntimeError:
        # CasADi's way to say that IPOPT found no solution, of which the statistics tell more.
        if program.stats()["success"]:
            raise
    value, stats = program.debug.value, program.stats()
    excess = np.array([value(program.lbg) - value(program.g), value(program.g - program.ubg)])
    return Solution(
        motions=tuple(
            Motion(
                guess.lengths,
                np.array(value(each.scaled_states), ndmin=2),
                np.array(value(each.scaled_torques), ndmin=2),
            )
            for guess, each in zip(guesses, found, strict=True)
        ),
        dimensions=np.array(value(free), ndmin=1),
        solved=bool(stats["success"]),
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        violation=float(np.max(excess, initial=0.0)),
        cost=float(value(program.f)),
    )


class Shape(NamedTuple):
    """What of a turn decides which equations its program has.

    Attributes:
        wheels, intervals: how many. end: see `Boundary`.
        stands, on_edge: about a pivot, about an edge.
        axes_at_rest, axes_of_tilt: how many are stopped at the end, and righted.
        guessed: whether the search begins elsewhere than at a turn about a fixed axis.
        torque_limited, speed_limited, back_emf, power_limited: which limits there are.
    """

    wheels: int
    intervals: int
    end: str
    stands: bool
    on_edge: bool
    axes_at_rest: int
    axes_of_tilt: int
    guessed: bool
    torque_limited: bool
    speed_limited: bool
    back_emf: bool
    power_limited: bool

    @classmethod
    def of(cls, turn: Turn, line: DriveLine, guess: Motion) -> "Shape":
        """The shape of a turn on the intervals of a guess."""
        gyrostat = turn.gyrostat
        back_emf = isfinite(float(line.stall_torque))
        return cls(
            wheels=len(guess.torques),
            intervals=len(guess.lengths),
            end=turn.asked.end,
            stands=gyrostat.stands,
            on_edge=gyrostat.edge is not None,
            axes_at_rest=len(gyrostat.turns_about),
            axes_of_tilt=len(_righted(turn.asked, gyrostat)),
            guessed=turn.guess is not None,
            torque_limited=isfinite(float(line.torque_limit)),
            speed_limited=not back_emf or float(line.speed_max) < float(line.no_load_speed),
            back_emf=back_emf,
            power_limited=isfinite(float(line.power_max)),
        )


def _numbers(turn: Turn, plant: Plant, line: DriveLine, guess: Motion) -> dict[str, ca.MX]:
    """All numbers of a turn's equations by their names, columns."""
    asked, outline, gyrostat = turn.asked, turn.outline, turn.gyrostat
    wheels = len(guess.torques)
    # Numbers around one: speeds over that without load, torques over the current limit, else over
    # the stall torque, else over what the turn asks for.
    demand = outline.peak_acceleration * float(np.linalg.eigvalsh(gyrostat.inertia)[-1])
    limits = (float(line.torque_limit), float(line.stall_torque), demand)
    torque_unit, speed_unit = next(filter(isfinite, limits)), float(line.no_load_speed)
    weight = float(np.linalg.norm(gyrostat.pull)) * asked.duration
    scale = np.concatenate([np.ones(4), np.full(wheels, speed_unit), np.full(3, weight)])
    attitude, figures = _start(asked, gyrostat)(*plant)
    slope = 1.0 / float(line.stall_torque)
    own = ca.vertcat(outline.axis, slope * speed_unit, gyrostat.pull)
    numbers: dict[str, Any] = {
        "scale": scale[: len(guess.states)],
        "torque_unit": torque_unit,
        "speed_unit": speed_unit,
        "lengths": guess.lengths,
        "duration": asked.duration,
        "attitude": attitude,
        "speed": np.broadcast_to(np.asarray(asked.wheel_speed) / speed_unit, (wheels,)),
        "figures": ca.vertcat(figures, own),
        "momentum": figures[-3:] / weight if gyrostat.stands else 0.0,
        "at_rest": gyrostat.turns_about.T,
        # A trunk that is asked for no turn has no rate to count in.
        "rate_unit": outline.peak_rate or 1.0 / asked.duration,
        "final": asked.final_attitude,
        "up": asked.final_vertical,
        "righted": _righted(asked, gyrostat),
        "angle": outline.angle,
        "slope": slope * torque_unit if isfinite(float(line.stall_torque)) else 0.0,
        "torque_most": line.torque_limit / torque_unit if isfinite(line.torque_limit) else 0.0,
        "speed_most": min(float(line.speed_max) / speed_unit, 1.0),
        "power_most": wheels * line.power_max if isfinite(line.power_max) else 0.0,
    }
    return {
        name: ca.MX(ca.DM(each)) if not isinstance(each, ca.MX) else each
        for name, each in numbers.items()
    }


@dataclass(frozen=True, eq=False)
class _Variables:
    """Variables of one turn in its program, and what is to be minimised.

    Attributes:
        states, torques: over their units. turned: at the end of each interval [rad], (1, k).
        scaled_states, scaled_torques: as in `Motion`.
        effort: mean over the time of all squared torques over the square of the largest.
        peak: power over the largest; None: it is not limited.
    """

    states: ca.MX
    torques: ca.MX
    turned: ca.MX
    scaled_states: ca.MX
    scaled_torques: ca.MX
    effort: ca.MX
    peak: ca.MX | None

    def begin(
        self, program: ca.Opti, turn: Turn, guess: Motion, numbers: Mapping[str, ca.MX | ca.DM]
    ) -> None:
        """Let the search begin at a guess."""
        scale, torque_unit = (
            np.asarray(ca.evalf(numbers[name])) for name in ("scale", "torque_unit")
        )
        shares = guess.lengths / guess.lengths.sum()
        program.set_initial(self.states, guess.states / scale)
        program.set_initial(self.torques, guess.torques / torque_unit)
        program.set_initial(self.turned, turn.outline.angle * np.cumsum(shares))
        if self.peak is not None:
            program.set_initial(self.peak, 1.0)


def _transcribe(program: ca.Opti, shape: Shape, numbers: Mapping[str, ca.MX]) -> _Variables:
    """One turn by direct collocation on its intervals."""
    wheels, count = shape.wheels, shape.intervals
    scale, torque_unit, speed_unit = (
        numbers[name] for name in ("scale", "torque_unit", "speed_unit")
    )
    duration, attitude, rate_unit = (
        numbers[name] for name in ("duration", "attitude", "rate_unit")
    )
    states = program.variable(scale.shape[0], count * DEGREE + 1)
    torques = program.variable(wheels, count * (TORQUE_DEGREE + 1))
    turned = program.variable(1, count)

    scaled = ca.repmat(scale, 1, count * DEGREE + 1) * states
    mapped = _interval(wheels, stands=shape.stands).map(count)(
        states=ca.horzcat(*(scaled[:, k * DEGREE : (k + 1) * DEGREE + 1] for k in range(count))),
        torques=torques * torque_unit,
        length=numbers["lengths"].T,
        figures=ca.repmat(numbers["figures"], 1, count),
    )
    for defect, unit in (("turning", 1.0), ("driving", torque_unit * duration)):
        program.subject_to(ca.vec(mapped[defect]) / unit == 0.0)
    program.subject_to(states[: 4 + wheels, 0] == ca.vertcat(attitude, numbers["speed"]))
    if shape.stands:
        program.subject_to(states[4 + wheels :, 0] == numbers["momentum"])
        program.subject_to(ca.vec(mapped["swinging"]) / scale[-1] == 0.0)
    for k in range(shape.axes_at_rest):
        program.subject_to(numbers["at_rest"][:, k].T @ mapped["rates"][:, -1] / rate_unit == 0.0)
    if shape.end != End.AT_REST:
        ending = numbers["final"], numbers["up"], numbers["righted"]
        program.subject_to(_missed(shape)(states[:4, -1], *ending) == 0.0)
    # Summed up one by one: a single sum would be a dense row, for which Jacobians take long.
    program.subject_to(turned == ca.horzcat(ca.MX(0.0), turned[:-1]) + mapped["swept"])
    if not shape.guessed and shape.end != End.AT_REST:
        program.subject_to(program.bounded(-WINDING, turned[-1] - numbers["angle"], WINDING))

    # On Bernstein coefficients, so that limits hold between the nodes too.
    speeds, elevated = ca.vec(mapped["speeds"]) / speed_unit, ca.vec(mapped["elevated"])
    if shape.torque_limited:
        largest = numbers["torque_most"]
        program.subject_to(program.bounded(-largest, ca.vec(torques), largest))
    if shape.back_emf:
        slope = numbers["slope"] / torque_unit
        program.subject_to(program.bounded(-1.0, speeds + slope * elevated, 1.0))
    if shape.speed_limited:
        highest = numbers["speed_most"]
        program.subject_to(program.bounded(-highest, speeds, highest))
    peak = None
    if shape.power_limited:
        peak, power = program.variable(), ca.vec(mapped["power"]) / numbers["power_most"]
        program.subject_to(program.bounded(0.0, peak, 1.0))
        program.subject_to(power - peak <= 0.0)
        program.subject_to(power + peak >= 0.0)
    effort = ca.sum(mapped["effort"]) / (torque_unit**2 * duration)
    return _Variables(states, torques, turned, scaled, torques * torque_unit, effort, peak)


@cache
def _interval(wheels: int, *, stands: bool) -> ca.Function:
    """One interval of the collocation, to be mapped over all of them; d = `DEGREE`.

    Inputs: `states` at its nodes (4 + n, d + 1), or three rows more, Bernstein coefficients of the
    `torques` (n, 3), its `length` [s], and the plant's `figures`, see `_start`. Outputs: defects of
    the equations of motion at the Radau points times the length, of the attitude (4, d) and of the
    wheels' (n, d) [N m s]; Bernstein coefficients of the wheels' `speeds` (n, d + 1) and of the
    torques in the same degree; the trunk's `rates` at its end (3, 1); `effort`, the integral of all
    squared torques; `swept`, the angle about `axis` [rad]; Bernstein coefficients of the `power` of
    all motors (1, 2 d + 1), with `copper`, the heat over a squared torque [W/(N m)^2], times the
    gear's efficiency [W]; `swinging`, the defect of the momentum about a pivot (3, d) [N m s].
    """
    table, rows = collocation(), 4 + wheels + 3 * stands
    states = ca.SX.sym("states", rows, DEGREE + 1)
    torques = ca.SX.sym("torques", wheels, TORQUE_DEGREE + 1)
    length = ca.SX.sym("length")
    inverse, held = ca.SX.sym("inverse", 3, 3), ca.SX.sym("held", 3, wheels)
    driven, momentum = ca.SX.sym("driven"), ca.SX.sym("momentum", 3)
    axis, copper, pull = ca.SX.sym("axis", 3), ca.SX.sym("copper"), ca.SX.sym("pull", 3)
    mobility = held.T @ inverse
    mass = driven * ca.SX.eye(wheels) - mobility @ held
    slopes, values = states @ table.derivative.T, torques @ table.torque.T
    turning, driving, rates, swinging = [], [], [], []
    speeds, elevated = states[4 : 4 + wheels, :] @ table.bernstein.T, torques @ table.elevation.T
    given = copper * elevated + speeds
    power = [
        sum(share * ca.dot(elevated[:, i], given[:, k - i]) for i, share in row)
        for k, row in enumerate(bernstein_product(DEGREE))
    ]
    for j in range(DEGREE):
        attitude, speed = states[:4, j + 1], states[4 : 4 + wheels, j + 1]
        now = states[4 + wheels :, j + 1] if stands else momentum
        seen = _turned(_back(attitude), now)
        rate = inverse @ (seen - held @ speed)
        change = 0.5 * _product(attitude, ca.vertcat(0.0, rate))
        torque = values[:, j] + mobility @ ca.cross(rate, seen)
        if stands:
            gravity = ca.cross(ca.SX([0.0, 0.0, 1.0]), _turned(attitude, pull))
            torque -= mobility @ _turned(_back(attitude), gravity)
            swinging.append(slopes[4 + wheels :, j] - gravity * length)
        turning.append(slopes[:4, j] - change * length)
        driving.append(mass @ slopes[4 : 4 + wheels, j] - torque * length)
        rates.append(rate)
    return ca.Function(
        "interval",
        [
            states,
            torques,
            length,
            ca.veccat(inverse, held, driven, momentum, axis, copper, pull),
        ],
        [
            ca.horzcat(*turning),
            ca.horzcat(*driving),
            speeds,
            elevated,
            rates[-1],
            ca.trace(torques @ table.square @ torques.T) * length,
            axis.T @ ca.horzcat(*rates) @ table.weights * length,
            ca.horzcat(*power),
            ca.horzcat(*swinging),
        ],
        ["states", "torques", "length", "figures"],
        [
            "turning",
            "driving",
            "speeds",
            "elevated",
            "rates",
            "effort",
            "swept",
            "power",
            "swinging",
        ],
    )


def _start(asked: Boundary, gyrostat: Gyrostat) -> ca.Function:
    """Function from a plant to its attitude at the start, and its figures in one column.

    They are I^-1, of what turns about an edge alone, h A, h + a and the momentum in the world.
    """
    wheels = gyrostat.axes.shape[1]
    inertia, axes = ca.SX.sym("inertia", 3, 3), ca.SX.sym("axes", 3, wheels)
    spin_inertia, armature = ca.SX.sym("spin_inertia"), ca.SX.sym("armature")
    attitude, rate = after_push(asked)(inertia)
    held = spin_inertia * axes
    speed = np.broadcast_to(np.asarray(asked.wheel_speed), (wheels,))
    momentum = _turned(attitude, inertia @ rate + held @ ca.DM(speed))
    inverse = ca.inv(inertia)
    if gyrostat.edge is not None:
        edge = ca.DM(gyrostat.edge)
        inverse = edge @ edge.T / (edge.T @ inertia @ edge)
    figures = ca.veccat(inverse, held, spin_inertia + armature, momentum)
    return ca.Function("start", [inertia, axes, spin_inertia, armature], [attitude, figures])


def after_push(asked: Boundary) -> ca.Function:
    """Attitude (4, 1) and rate [rad/s] (3, 1) at the start of the turn for an inertia I_tot (3, 3).

    The torque of a push stands in B while it turns robot and device as one rigid body: Euler's
    equation by classical Runge-Kutta steps.
    """
    inertia, now = ca.SX.sym("inertia", 3, 3), ca.SX.sym("now", 7)
    rate, step = now[4:], asked.push_duration / _PUSH_STEPS
    free = ca.DM(asked.push) - ca.cross(rate, inertia @ rate)
    change = ca.vertcat(0.5 * _product(now[:4], ca.vertcat(0.0, rate)), ca.inv(inertia) @ free)
    slope = ca.Function("slope", [now, inertia], [change])
    state = ca.SX(ca.vertcat(ca.DM(asked.attitude), ca.DM(asked.rate)))
    for _ in range(_PUSH_STEPS if step > 0.0 else 0):
        k1 = slope(state, inertia)
        k2 = slope(state + step / 2.0 * k1, inertia)
        k3 = slope(state + step / 2.0 * k2, inertia)
        k4 = slope(state + step * k3, inertia)
        state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return ca.Function("after_push", [inertia], [state[:4], state[4:]])


def _missed(shape: Shape) -> ca.Function:
    """Violation of the end's conditions, which must be zero.

    That is the tilt about the axes that the wheels reach, or all of the turn that is left.
    Inputs: attitude (4, 1) and the `final` one, `up` in B then (3, 1), and what is `_righted`.
    """
    attitude, final = ca.SX.sym("attitude", 4), ca.SX.sym("final", 4)
    up, righted = ca.SX.sym("up", 3), ca.SX.sym("righted", shape.axes_of_tilt, 3)
    if shape.end == End.ATTITUDE and not shape.on_edge:
        missed = _product(_back(final), attitude)[1:]
    else:
        missed = righted @ (_turned(_back(attitude), ca.SX([0.0, 0.0, 1.0])) - up)
    return ca.Function("missed", [attitude, final, up, righted], [missed])


def _righted(asked: Boundary, gyrostat: Gyrostat) -> FloatArray:
    """Directions in B along which the vertical must be where it is asked for, shape (k, 3)."""
    up = asked.final_vertical
    if gyrostat.edge is not None:
        return np.cross(gyrostat.edge, up)[None]
    # A turn about pitch moves the vertical along the first, one about roll along the second.
    along_pitch, lateral = np.cross([0.0, 1.0, 0.0], up), np.array([0.0, 1.0, 0.0])
    return np.array([lateral, along_pitch])[gyrostat.reach[:2]]


def _turned(attitude: ca.SX, vector: ca.SX) -> ca.SX:
    """A vector of B in the world, (3, 1)."""
    along, across = attitude[0], attitude[1:]
    twice = 2.0 * ca.cross(across, vector)
    return vector + along * twice + ca.cross(across, twice)


def _product(a: ca.SX, b: ca.SX) -> ca.SX:
    """The turn `b`, seen in B, after the turn `a`, (4, 1)."""
    scalar = a[0] * b[0] - ca.dot(a[1:], b[1:])
    return ca.vertcat(scalar, a[0] * b[1:] + b[0] * a[1:] + ca.cross(a[1:], b[1:]))


def _back(attitude: ca.SX) -> ca.SX:
    """The turn back, (4, 1)."""
    return ca.vertcat(attitude[0], -attitude[1:])
