"""From a sizing or a selected drive to the device, against the closed forms of its physics."""

from dataclasses import replace

import numpy as np
import pytest
from driven_wheels import EC45, STEEL

from ocs_design.actuation.motor import DIRECT, Gear
from ocs_design.parts.solids import Carrier
from ocs_design.sizing.assembly import assemble_driven
from ocs_design.sizing.motion import DrivenWheel

CARRIER = Carrier(mass=0.2, axial_inertia=6e-5, transverse_inertia=4e-5)
CENTERS = np.array([[0.0, 0.05, 0.06], [0.0, -0.05, 0.06]])
BELT = Gear("belt 0.5", 0.5, 0.95, 0.02, 3e-6, np.inf, 900.0, 2.0, reverses=False, source="test")
SPUR = replace(BELT, name="spur 3", ratio=3.0, reverses=True)


def device(gear=DIRECT, motor=EC45):
    wheel = DrivenWheel(0.022, 0.03, 0.01, STEEL, motor, gear, bus_voltage=24.0)
    return assemble_driven(wheel, CARRIER, np.radians(40.0), CENTERS)


def test_the_worked_example_of_the_theory():
    """docs/theory.md: 24 V, k_t 0.0369, R 0.608 give w_0 650.4 rad/s and tau_s 1.4566 N m."""
    motor = device().motor
    assert motor.no_load_speed == pytest.approx(650.4, abs=0.05)
    assert motor.stall_torque == pytest.approx(1.4566, abs=5e-5)
    assert (motor.torque_limit, motor.speed_max) == (1.0, pytest.approx(EC45.speed_max))
    assert (motor.mass, motor.gear, motor.bus_voltage) == (EC45.mass, "direct", 24.0)
    assert (motor.armature, motor.rotor_inertia) == (0.0, EC45.rotor_inertia)


@pytest.mark.parametrize("gear", [DIRECT, BELT, SPUR])
def test_spin_inertia_and_armature_add_up_to_what_the_motor_accelerates(gear):
    """I_m = I_rim + N^2 J_r + J_gear, whatever the sense of the gear."""
    found, J, N = device(gear), EC45.rotor_inertia, gear.ratio
    rim = np.pi * STEEL.density * 0.01 * (0.03**4 - 0.022**4) / 2.0
    sense = -1.0 if gear.reverses else 1.0
    assert found.flywheel.spin_inertia == pytest.approx(rim + sense * N * J, rel=1e-12)
    moved = found.flywheel.spin_inertia + found.motor.armature
    assert moved == pytest.approx(rim + N**2 * J + gear.inertia, rel=1e-12)


@pytest.mark.parametrize("gear", [DIRECT, BELT, SPUR])
def test_power_is_lost_in_the_gear_and_nowhere_else(gear):
    """tau_s w_0 = eta V^2 / R: a gear changes torque for speed."""
    motor = device(gear).motor
    product = motor.stall_torque * motor.no_load_speed
    assert product == pytest.approx(gear.efficiency * 24.0**2 / EC45.resistance, rel=1e-12)
    rated = gear.ratio * gear.efficiency * EC45.continuous_torque
    assert motor.continuous_torque == pytest.approx(rated, rel=1e-12)
    assert (motor.gear, motor.gear_ratio) == (gear.name, gear.ratio)
    assert (motor.gear_efficiency, motor.gear_mass) == (gear.efficiency, gear.mass)


def test_the_weaker_of_motor_and_gear_is_the_limit():
    weak = device(replace(SPUR, torque_max=0.7)).motor
    assert weak.torque_limit == 0.7
    assert device(SPUR).motor.torque_limit == pytest.approx(min(3.0 * 0.95 * 1.0, 2.0))
    assert device(BELT).motor.speed_max == 900.0


def test_the_device_weighs_rims_and_carriers():
    found = device()
    rim = np.pi * STEEL.density * 0.01 * (0.03**2 - 0.022**2)
    assert found.mass == pytest.approx(2.0 * (rim + 0.2), rel=1e-12)
    assert found.carrier == CARRIER
    np.testing.assert_array_equal([module.position for module in found.modules], CENTERS)


def test_the_rim_is_stressed_at_the_highest_speed_that_the_drive_reaches():
    """Shigley, at the no-load speed, or at the mechanical limit where that is lower."""
    for gear, speed in ((DIRECT, 24.0 / 0.0369), (BELT, 900.0)):
        stretch = (3.0 + 0.29) * 0.03**2 + (1.0 - 0.29) * 0.022**2
        expected = STEEL.density * speed**2 / 4.0 * stretch
        assert device(gear).flywheel.hoop_stress == pytest.approx(expected, rel=1e-12)


def test_what_a_source_does_not_give_is_not_made_up():
    found = device(motor=replace(EC45, rotor_inertia=None, continuous_torque=None)).motor
    assert (found.rotor_inertia, found.armature) == (0.0, 0.0)
    assert found.continuous_torque is None
