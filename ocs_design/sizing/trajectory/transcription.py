"""Transcription of one turn by direct collocation: its numbers, variables and constraints.

Turns of one structure differ only in their numbers, so their program is derived once.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from ocs_design.actuation.drive import DriveLine
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.boundary import Boundary, End
from ocs_design.sizing.trajectory.collocation import DEGREE, TORQUE_DEGREE
from ocs_design.sizing.trajectory.equations import (
    after_push,
    end_violation,
    interval,
    remaining_power,
    start_of,
)
from ocs_design.sizing.trajectory.gyrostat import Gyrostat, shared_by_others
from ocs_design.sizing.trajectory.motion import FixedAxisTurn, Motion

WINDING = 0.5
"""Largest difference of the integrated rate about the maneuver's axis from its angle [rad].

It keeps the solver from omitting a full revolution; the final attitude is enforced exactly.
"""


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
class Phase:
    """One maneuver in the program.

    Attributes:
        boundary: its boundary value problem.
        gyrostat: robot and device at the start of the search, at the maneuver's incidence.
        plant: the same as a function of the dimensions, (m, 1); None: fixed.
        guess: initial guess; None: a turn about a fixed axis.
        one_stops: whether the supply must also suffice for the other wheels after any one drive has
            stopped at the start or halfway.
    """

    boundary: Boundary
    gyrostat: Gyrostat
    plant: Callable[[ca.MX], Plant] | None = None
    guess: Motion | None = None
    one_stops: bool = False

    @cached_property
    def outline(self) -> FixedAxisTurn:
        """The turn about a fixed axis that starts like the maneuver."""
        start = after_push(self.boundary)(self.gyrostat.inertia)
        return FixedAxisTurn.of(self.boundary, *(np.asarray(part).ravel() for part in start))


class ProgramStructure(NamedTuple):
    """Properties of a turn that determine the equations of its program.

    Attributes:
        wheels, intervals: their numbers. end: see `Boundary`.
        stands, on_edge: whether it turns about a pivot, about an edge.
        axes_at_rest, axes_of_tilt: number of axes at rest at the end, and of those whose tilt is
            fixed.
        guessed: whether it has its own initial guess instead of a turn about a fixed axis.
        torque_limited, speed_limited, back_emf, power_limited: limits that apply.
        one_stops: whether the power is also limited after any one drive has stopped.
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
    one_stops: bool

    @classmethod
    def of(cls, turn: Phase, line: DriveLine, guess: Motion) -> "ProgramStructure":
        """Structure of the program of a turn on the intervals of a guess."""
        gyrostat = turn.gyrostat
        back_emf = isfinite(float(line.stall_torque))
        return cls(
            wheels=len(guess.torques),
            intervals=len(guess.lengths),
            end=turn.boundary.end,
            stands=gyrostat.stands,
            on_edge=gyrostat.edge is not None,
            axes_at_rest=len(gyrostat.controlled_axes),
            axes_of_tilt=len(_tilt_directions(turn.boundary, gyrostat)),
            guessed=turn.guess is not None,
            torque_limited=isfinite(float(line.torque_limit)),
            speed_limited=not back_emf or float(line.speed_max) < float(line.no_load_speed),
            back_emf=back_emf,
            power_limited=isfinite(float(line.power_max)),
            one_stops=turn.one_stops and isfinite(float(line.power_max)),
        )


def numbers_of(turn: Phase, plant: Plant, line: DriveLine, guess: Motion) -> dict[str, ca.MX]:
    """All numbers of a turn's equations, by name."""
    boundary, outline, gyrostat = turn.boundary, turn.outline, turn.gyrostat
    wheels = len(guess.torques)
    # Scaled to be around one: speeds by the no-load speed; torques by the current limit, else by
    # the stall torque, else by the turn's demand.
    angle, initial_rate, time = abs(outline.angle), abs(outline.rate), outline.duration
    peak = (6.0 * angle / time + 4.0 * initial_rate) / time
    demand = peak * float(np.linalg.eigvalsh(gyrostat.inertia)[-1])
    limits = (float(line.torque_limit), float(line.stall_torque), demand)
    torque_unit, speed_unit = next(filter(isfinite, limits)), float(line.no_load_speed)
    weight = float(np.linalg.norm(gyrostat.gravity_moment)) * boundary.duration
    scale = np.concatenate([np.ones(4), np.full(wheels, speed_unit), np.full(3, weight)])
    attitude, figures = start_of(boundary, gyrostat)(*plant)
    slope = 1.0 / float(line.stall_torque)
    constants = ca.vertcat(outline.axis, slope * speed_unit, gyrostat.gravity_moment)
    numbers: dict[str, Any] = {
        "scale": scale[: len(guess.states)],
        "torque_unit": torque_unit,
        "speed_unit": speed_unit,
        "lengths": guess.lengths,
        "duration": boundary.duration,
        "attitude": attitude,
        "speed": np.broadcast_to(np.asarray(boundary.wheel_speed) / speed_unit, (wheels,)),
        "figures": ca.vertcat(figures, constants),
        "momentum": figures[-3:] / weight if gyrostat.stands else 0.0,
        "at_rest": gyrostat.controlled_axes.T,
        # A trunk that need not turn has no rate to scale by.
        "rate_unit": max(1.5 * angle / time, initial_rate) or 1.0 / time,
        "final": boundary.final_attitude,
        "up": boundary.final_vertical,
        "righted": _tilt_directions(boundary, gyrostat),
        "angle": outline.angle,
        "slope": slope * torque_unit if isfinite(float(line.stall_torque)) else 0.0,
        "torque_most": line.torque_limit / torque_unit if isfinite(line.torque_limit) else 0.0,
        "speed_most": min(float(line.speed_max) / speed_unit, 1.0),
        "power_most": wheels * line.power_max if isfinite(line.power_max) else 0.0,
        "copper": slope * speed_unit,
    }
    if turn.one_stops:
        for wheel in range(wheels):
            numbers[f"shared {wheel}"] = shared_by_others(gyrostat.axes, wheel)
    return {
        name: ca.MX(ca.DM(number)) if not isinstance(number, ca.MX) else number
        for name, number in numbers.items()
    }


@dataclass(frozen=True, eq=False)
class Variables:
    """Variables of one turn in its program, and its objectives.

    Attributes:
        states, torques: scaled by their units.
        turned: angle at the end of each interval [rad], (1, k).
        scaled_states, scaled_torques: as in `Motion`.
        effort: mean over time of all squared torques, relative to the square of the largest
            allowed.
        peak: peak power relative to the limit; None: not limited.
    """

    states: ca.MX
    torques: ca.MX
    turned: ca.MX
    scaled_states: ca.MX
    scaled_torques: ca.MX
    effort: ca.MX
    peak: ca.MX | None

    def set_initial_guess(
        self, program: ca.Opti, turn: Phase, guess: Motion, numbers: Mapping[str, ca.MX | ca.DM]
    ) -> None:
        """Set the initial guess of the search."""
        scale, torque_unit = (
            np.asarray(ca.evalf(numbers[name])) for name in ("scale", "torque_unit")
        )
        shares = guess.lengths / guess.lengths.sum()
        program.set_initial(self.states, guess.states / scale)
        program.set_initial(self.torques, guess.torques / torque_unit)
        program.set_initial(self.turned, turn.outline.angle * np.cumsum(shares))
        if self.peak is not None:
            program.set_initial(self.peak, 1.0)


def transcribe(
    program: ca.Opti, structure: ProgramStructure, numbers: Mapping[str, ca.MX]
) -> Variables:
    """One turn by direct collocation on its intervals."""
    wheels, count = structure.wheels, structure.intervals
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
    mapped = interval(wheels, stands=structure.stands).map(count)(
        states=ca.horzcat(*(scaled[:, k * DEGREE : (k + 1) * DEGREE + 1] for k in range(count))),
        torques=torques * torque_unit,
        length=numbers["lengths"].T,
        figures=ca.repmat(numbers["figures"], 1, count),
    )
    for defect, unit in (("turning", 1.0), ("driving", torque_unit * duration)):
        program.subject_to(ca.vec(mapped[defect]) / unit == 0.0)
    program.subject_to(states[: 4 + wheels, 0] == ca.vertcat(attitude, numbers["speed"]))
    if structure.stands:
        program.subject_to(states[4 + wheels :, 0] == numbers["momentum"])
        program.subject_to(ca.vec(mapped["swinging"]) / scale[-1] == 0.0)
    for k in range(structure.axes_at_rest):
        program.subject_to(numbers["at_rest"][:, k].T @ mapped["rates"][:, -1] / rate_unit == 0.0)
    if structure.end != End.AT_REST:
        full_turn = structure.end == End.ATTITUDE and not structure.on_edge
        ending = numbers["final"], numbers["up"], numbers["righted"]
        program.subject_to(
            end_violation(structure.axes_of_tilt, whole=full_turn)(states[:4, -1], *ending) == 0.0
        )
    # Accumulated step by step: a single sum would be a dense row, which slows down Jacobians.
    program.subject_to(turned == ca.horzcat(ca.MX(0.0), turned[:-1]) + mapped["swept"])
    if not structure.guessed and structure.end != End.AT_REST:
        program.subject_to(program.bounded(-WINDING, turned[-1] - numbers["angle"], WINDING))

    # Limits on Bernstein coefficients hold between the nodes too.
    speeds, elevated = ca.vec(mapped["speeds"]) / speed_unit, ca.vec(mapped["elevated"])
    if structure.torque_limited:
        largest = numbers["torque_most"]
        program.subject_to(program.bounded(-largest, ca.vec(torques), largest))
    if structure.back_emf:
        slope = numbers["slope"] / torque_unit
        program.subject_to(program.bounded(-1.0, speeds + slope * elevated, 1.0))
    if structure.speed_limited:
        highest = numbers["speed_most"]
        program.subject_to(program.bounded(-highest, speeds, highest))
    peak = None
    if structure.power_limited:
        peak, power = program.variable(), ca.vec(mapped["power"]) / numbers["power_most"]
        program.subject_to(program.bounded(0.0, peak, 1.0))
        if structure.one_stops:
            after_failure = _powers_after_failure(structure, numbers, mapped, scaled)
            power = ca.vertcat(power, after_failure / numbers["power_most"])
        program.subject_to(power - peak <= 0.0)
        program.subject_to(power + peak >= 0.0)
    effort = ca.sum(mapped["effort"]) / (torque_unit**2 * duration)
    return Variables(states, torques, turned, scaled, torques * torque_unit, effort, peak)


def _powers_after_failure(
    structure: ProgramStructure,
    numbers: Mapping[str, ca.MX],
    mapped: Mapping[str, ca.MX],
    scaled: ca.MX,
) -> ca.MX:
    """Bernstein coefficients of the power after any one drive has stopped [W], a column.

    The other motors then give `S tau`, see `shared_by_others`, and a wheel whose drive stopped at
    the time t_k leaves them at the speeds `S W + (1 - S) W(t_k)`. That is linear in the speed that
    it keeps, so the extremes count: for a turn from rest to rest these are at the start, with none,
    and halfway.
    """
    wheels, count, powers = structure.wheels, structure.intervals, []
    by_interval = remaining_power(wheels)
    for wheel in range(wheels):
        shared = numbers[f"shared {wheel}"]
        for interval_of_failure in (0, count // 2):
            speed, intervals_left = (
                scaled[4 : 4 + wheels, interval_of_failure * DEGREE],
                count - interval_of_failure,
            )
            columns = slice(interval_of_failure * (DEGREE + 1), None)
            power = by_interval.map(intervals_left)(
                mapped["speeds"][:, columns],
                mapped["elevated"][:, columns],
                ca.repmat(shared, 1, intervals_left),
                ca.repmat(speed - shared @ speed, 1, intervals_left),
                ca.repmat(numbers["copper"], 1, intervals_left),
            )
            powers.append(ca.vec(power))
    return ca.vertcat(*powers)


def _tilt_directions(boundary: Boundary, gyrostat: Gyrostat) -> FloatArray:
    """Directions in B along which the vertical must match the final one, shape (k, 3)."""
    up = boundary.final_vertical
    if gyrostat.edge is not None:
        return np.cross(gyrostat.edge, up)[None]
    # A turn about pitch moves the vertical along the first, one about roll along the second.
    along_pitch, lateral = np.cross([0.0, 1.0, 0.0], up), np.array([0.0, 1.0, 0.0])
    return np.array([lateral, along_pitch])[gyrostat.controlled[:2]]
