"""The trajectory program: maneuvers of one robot, and the device's dimensions if they are free.

Momentum is conserved in free flight. With its value H_0 in the world, an attitude R and wheel
speeds W tell everything else:

    I w = R^T H_0 - h A W
    ((h + a) 1 - h^2 A^T I^-1 A) W_dot = tau + h A^T I^-1 (w x R^T H_0)

so that a quaternion and n speeds are the state, for any layout of n wheels (docs/theory.md, The
maneuver as an optimal control problem). About a pivot gravity changes the momentum about it,
H_0_dot = m g l x e in the world, and it is part of the state.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite
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
    program = ca.Opti()
    free, objective, weight = ca.MX(0, 1), ca.MX(0.0), 1.0
    if dimensions is not None:
        free = program.variable(len(dimensions.start))
        program.set_initial(free, dimensions.start)
        program.subject_to(program.bounded(dimensions.lower, free, dimensions.upper))
        if dimensions.excess is not None:
            program.subject_to(dimensions.excess(free) <= 0.0)
        objective, weight = dimensions.objective(free), EFFORT_WEIGHT
    found = []
    for turn, guess in zip(turns, guesses, strict=True):
        plant = Plant.of(turn.gyrostat) if turn.plant is None else turn.plant(free)
        *variables, effort, peak = _transcribe(program, turn, plant, line, guess)
        # Without a supply that limits it nothing is known of the power, and effort alone counts.
        objective += weight * effort
        if dimensions is None and peak is not None:
            objective += peak / POWER_EFFORT
        found.append(variables)
    program.minimize(objective)
    options: dict[str, Any] = {
        "ipopt.max_iter": GUESSED_MAX if turns[0].guess else ITERATIONS_MAX,
        "detect_simple_bounds": True,
        # One flat graph is quicker; splines of the dimensions have none.
        "expand": dimensions is None,
    }
    if dimensions is None:
        options |= PLAN_OPTIONS
    if dimensions is None and isfinite(float(line.power_max)):
        # A peak is flat at many instants at once: half the time where the barrier falls steadily.
        options["ipopt.mu_strategy"] = "monotone"
        options["ipopt.mu_linear_decrease_factor"] = 0.1
        options["ipopt.mu_superlinear_decrease_power"] = 1.6
    program.solver("ipopt", IPOPT_OPTIONS | options)
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
            Motion(guess.lengths, *(np.array(value(each), ndmin=2) for each in variables))
            for guess, variables in zip(guesses, found, strict=True)
        ),
        dimensions=np.array(value(free), ndmin=1),
        solved=bool(stats["success"]),
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        violation=float(np.max(excess, initial=0.0)),
        cost=float(value(program.f)),
    )


def _transcribe(
    program: ca.Opti, turn: Turn, plant: Plant, line: DriveLine, guess: Motion
) -> tuple[ca.MX, ca.MX, ca.MX, ca.MX | None]:
    """One turn by direct collocation on the intervals of a guess.

    Returns:
        States and torques as in `Motion`, the mean over the time of all squared torques over the
        square of the largest, and the peak power over the largest; None: it is not limited.
    """
    asked, outline, wheels = turn.asked, turn.outline, len(guess.torques)
    count, shares = len(guess.lengths), guess.lengths / guess.lengths.sum()
    # Numbers around one: speeds over that without load, torques over the current limit, else over
    # the stall torque, else over what the turn asks for.
    demand = outline.peak_acceleration * float(np.linalg.eigvalsh(turn.gyrostat.inertia)[-1])
    limits = (float(line.torque_limit), float(line.stall_torque), demand)
    torque_unit, speed_unit = next(filter(isfinite, limits)), float(line.no_load_speed)
    gyrostat = turn.gyrostat
    weight = float(np.linalg.norm(gyrostat.pull)) * asked.duration
    scale = np.concatenate([np.ones(4), np.full(wheels, speed_unit), np.full(3, weight)])[:, None]
    scale = scale[: len(guess.states)]
    states = program.variable(len(scale), count * DEGREE + 1)
    torques = program.variable(wheels, count * (TORQUE_DEGREE + 1))
    turned = program.variable(1, count)
    program.set_initial(states, guess.states / scale)
    program.set_initial(torques, guess.torques / torque_unit)
    program.set_initial(turned, outline.angle * np.cumsum(shares))

    attitude, figures = _start(asked, gyrostat)(*plant)
    speed = np.broadcast_to(np.asarray(asked.wheel_speed) / speed_unit, (wheels,))
    slope = 1.0 / float(line.stall_torque)
    copper = slope * float(line.no_load_speed)
    mapped = _interval(gyrostat, outline.axis, copper).map(count)(
        states=ca.DM(scale)
        * ca.horzcat(*(states[:, k * DEGREE : (k + 1) * DEGREE + 1] for k in range(count))),
        torques=torques * torque_unit,
        length=ca.DM(guess.lengths).T,
        figures=ca.repmat(figures, 1, count),
    )
    for defect, unit in (("turning", 1.0), ("driving", torque_unit * asked.duration)):
        program.subject_to(ca.vec(mapped[defect]) / unit == 0.0)
    program.subject_to(states[: 4 + wheels, 0] == ca.vertcat(attitude, speed))
    if gyrostat.stands:
        program.subject_to(states[4 + wheels :, 0] == figures[-3:] / weight)
        program.subject_to(ca.vec(mapped["swinging"]) / weight == 0.0)
    # A trunk that is asked for no turn has no rate to count in.
    rate_unit = outline.peak_rate or 1.0 / asked.duration
    for about in gyrostat.turns_about:
        program.subject_to(ca.DM(about).T @ mapped["rates"][:, -1] / rate_unit == 0.0)
    if asked.end != End.AT_REST:
        program.subject_to(_missed(asked, turn.gyrostat)(states[:4, -1]) == 0.0)
    # Summed up one by one: a single sum would be a dense row, for which Jacobians take long.
    program.subject_to(turned == ca.horzcat(ca.MX(0.0), turned[:-1]) + mapped["swept"])
    if turn.guess is None and asked.end != End.AT_REST:
        program.subject_to(program.bounded(-WINDING, turned[-1] - outline.angle, WINDING))

    # On Bernstein coefficients, so that limits hold between the nodes too.
    speeds, elevated = ca.vec(mapped["speeds"]) / speed_unit, ca.vec(mapped["elevated"])
    highest = float(line.speed_max) / speed_unit
    if isfinite(float(line.torque_limit)):
        largest = float(line.torque_limit) / torque_unit
        program.subject_to(program.bounded(-largest, ca.vec(torques), largest))
    if slope > 0.0:
        program.subject_to(program.bounded(-1.0, speeds + slope * elevated, 1.0))
    if slope == 0.0 or highest < 1.0:
        program.subject_to(program.bounded(-min(highest, 1.0), speeds, min(highest, 1.0)))
    effort = ca.sum(mapped["effort"]) / (torque_unit**2 * asked.duration)
    return (
        ca.DM(scale) * states,
        torques * torque_unit,
        effort,
        _peak(program, mapped, line, wheels),
    )


def _peak(program: ca.Opti, mapped: dict[str, ca.MX], line: DriveLine, wheels: int) -> ca.MX | None:
    """Largest power of all wheels either way over the most that there is; None: not limited."""
    largest = wheels * float(line.power_max)
    if not isfinite(largest):
        return None
    peak, power = program.variable(), ca.vec(mapped["power"]) / largest
    program.set_initial(peak, 1.0)
    program.subject_to(program.bounded(0.0, peak, 1.0))
    program.subject_to(power - peak <= 0.0)
    program.subject_to(power + peak >= 0.0)
    return peak


def _interval(gyrostat: Gyrostat, axis: FloatArray, copper: float) -> ca.Function:
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
    table, wheels = collocation(), gyrostat.axes.shape[1]
    rows = 4 + wheels + (3 if gyrostat.stands else 0)
    states = ca.SX.sym("states", rows, DEGREE + 1)
    torques = ca.SX.sym("torques", wheels, TORQUE_DEGREE + 1)
    length = ca.SX.sym("length")
    inverse, held = ca.SX.sym("inverse", 3, 3), ca.SX.sym("held", 3, wheels)
    driven, momentum = ca.SX.sym("driven"), ca.SX.sym("momentum", 3)
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
        now = states[4 + wheels :, j + 1] if gyrostat.stands else momentum
        seen = _turned(_back(attitude), now)
        rate = inverse @ (seen - held @ speed)
        change = 0.5 * _product(attitude, ca.vertcat(0.0, rate))
        torque = values[:, j] + mobility @ ca.cross(rate, seen)
        if gyrostat.stands:
            gravity = ca.cross(ca.SX([0.0, 0.0, 1.0]), _turned(attitude, ca.SX(gyrostat.pull)))
            torque -= mobility @ _turned(_back(attitude), gravity)
            swinging.append(slopes[4 + wheels :, j] - gravity * length)
        turning.append(slopes[:4, j] - change * length)
        driving.append(mass @ slopes[4 : 4 + wheels, j] - torque * length)
        rates.append(rate)
    return ca.Function(
        "interval",
        [states, torques, length, ca.veccat(inverse, held, driven, momentum)],
        [
            ca.horzcat(*turning),
            ca.horzcat(*driving),
            speeds,
            elevated,
            rates[-1],
            ca.trace(torques @ table.square @ torques.T) * length,
            ca.DM(axis).T @ ca.horzcat(*rates) @ table.weights * length,
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


def _missed(asked: Boundary, gyrostat: Gyrostat) -> ca.Function:
    """Violation of the end's conditions by an attitude, which must be zero.

    That is the tilt about the axes that the wheels reach, or all of the turn that is left.
    """
    attitude, final = ca.SX.sym("attitude", 4), ca.SX(ca.DM(asked.final_attitude))
    if asked.end == End.ATTITUDE and gyrostat.edge is None:
        return ca.Function("missed", [attitude], [_product(_back(final), attitude)[1:]])
    up = asked.final_vertical
    # A turn about pitch moves the vertical along the first, one about roll along the second.
    along_pitch, lateral = np.cross([0.0, 1.0, 0.0], up), np.array([0.0, 1.0, 0.0])
    directions = np.array([lateral, along_pitch])[gyrostat.reach[:2]]
    if gyrostat.edge is not None:
        directions = np.cross(gyrostat.edge, up)[None]
    tilt = _turned(_back(attitude), ca.SX([0.0, 0.0, 1.0])) - ca.DM(up)
    return ca.Function("missed", [attitude], [ca.DM(directions) @ tilt])


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
