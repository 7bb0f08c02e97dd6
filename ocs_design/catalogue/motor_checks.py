"""Whether the figures of a motor's row agree with each other."""

from collections.abc import Iterator

from ocs_design.catalogue.motor_sheet import MotorSheet, rad_s
from ocs_design.drive.conventions import TorqueConstantConvention, six_step_torque_constant

SPEED_CONSTANT_TOLERANCE = 0.05
"""Of k_t times Kv: Kv is printed in round numbers, and 3.8 % occur."""

NO_LOAD_TOLERANCE = 0.05
"""Of the no-load speed: friction and iron losses take up to 3.6 %."""

STALL_TOLERANCE = 0.03
"""Of stall torque and stall current: data sheets compute them, and 2.1 % occur."""

PEAK_TOLERANCE = 0.05
"""By which a peak torque may exceed k_t times the peak current: 2.0 % occur."""


def incomplete(sheet: MotorSheet) -> Iterator[str]:
    """Figures that mean nothing without their convention."""
    if sheet.kt_nm_per_a is not None and sheet.kt_convention is None:
        yield f"kt_nm_per_a needs its kt_convention{_fitting(sheet)}"
    if sheet.resistance_ohm is not None and sheet.resistance_between is None:
        yield "resistance_ohm needs its resistance_between"


def contradictions(sheet: MotorSheet) -> Iterator[str]:
    """Figures that cannot both be right within the tolerances."""
    yield from _torque_against_speed_constant(sheet)
    yield from _no_load(sheet)
    yield from _stall(sheet)
    yield from _peak(sheet)


def _torque_against_speed_constant(sheet: MotorSheet) -> Iterator[str]:
    """k_t = 30 / (pi Kv) in the six-step convention; `drive.conventions` has the others."""
    if sheet.kt_nm_per_a is None or sheet.kt_convention is None or sheet.kv_rpm_per_v is None:
        return
    k_t = six_step_torque_constant(sheet.kt_nm_per_a, sheet.kt_convention)
    if not _close(k_t * rad_s(sheet.kv_rpm_per_v), 1.0, SPEED_CONSTANT_TOLERANCE):
        yield (
            f"k_t Kv is {sheet.kt_nm_per_a * sheet.kv_rpm_per_v:.2f} N m/A rpm/V, which is not "
            f"{sheet.kt_convention}{_fitting(sheet)}"
        )


def _fitting(sheet: MotorSheet) -> str:
    """The conventions in which k_t agrees with Kv."""
    k_t, kv = sheet.kt_nm_per_a, sheet.kv_rpm_per_v
    if k_t is None or kv is None:
        return f": one of {', '.join(TorqueConstantConvention)}"
    fitting = [
        convention
        for convention in TorqueConstantConvention
        if _close(
            six_step_torque_constant(k_t, convention) * rad_s(kv), 1.0, SPEED_CONSTANT_TOLERANCE
        )
    ]
    return f"; it fits {' or '.join(fitting)}" if fitting else "; it fits no convention"


def _no_load(sheet: MotorSheet) -> Iterator[str]:
    """No-load speed is (V - R I_0) / k_t; without I_0, V / k_t."""
    stated, voltage, k_t = sheet.no_load_speed_rpm, sheet.rated_voltage_v, sheet.torque_constant
    if stated is None or voltage is None or k_t is None:
        return
    drop = (sheet.resistance or 0.0) * (sheet.no_load_current_a or 0.0)
    expected = (voltage - drop) / k_t
    if not _close(rad_s(stated), expected, NO_LOAD_TOLERANCE):
        yield (
            f"no-load speed is {stated:.0f} rpm, but V, R and k_t make it "
            f"{expected / rad_s(1.0):.0f} rpm"
        )


def _stall(sheet: MotorSheet) -> Iterator[str]:
    """Stall current is V / R, stall torque k_t times it."""
    voltage, k_t, resistance = sheet.rated_voltage_v, sheet.torque_constant, sheet.resistance
    if voltage is None or resistance is None:
        return
    current = voltage / resistance
    if sheet.stall_current_a is not None and not _close(
        sheet.stall_current_a, current, STALL_TOLERANCE
    ):
        yield f"stall current is {sheet.stall_current_a:g} A, but V / R is {current:.4g} A"
    if k_t is None:
        return
    torque = current * k_t
    if sheet.stall_torque_nm is not None and not _close(
        sheet.stall_torque_nm, torque, STALL_TOLERANCE
    ):
        yield f"stall torque is {sheet.stall_torque_nm:g} N m, but V k_t / R is {torque:.4g} N m"


def _peak(sheet: MotorSheet) -> Iterator[str]:
    """Saturation takes from k_t times the peak current; nothing adds to it."""
    peak, current = sheet.peak_torque_nm, sheet.peak_current_a
    k_t = sheet.kt_nm_per_a or sheet.torque_constant
    if peak is not None and current is not None and k_t is not None:
        most = k_t * current
        if peak > most * (1.0 + PEAK_TOLERANCE):
            yield f"peak torque is {peak:g} N m, above k_t times the peak current, {most:.4g} N m"
    short_term = peak or sheet.stall_torque_nm
    if short_term is not None and (sheet.continuous_torque_nm or 0.0) > short_term:
        yield f"continuous torque is above the short-term {short_term:g} N m"


def _close(stated: float, expected: float, tolerance: float) -> bool:
    return abs(stated / expected - 1.0) <= tolerance
