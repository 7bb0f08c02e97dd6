"""One interval of the collocation as a CasADi function, to be mapped over all of them."""

import casadi as ca

from ocs_design.sizing.optimal_control.collocation import DEGREE, TORQUE_DEGREE, Collocation
from ocs_design.sizing.optimal_control.plant import Plant
from ocs_design.sizing.optimal_control.units import Units

STATES = 8
"""Vertical (3), rate (3), wheel speeds (2)."""


def interval_function(polynomials: Collocation, units: Units) -> ca.Function:
    """Defects, limits and integrals of one interval.

    Inputs: `states` at its nodes (8, n + 1) and Bernstein coefficients of the `torques` (2, 3), in
    `units`, its `length` in time units, the packed `plant`. Outputs: `defects` of the equations of
    motion at the Radau points; Bernstein coefficients of the wheels' `speeds` (2, n + 1) and of the
    `torques` in the same degree; `effort`, the integral of both torques' squares; `swept`, the
    trunk's rate integrated (3, 1).
    """
    states = ca.SX.sym("states", STATES, DEGREE + 1)
    torques = ca.SX.sym("torques", 2, TORQUE_DEGREE + 1)
    length = ca.SX.sym("length")
    plant = Plant.symbols()
    slopes = states @ polynomials.derivative.T
    values = torques @ polynomials.torque.T
    defects = [
        _defect(plant, units, states[:, j + 1], slopes[:, j] / length, values[:, j]) * length
        for j in range(DEGREE)
    ]
    effort = ca.trace(torques @ polynomials.square @ torques.T) * length
    return ca.Function(
        "interval",
        [states, torques, length, plant.packed()],
        [
            ca.vertcat(*defects),
            states[6:, :] @ polynomials.bernstein.T,
            torques @ polynomials.elevation.T,
            effort,
            states[3:6, 1:] @ polynomials.weights * length * (units.rate * units.time),
        ],
        ["states", "torques", "length", "plant"],
        ["defects", "speeds", "elevated", "effort", "swept"],
    )


def _defect(plant: Plant, units: Units, state: ca.SX, slope: ca.SX, torque: ca.SX) -> ca.SX:
    """What the equations of motion leave at one point, per time unit; see `Gyrostat`."""
    vertical, rate, speed = _physical(units, state)
    turning, trunk, wheels = (part / units.time for part in _physical(units, slope))
    momentum = plant.momentum(rate, speed)
    gained = plant.momentum(trunk, wheels) + ca.cross(rate, momentum)
    driven = plant.wheel_momentum(trunk, wheels) - torque * units.torque
    return ca.vertcat(
        (turning + ca.cross(rate, vertical)) * units.time,
        gained * (units.time / (units.inertia * units.rate)),
        driven / units.torque,
    )


def _physical(units: Units, state: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Vertical, rate [rad/s] and wheel speeds [rad/s] of a state in units."""
    return state[:3], state[3:6] * units.rate, state[6:] * units.speed
