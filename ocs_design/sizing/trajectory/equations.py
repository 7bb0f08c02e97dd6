"""Equations of the trajectory program in symbols: a gyrostat over one interval, its start and end.

Momentum is conserved in free flight. With its value H_0 in the world, an attitude R and wheel
speeds W determine everything else:

    I w = R^T H_0 - h A W
    ((h + a) 1 - h^2 A^T I^-1 A) W_dot = tau + h A^T I^-1 (w x R^T H_0)

So a quaternion and n speeds are the state, for any layout of n wheels (docs/theory.md, The maneuver
as an optimal control problem). About a pivot, gravity changes the momentum about it,
H_0_dot = m g l x e in the world, so it becomes part of the state.
"""

from functools import cache

import casadi as ca
import numpy as np

from ocs_design.requirement.boundary import Boundary
from ocs_design.sizing.trajectory.collocation import (
    BERNSTEIN,
    DEGREE,
    DERIVATIVE,
    ELEVATION,
    SQUARE,
    TORQUE,
    TORQUE_DEGREE,
    WEIGHTS,
    bernstein_product,
)
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

_PUSH_STEPS = 8


@cache
def interval(wheels: int, *, stands: bool) -> ca.Function:
    """One interval of the collocation, to be mapped over all of them; d = `DEGREE`.

    Inputs: `states` at its nodes (4 + n, d + 1), or three rows more, Bernstein coefficients of the
    `torques` (n, 3), its `length` [s], and the plant's `figures`, see `start_of`. Outputs: defects
    of the equations of motion at the Radau points times the length, of the attitude (4, d) and of
    the wheels' (n, d) [N m s]; Bernstein coefficients of the wheels' `speeds` (n, d + 1) and of the
    torques in the same degree; the trunk's `rates` at its end (3, 1); `effort`, the integral of all
    squared torques; `swept`, the angle about `axis` [rad]; Bernstein coefficients of the `power` of
    all motors (1, 2 d + 1), with `copper`, the heat over a squared torque [W/(N m)^2], times the
    gear's efficiency [W]; `swinging`, the defect of the momentum about a pivot (3, d) [N m s].
    """
    states = ca.SX.sym("states", 4 + wheels + 3 * stands, DEGREE + 1)
    torques = ca.SX.sym("torques", wheels, TORQUE_DEGREE + 1)
    length = ca.SX.sym("length")
    inverse, coupling = ca.SX.sym("inverse", 3, 3), ca.SX.sym("held", 3, wheels)
    driven_inertia, momentum = ca.SX.sym("driven"), ca.SX.sym("momentum", 3)
    axis, copper, gravity_moment = ca.SX.sym("axis", 3), ca.SX.sym("copper"), ca.SX.sym("pull", 3)
    mobility = coupling.T @ inverse
    mass = driven_inertia * ca.SX.eye(wheels) - mobility @ coupling
    slopes, values = states @ DERIVATIVE.T, torques @ TORQUE.T
    turning, driving, rates, swinging = [], [], [], []
    speeds, elevated = states[4 : 4 + wheels, :] @ BERNSTEIN.T, torques @ ELEVATION.T
    power = _product_of_coefficients(elevated, copper * elevated + speeds)
    for j in range(DEGREE):
        attitude, speed = states[:4, j + 1], states[4 : 4 + wheels, j + 1]
        momentum_now = states[4 + wheels :, j + 1] if stands else momentum
        momentum_in_trunk = _rotated(_inverse(attitude), momentum_now)
        rate = inverse @ (momentum_in_trunk - coupling @ speed)
        change = 0.5 * _product(attitude, ca.vertcat(0.0, rate))
        torque = values[:, j] + mobility @ ca.cross(rate, momentum_in_trunk)
        if stands:
            gravity = ca.cross(ca.SX([0.0, 0.0, 1.0]), _rotated(attitude, gravity_moment))
            torque -= mobility @ _rotated(_inverse(attitude), gravity)
            swinging.append(slopes[4 + wheels :, j] - gravity * length)
        turning.append(slopes[:4, j] - change * length)
        driving.append(mass @ slopes[4 : 4 + wheels, j] - torque * length)
        rates.append(rate)
    inputs = {
        "states": states,
        "torques": torques,
        "length": length,
        "figures": ca.veccat(
            inverse, coupling, driven_inertia, momentum, axis, copper, gravity_moment
        ),
    }
    outputs = {
        "turning": ca.horzcat(*turning),
        "driving": ca.horzcat(*driving),
        "speeds": speeds,
        "elevated": elevated,
        "rates": rates[-1],
        "effort": ca.trace(torques @ SQUARE @ torques.T) * length,
        "swept": axis.T @ ca.horzcat(*rates) @ WEIGHTS * length,
        "power": power,
        "swinging": ca.horzcat(*swinging),
    }
    inputs_and_outputs = list(inputs.values()), list(outputs.values())
    return ca.Function("interval", *inputs_and_outputs, list(inputs), list(outputs))


@cache
def remaining_power(wheels: int) -> ca.Function:
    """Bernstein coefficients of the remaining wheels' power in one interval [W], (1, 2 d + 1).

    Inputs: Bernstein coefficients of speeds and torques planned for all wheels, (n, d + 1) each;
    the matrix that shares the torques among the wheels left, (n, n); the addition to speeds shared
    by the same matrix, (n, 1); `copper`.
    """
    speeds = ca.SX.sym("speeds", wheels, DEGREE + 1)
    torques = ca.SX.sym("torques", wheels, DEGREE + 1)
    shared, added = ca.SX.sym("shared", wheels, wheels), ca.SX.sym("added", wheels)
    copper, torques_left = ca.SX.sym("copper"), shared @ torques
    voltages = copper * torques_left + shared @ speeds + ca.repmat(added, 1, DEGREE + 1)
    power = _product_of_coefficients(torques_left, voltages)
    return ca.Function("left", [speeds, torques, shared, added, copper], [power])


def _product_of_coefficients(a: ca.SX, b: ca.SX) -> ca.SX:
    """Bernstein coefficients of a product, summed over its rows, (1, 2 d + 1)."""
    return ca.horzcat(
        *(
            sum(share * ca.dot(a[:, i], b[:, k - i]) for i, share in row)
            for k, row in enumerate(bernstein_product(DEGREE))
        )
    )


def start_of(boundary: Boundary, gyrostat: Gyrostat) -> ca.Function:
    """Function from a plant to its attitude at the start, and its figures in one column.

    They are I^-1 (about an edge, restricted to it), h A, h + a and the momentum in the world.
    """
    wheels = gyrostat.axes.shape[1]
    inertia, axes = ca.SX.sym("inertia", 3, 3), ca.SX.sym("axes", 3, wheels)
    spin_inertia, armature = ca.SX.sym("spin_inertia"), ca.SX.sym("armature")
    attitude, rate = after_push(boundary)(inertia)
    coupling = spin_inertia * axes
    speed = np.broadcast_to(np.asarray(boundary.wheel_speed), (wheels,))
    momentum = _rotated(attitude, inertia @ rate + coupling @ ca.DM(speed))
    inverse = ca.inv(inertia)
    if gyrostat.edge is not None:
        edge = ca.DM(gyrostat.edge)
        inverse = edge @ edge.T / (edge.T @ inertia @ edge)
    figures = ca.veccat(inverse, coupling, spin_inertia + armature, momentum)
    return ca.Function("start", [inertia, axes, spin_inertia, armature], [attitude, figures])


def after_push(boundary: Boundary) -> ca.Function:
    """Attitude (4, 1) and rate [rad/s] (3, 1) at the start of the turn for an inertia I_tot (3, 3).

    The torque of a push is constant in B while it turns robot and device as one rigid body: Euler's
    equation by classical Runge-Kutta steps.
    """
    inertia, state_now = ca.SX.sym("inertia", 3, 3), ca.SX.sym("now", 7)
    rate, step = state_now[4:], boundary.push.duration / _PUSH_STEPS
    torque = ca.DM(boundary.push.torque) - ca.cross(rate, inertia @ rate)
    change = ca.vertcat(
        0.5 * _product(state_now[:4], ca.vertcat(0.0, rate)), ca.inv(inertia) @ torque
    )
    slope = ca.Function("slope", [state_now, inertia], [change])
    state = ca.SX(ca.vertcat(ca.DM(boundary.attitude), ca.DM(boundary.rate)))
    for _ in range(_PUSH_STEPS if step > 0.0 else 0):
        k1 = slope(state, inertia)
        k2 = slope(state + step / 2.0 * k1, inertia)
        k3 = slope(state + step / 2.0 * k2, inertia)
        k4 = slope(state + step * k3, inertia)
        state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return ca.Function("after_push", [inertia], [state[:4], state[4:]])


def end_violation(axes_of_tilt: int, *, whole: bool) -> ca.Function:
    """Violation of the final conditions, which must be zero.

    This is the remaining tilt about k axes that the wheels control, or the `whole` remaining turn.
    Inputs: attitude (4, 1) and the `final` one, the final direction `up` in B (3, 1), and the
    directions in B along which the vertical must match it (k, 3).
    """
    attitude, final = ca.SX.sym("attitude", 4), ca.SX.sym("final", 4)
    up, righted = ca.SX.sym("up", 3), ca.SX.sym("righted", axes_of_tilt, 3)
    if whole:
        remaining = _product(_inverse(final), attitude)[1:]
    else:
        remaining = righted @ (_rotated(_inverse(attitude), ca.SX([0.0, 0.0, 1.0])) - up)
    return ca.Function("missed", [attitude, final, up, righted], [remaining])


def _rotated(attitude: ca.SX, vector: ca.SX) -> ca.SX:
    """A vector of B in the world, (3, 1)."""
    along, across = attitude[0], attitude[1:]
    twice = 2.0 * ca.cross(across, vector)
    return vector + along * twice + ca.cross(across, twice)


def _product(a: ca.SX, b: ca.SX) -> ca.SX:
    """The rotation `b`, expressed in B, after the rotation `a`, (4, 1)."""
    scalar = a[0] * b[0] - ca.dot(a[1:], b[1:])
    return ca.vertcat(scalar, a[0] * b[1:] + b[0] * a[1:] + ca.cross(a[1:], b[1:]))


def _inverse(attitude: ca.SX) -> ca.SX:
    """The inverse rotation, (4, 1)."""
    return ca.vertcat(attitude[0], -attitude[1:])
