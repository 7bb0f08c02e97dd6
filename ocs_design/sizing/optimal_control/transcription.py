"""One maneuver as a part of a nonlinear program: direct collocation on given intervals."""

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.optimal_control.collocation import DEGREE, collocation
from ocs_design.sizing.optimal_control.interval import interval_function
from ocs_design.sizing.optimal_control.motion import Motion
from ocs_design.sizing.optimal_control.nonlinear_program import Constraint, Unknown
from ocs_design.sizing.optimal_control.plant import Plant
from ocs_design.sizing.optimal_control.push import start_state
from ocs_design.sizing.optimal_control.task import Task
from ocs_design.sizing.optimal_control.units import Limits, Units

WINDING = 0.5
"""How far the integral of the rate about the maneuver's axis may be from its angle [rad].

It keeps the search from leaving out a whole turn; the attitude at the end is asked for exactly.
"""


@dataclass(frozen=True, eq=False)
class Transcription:
    """Variables and constraints of one maneuver.

    Attributes:
        states, torques: unknowns, in units.
        turned: unknown angle about the maneuver's axis at the ends of the intervals [rad].
        constraints: all of them.
        effort: mean of both torques' squares over the time, in units.
        units: of the numbers. shares: of each interval in the whole time, shape (k,).
    """

    states: Unknown
    torques: Unknown
    turned: Unknown
    constraints: tuple[Constraint, ...]
    effort: ca.MX
    units: Units
    shares: FloatArray

    @property
    def unknowns(self) -> tuple[Unknown, Unknown, Unknown]:
        """All of them."""
        return self.states, self.torques, self.turned

    def motion(
        self, states: FloatArray, torques: FloatArray, turned: FloatArray, *, duration: float
    ) -> Motion:
        """Of the values that were found, SI."""
        del turned
        return Motion(
            self.shares * duration,
            states * _state_units(self.units),
            torques * self.units.torque,
        )


def transcribe(task: Task, plant: ca.MX, duration: ca.MX) -> Transcription:
    """Unknowns and constraints of a maneuver.

    Args:
        task: the maneuver.
        plant: packed, see `Plant`.
        duration: in time units.
    """
    guess, units = task.guess, task.units
    count = len(guess.lengths)
    shares = guess.lengths / guess.lengths.sum()
    states = ca.MX.sym("states", *guess.states.shape)
    torques = ca.MX.sym("torques", *guess.torques.shape)
    mapped = interval_function(collocation(), units).map(count)(
        states=ca.horzcat(*(states[:, k * DEGREE : (k + 1) * DEGREE + 1] for k in range(count))),
        torques=torques,
        length=duration * ca.DM(shares).T,
        plant=ca.repmat(plant, 1, count),
    )
    speeds, elevated = mapped["speeds"], mapped["elevated"]
    # Summed up one by one: a single sum would be a dense row, for which Jacobians take long.
    turned = ca.MX.sym("turned", 1, count)
    before = ca.horzcat(ca.MX(0.0), turned[:-1])
    constraints = (
        Constraint(mapped["defects"], 0.0, 0.0),
        Constraint(states[:, 0] - _start(task)(plant), 0.0, 0.0),
        *_end(task, states[:, -1]),
        *_limits(task.limits, speeds, elevated),
        Constraint(turned - before - ca.DM(task.axis).T @ mapped["swept"], 0.0, 0.0),
        Constraint(turned[-1], task.angle - WINDING, task.angle + WINDING),
    )
    return Transcription(
        states=Unknown(states, guess.states / _state_units(units)),
        torques=Unknown(
            torques, guess.torques / units.torque, -task.limits.torque, task.limits.torque
        ),
        turned=Unknown(turned, task.angle * np.cumsum(shares)),
        constraints=constraints,
        effort=ca.sum2(mapped["effort"]) / duration,
        units=units,
        shares=shares,
    )


def _start(task: Task) -> ca.Function:
    """State after the push, in units, as a function of the packed plant."""
    plant = Plant.symbols()
    state = start_state(task.asked, plant) / ca.DM(_state_units(task.units))
    return ca.Function("start", [plant.packed()], [state])


def _end(task: Task, state: ca.MX) -> Sequence[Constraint]:
    """Attitude and rest on the axes that the wheels reach."""
    up = task.asked.final_vertical
    # A turn about pitch moves the vertical along the first, one about roll along the second.
    along_pitch, lateral = np.cross([0.0, 1.0, 0.0], up), np.array([0.0, 1.0, 0.0])
    directions = np.array([lateral, along_pitch])[list(task.reach)]
    attitude = ca.DM(directions) @ (state[:3] - ca.DM(up))
    rate = state[[3 + axis for axis in range(2) if task.reach[axis]]]
    return Constraint(attitude, 0.0, 0.0), Constraint(rate, 0.0, 0.0)


def _limits(limits: Limits, speeds: ca.MX, torques: ca.MX) -> Sequence[Constraint]:
    """Voltage line and highest speed, on Bernstein coefficients; the current limit is a bound."""
    found = []
    if limits.slope > 0.0:
        found.append(Constraint(speeds + limits.slope * torques, -1.0, 1.0))
    if np.isfinite(limits.speed):
        found.append(Constraint(speeds, -limits.speed, limits.speed))
    return found


def _state_units(units: Units) -> FloatArray:
    """Of the eight states as a column, shape (8, 1)."""
    return np.array([1.0] * 3 + [units.rate] * 3 + [units.speed] * 2)[:, None]
