"""Conventions of data sheets against the power balance of a sine-driven motor."""

import math

import numpy as np
import pytest

from ocs_design.actuation.motor import (
    ResistanceConvention,
    TorqueConstantConvention,
    line_to_line_resistance,
    six_step_current,
    six_step_torque_constant,
)

PHASES = 2.0 * np.pi * np.arange(3) / 3.0
ANGLES = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)


def test_published_figures_per_kv():
    """9.549/Kv between lines, 8.27/Kv per peak phase ampere (docs/theory.md)."""
    kv = 300.0
    six_step = 1.0 / (kv * math.pi / 30.0)
    assert six_step * kv == pytest.approx(9.549, abs=5e-4)
    for convention, figure in [
        (TorqueConstantConvention.SIX_STEP, 9.549),
        (TorqueConstantConvention.FOC, 8.270),
        (TorqueConstantConvention.FOC_RMS, 11.695),
    ]:
        stated = figure / kv
        assert six_step_torque_constant(stated, convention) == pytest.approx(six_step, rel=1e-4)


def test_power_torque_and_heat_are_those_of_three_sine_phases():
    """Sums over the phases, with no convention in them, at a speed of 100 rad/s."""
    emf, amplitude, phase_resistance, speed = 7.0, 3.0, 0.2, 100.0
    voltages = emf * np.sin(ANGLES[:, None] + PHASES)
    currents = amplitude * np.sin(ANGLES[:, None] + PHASES)
    power = (voltages * currents).sum(axis=1).mean()
    heat = (phase_resistance * currents**2).sum(axis=1).mean()
    largest_line_voltage = np.ptp(voltages[:, :2] @ [[1.0], [-1.0]]) / 2.0
    torque = power / speed

    foc = TorqueConstantConvention.FOC
    k_t = six_step_torque_constant(torque / amplitude, foc)
    current = six_step_current(amplitude, foc)
    resistance = line_to_line_resistance(phase_resistance, ResistanceConvention.PHASE)
    assert k_t * current == pytest.approx(torque, rel=1e-12)
    assert resistance * current**2 == pytest.approx(heat, rel=1e-12)
    assert k_t * speed == pytest.approx(largest_line_voltage, rel=1e-4)


@pytest.mark.parametrize("convention", TorqueConstantConvention)
def test_the_torque_does_not_depend_on_the_convention(convention):
    torque = six_step_torque_constant(0.03, convention) * six_step_current(12.0, convention)
    assert torque == pytest.approx(0.36, rel=1e-14)


def test_root_mean_square_and_amplitude_differ_by_the_root_of_two():
    foc = six_step_current(math.sqrt(2.0), TorqueConstantConvention.FOC)
    assert six_step_current(1.0, TorqueConstantConvention.FOC_RMS) == pytest.approx(foc, rel=1e-14)


def test_resistance_between_lines_stays():
    assert line_to_line_resistance(0.4, ResistanceConvention.LINE_LINE) == 0.4
