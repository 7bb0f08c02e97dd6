"""What a push leaves: the trunk turns under a torque that stands in B, its wheels held."""

import casadi as ca

from ocs_design.sizing.optimal_control.boundary import Boundary
from ocs_design.sizing.optimal_control.plant import Plant

_STEPS = 4


def start_state(asked: Boundary, plant: Plant) -> ca.SX:
    """Vertical, rate and wheel speeds at the start of the turn, (8, 1).

    The rigid body of robot and device, by classical Runge-Kutta steps through the push.
    """
    state = ca.vertcat(ca.SX(asked.vertical), ca.SX.zeros(3))
    if asked.push_duration > 0.0:
        inertia = plant.inertia_matrix
        inverse, torque = ca.inv(inertia), ca.SX(asked.push)

        def slope(now: ca.SX) -> ca.SX:
            """Rates of change of vertical and rate: Euler's equation."""
            vertical, rate = now[:3], now[3:]
            free = torque - ca.cross(rate, inertia @ rate)
            return ca.vertcat(ca.cross(vertical, rate), inverse @ free)

        step = asked.push_duration / _STEPS
        for _ in range(_STEPS):
            k1 = slope(state)
            k2 = slope(state + step / 2.0 * k1)
            k3 = slope(state + step / 2.0 * k2)
            k4 = slope(state + step * k3)
            state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return ca.vertcat(state, ca.SX.zeros(2))
