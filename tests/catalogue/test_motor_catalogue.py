"""The motors' figures against what their data sheets print elsewhere."""

import math
import re
from dataclasses import fields

import pytest

from ocs_design.actuation.drive import drive_line, missing_figures
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.motors import MotorSheet, motor, motors
from ocs_design.catalogue.rows import columns_of, positive, text, whole

RPM = math.pi / 30.0

# Speed/torque gradient [rpm/(N m)] and mechanical time constant [s], as the makers print them.
PRINTED = {
    "EC 90 flat 90 W 323772": (697.0, 22.3e-3),
    "EC 90 flat 90 W 244879": (466.0, 14.9e-3),
    "EC 45 flat 70 W 411812": (4260.0, 8.07e-3),
    "EC 45 flat 50 W 339286": (14_300.0, 20.3e-3),
    "EC 32 flat 15 W 267121": (54_500.0, 20.0e-3),
    "4221 G 018 BXTH": (4930.0, 3.56e-3),
    "4221 G 024 BXTH": (4970.0, 3.59e-3),
    "4221 G 048 BXTH": (4400.0, 3.18e-3),
}


@pytest.mark.parametrize("name", PRINTED)
def test_gradient_and_time_constant_are_those_that_the_maker_prints(name):
    """Neither is in the row: both follow from R, k_t and the rotor's inertia."""
    found = motor(name)
    gradient = found.resistance / found.torque_constant**2
    printed_gradient, printed_time = PRINTED[name]
    assert gradient / RPM == pytest.approx(printed_gradient, rel=0.015)
    assert gradient * found.rotor_inertia == pytest.approx(printed_time, rel=0.015)


def test_the_worked_example_of_the_theory_is_in_the_catalogue():
    found = motor("EC 45 flat 70 W 411812")
    line = drive_line(found, DIRECT, 24.0)
    assert line.stall_torque == pytest.approx(1.4566, rel=1e-4)
    assert line.no_load_speed == pytest.approx(650.4, rel=1e-4)


def test_there_is_something_to_choose_from_for_small_and_for_large_robots():
    complete = [found for found in motors().values() if not missing_figures(found, DIRECT)]
    assert sum(found.mass < 0.1 for found in complete) >= 20
    assert sum(found.peak_torque > 3.0 for found in complete) >= 15
    assert len(complete) >= 140


ADDRESS = re.compile(r"\b(github\.com/[\w.-]+/[\w.-]+ \S+|\w[\w.-]*\.\w{2,3}/\S+)")


def test_every_source_can_be_looked_up():
    """A repository with a path in it, or another address with one."""
    for found in motors().values():
        assert ADDRESS.search(found.source), f"{found.name}: {found.source}"


def test_what_a_source_does_not_give_stays_empty():
    incomplete = motor("EC 45 flat 30 W 200142")
    assert incomplete.mass is incomplete.resistance is None
    assert {"mass", "resistance"} <= set(missing_figures(incomplete, DIRECT))


def test_a_field_oriented_constant_is_converted():
    """mj5208: Kv 330, 0.025 N m per ampere of amplitude, 100 A of amplitude at most."""
    found = motor("mj5208 KV330")
    assert found.torque_constant == pytest.approx(1.0 / (330.0 * RPM), rel=0.01)
    assert found.torque_constant * found.peak_current == pytest.approx(0.025 * 100.0, rel=1e-12)


def test_a_resistance_between_line_and_star_counts_twice():
    """The maker prints 0.452 ohm between two lines for what was measured as 0.233 per phase."""
    assert motor("Antigravity 4004 KV300").resistance == pytest.approx(0.452, rel=0.03)


def test_the_short_term_torque_says_what_it_rests_on():
    assert motor("R80 KV110").peak_basis == "peak torque"
    by_current = motor("Antigravity MN4006 KV380")
    assert by_current.peak_basis == "peak current"
    assert by_current.peak_torque == pytest.approx(16.0 / (380.0 * RPM), rel=1e-12)
    by_stall = motor("EC 90 flat 90 W 323772")
    assert (by_stall.peak_basis, by_stall.peak_torque) == ("stall torque", 4.67)
    assert motor("D5065 KV270").peak_basis == ""


def test_motor_constant_per_mass_is_that_of_outrunners():
    """k_t / sqrt(R) per mass lies within a factor of two of 0.6 for every T-Motor and KDE motor.

    A digit lost in a resistance or a mass would show: it did for three rows of the source.
    """
    for found in motors().values():
        if found.maker in {"T-Motor", "KDE Direct"}:
            constant = found.torque_constant / math.sqrt(found.resistance) / found.mass
            assert 0.3 < constant < 1.2, found.name


def test_a_column_is_a_field_of_a_row_and_is_read_as_its_type_asks():
    columns = columns_of(MotorSheet)
    assert list(columns) == [field.name for field in fields(MotorSheet)]
    asked = {"maker": text, "mass_kg": positive, "rotor_bolts": whole, "rotor_thread": text}
    assert {name: columns[name] for name in asked} == asked
    with pytest.raises(ValueError, match="none of six-step, foc, foc-rms"):
        columns["kt_convention"]("sine")
