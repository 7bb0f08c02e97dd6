"""Conventions in which data sheets state torque constants and resistances, and the one used here.

`Motor` has what a six-step drive sees: torque per current through two lines and the resistance
between two lines, so that `V = R i + k_t w` holds with the voltage of the supply.

A motor's back-EMF has the amplitude E between a line and the star point. Driven by sines of
amplitude I it takes the power 3/2 E I. Of a supply V, sines reach sqrt(3) E = V between two lines
(space-vector modulation), so that its no-load speed is Kv V with `1 / Kv = sqrt(3) E / w`. As one
direct current i through two lines, the same power, torque and heat come to

    k_t = sqrt(3) E / w = 1 / Kv        3/2 E I = k_t w i, so i = sqrt(3)/2 I
    3/2 R_phase I^2 = R i^2,            so R = 2 R_phase

The conventions of k_t differ by these factors of the current alone; the torque is the same.
"""

import math
from enum import StrEnum


class TorqueConstantConvention(StrEnum):
    """Which current the stated torque constant is per."""

    SIX_STEP = "six-step"
    """Through two lines, or of the supply at full voltage: `k_t = 30 / (pi Kv)`, 9.549/Kv."""
    FOC = "foc"
    """Amplitude of a phase's sine, as field-oriented drives count it: 8.270/Kv."""
    FOC_RMS = "foc-rms"
    """Root mean square of a phase's sine: 11.695/Kv."""


class ResistanceConvention(StrEnum):
    """Between which points the resistance is stated."""

    LINE_LINE = "line-line"
    PHASE = "phase"
    """From a line to the star point."""


_PER_SIX_STEP = {
    TorqueConstantConvention.SIX_STEP: 1.0,
    TorqueConstantConvention.FOC: math.sqrt(3.0) / 2.0,
    TorqueConstantConvention.FOC_RMS: math.sqrt(1.5),
}


def six_step_torque_constant(stated: float, convention: TorqueConstantConvention) -> float:
    """k_t of `Motor` [N m/A] from one in that convention; see the module's text."""
    return stated / _PER_SIX_STEP[convention]


def six_step_current(stated: float, convention: TorqueConstantConvention) -> float:
    """Current of `Motor` [A] of the same torque; that of the supply at full voltage."""
    return stated * _PER_SIX_STEP[convention]


def line_to_line_resistance(stated: float, between: ResistanceConvention) -> float:
    """R of `Motor` [ohm]: two phases in series."""
    return 2.0 * stated if between is ResistanceConvention.PHASE else stated
