"""Currents, heat and energies against closed forms of a wheel on a trunk at rest."""

from dataclasses import replace

import numpy as np
import pytest
from driven_wheels import BELT, EC45, driven_wheel
from scipy.integrate import solve_ivp

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.errors import OcsError
from ocs_design.device.layout import module_axes
from ocs_design.sizing.margins import SampledMotion, bus_power, consumption, winding_current
from ocs_design.sizing.trajectory.gyrostat import Gyrostat


def resting_trunk(time, speed, torque):
    """Motion of two equal wheels on a trunk at rest."""
    still = np.zeros((len(time), 3))
    return SampledMotion(
        time, np.column_stack([speed] * 2), np.column_stack([torque] * 2), still, still
    )


def spin_up(wheel, time_constants, samples=4001):
    """Full voltage from rest: W = w_0 (1 - e^(-t/T)), tau = tau_s e^(-t/T), T = I w_0 / tau_s."""
    line = wheel.line
    constant = (
        (wheel.flywheel.spin_inertia + wheel.drive.armature)
        * line.no_load_speed
        / line.stall_torque
    )
    time = np.linspace(0.0, time_constants * constant, samples)
    decay = np.exp(-time / constant)
    return resting_trunk(time, line.no_load_speed * (1.0 - decay), line.stall_torque * decay)


def kinetic_energy(wheel, motion, index=-1):
    inertia = wheel.flywheel.spin_inertia + wheel.drive.armature
    return 0.5 * inertia * float(np.sum(motion.wheel_speed[index] ** 2))


@pytest.mark.parametrize("gear", [DIRECT, BELT, replace(BELT, reverses=True)])
def test_energy_balance_of_a_spin_up(gear):
    wheel = driven_wheel(gear=gear)
    motion = spin_up(wheel, time_constants=3.0)
    used = consumption(motion, wheel)
    stored = kinetic_energy(wheel, motion)
    assert used.drawn == pytest.approx(used.heat_all + used.gear_loss + stored, rel=1e-6)
    assert used.gear_loss == pytest.approx((1.0 / gear.efficiency - 1.0) * stored, rel=1e-6)


def test_constant_voltage_wastes_as_much_as_it_stores():
    """A law of DC motors: half of the energy drawn up to no-load speed becomes heat."""
    wheel = driven_wheel()
    motion = spin_up(wheel, time_constants=20.0, samples=20001)
    used = consumption(motion, wheel)
    assert used.heat_all == pytest.approx(kinetic_energy(wheel, motion), rel=1e-6)
    assert used.drawn == pytest.approx(2.0 * used.heat_all, rel=1e-6)


@pytest.mark.parametrize("gear", [DIRECT, BELT])
def test_energy_balance_of_spinning_up_and_braking(gear):
    """At rest no energy is stored: all that was drawn and not fed back is lost."""
    wheel = driven_wheel(gear=gear)
    torque = 0.2 * wheel.line.torque_limit
    # Two samples at one time represent the step of the torque.
    time = np.array([0.0, 0.1, 0.1, 0.2])
    speed = (
        torque
        / (wheel.flywheel.spin_inertia + wheel.drive.armature)
        * np.array([0.0, 0.1, 0.1, 0.0])
    )
    motion = resting_trunk(time, speed, torque * np.array([1.0, 1.0, -1.0, -1.0]))
    used = consumption(motion, wheel)
    assert used.fed_back > 0.0
    # Power changes sign within an interval: only the difference of both parts is exact.
    assert used.drawn - used.fed_back == pytest.approx(used.heat_all + used.gear_loss, rel=1e-12)
    assert used.fed_back < kinetic_energy(wheel, motion, index=1)


def test_a_gear_dissipates_when_driving_and_when_braking():
    wheel = driven_wheel(gear=BELT)
    speed, torque = np.array([100.0, 100.0]), np.array([1e-9, -1e-9])
    power = bus_power(resting_trunk(np.array([0.0, 1.0]), speed, torque), wheel)
    assert power == pytest.approx([2e-7 / 0.9, -2e-7 * 0.9], rel=1e-6)


def test_winding_current_behind_a_gear_has_the_sign_of_the_torque():
    wheel = driven_wheel(gear=BELT)
    torque = np.array([0.1, -0.1])
    motion = resting_trunk(np.array([0.0, 1.0]), np.array([5.0, 5.0]), torque)
    assert winding_current(motion, wheel)[:, 0] == pytest.approx(torque / (2.0 * 0.9 * 0.0369))


def test_a_motor_with_missing_data_is_named():
    with pytest.raises(OcsError, match=r"EC 45 flat 70 W.*resistance"):
        driven_wheel(replace(EC45, resistance=None))


@pytest.mark.parametrize("gear", [DIRECT, BELT])
def test_energy_balance_of_a_tumbling_trunk(gear):
    """Full voltage on one wheel, half of it reversed on the other, all axes coupled.

    The motors' mechanical work becomes kinetic energy of trunk and wheels.
    """
    wheel = driven_wheel(gear=gear)
    body = Gyrostat(
        np.array([[0.03, 1e-3, 2e-3], [1e-3, 0.0535, 0.0], [2e-3, 0.0, 0.068]]),
        module_axes(np.radians(30.0)),
        wheel.flywheel.spin_inertia,
        wheel.drive.armature,
    )
    line, voltage = wheel.line, np.array([1.0, -0.5])

    def torque(speed):
        return line.stall_torque * (voltage - speed / line.no_load_speed)

    def change(_, state):
        rate, speed = state[:3], state[3:]
        momentum = body.inertia @ rate + body.spin_inertia * body.axes @ speed
        forces = np.concatenate([-np.cross(rate, momentum), torque(speed)])
        return np.linalg.solve(body.mass_matrix, forces)

    time = np.linspace(0.0, 0.1, 2001)
    solution = solve_ivp(change, (0.0, 0.1), np.zeros(5), "DOP853", time, rtol=1e-12, atol=1e-12)
    speed, rate = solution.y[3:].T, solution.y[:3].T
    motion = SampledMotion(time, speed, torque(speed), rate, np.gradient(rate, time, axis=0))
    used = consumption(motion, wheel)
    final = solution.y[:, -1]
    stored = 0.5 * final @ body.mass_matrix @ final
    drawn = used.drawn - used.fed_back
    assert drawn == pytest.approx(used.heat_all + used.gear_loss + stored, rel=1e-6)
    assert np.linalg.norm(rate[-1]) > 0.5
