"""Figures, estimates and threads of motors against data sheets and each other."""

import json
import math
import re
from dataclasses import fields, replace
from statistics import median

import pytest

from ocs_design.actuation.drive import Drive, missing_figures
from ocs_design.actuation.motor import (
    BY_CONVENTION,
    DIRECT,
    INERTIA_SHARE,
    Face,
    Gear,
    MotorKind,
    ShaftForm,
    build_gaps,
    estimated_continuous_torque,
    estimated_rotor_inertia,
)
from ocs_design.catalogue.motors import MotorSheet, motor, motors, motors_to_json
from ocs_design.catalogue.rows import columns_of, positive, positive_integer, text
from ocs_design.parts.motor_mount import mount_of
from ocs_design.report.text.catalogue import motor_mounting

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
def test_gradient_and_time_constant_are_those_of_the_maker(name):
    """Neither is in the catalogue: both follow from R, k_t and the rotor's inertia."""
    row = motor(name)
    gradient = row.resistance / row.torque_constant**2
    printed_gradient, printed_time = PRINTED[name]
    assert gradient / RPM == pytest.approx(printed_gradient, rel=0.015)
    assert gradient * row.rotor_inertia == pytest.approx(printed_time, rel=0.015)


def test_there_are_motors_for_small_and_large_robots():
    complete = [row for row in motors().values() if not missing_figures(row, DIRECT)]
    assert sum(row.mass < 0.1 for row in complete) >= 20
    assert sum(row.peak_torque > 3.0 for row in complete) >= 15
    assert len(complete) >= 140


ADDRESS = re.compile(r"\b(github\.com/[\w.-]+/[\w.-]+ \S+|\w[\w.-]*\.\w{2,3}/\S+)")


def test_every_source_can_be_looked_up():
    """The source is an address with a path, or a repository with a file."""
    for row in motors().values():
        assert ADDRESS.search(row.source), f"{row.name}: {row.source}"


def test_figures_missing_in_the_source_stay_empty():
    incomplete = motor("EC 45 flat 30 W 200142")
    assert incomplete.mass is incomplete.resistance is None
    assert {"mass", "resistance"} <= set(missing_figures(incomplete, DIRECT))


def test_a_field_oriented_constant_is_converted():
    """mj5208: Kv 330, 0.025 N m/A and a maximum of 100 A, both by amplitude."""
    row = motor("mj5208 KV330")
    assert row.torque_constant == pytest.approx(1.0 / (330.0 * RPM), rel=0.01)
    assert row.torque_constant * row.peak_current == pytest.approx(0.025 * 100.0, rel=1e-12)


def test_a_resistance_between_line_and_star_counts_twice():
    """The maker has 0.452 ohm between two lines; 0.233 ohm per phase was measured."""
    assert motor("Antigravity 4004 KV300").resistance == pytest.approx(0.452, rel=0.03)


def test_the_peak_torque_has_its_basis():
    assert motor("R80 KV110").peak_basis == "peak torque"
    by_current = motor("Antigravity MN4006 KV380")
    assert by_current.peak_basis == "peak current"
    assert by_current.peak_torque == pytest.approx(16.0 / (380.0 * RPM), rel=1e-12)
    by_stall = motor("EC 90 flat 90 W 323772")
    assert (by_stall.peak_basis, by_stall.peak_torque) == ("stall torque", 4.67)
    assert motor("D5065 KV270").peak_basis == ""


def test_motor_constant_per_mass_is_that_of_outrunners():
    """k_t / sqrt(R) per mass lies within a factor of two of 0.6 for every T-Motor and KDE motor.

    This shows errors in resistances or masses, as in three rows of the source.
    """
    for row in motors().values():
        if row.maker in {"T-Motor", "KDE Direct"}:
            constant = row.torque_constant / math.sqrt(row.resistance) / row.mass
            assert 0.3 < constant < 1.2, row.name


def test_columns_are_fields_of_rows_and_are_read_by_their_type():
    columns = columns_of(MotorSheet)
    assert [column.field for column in columns.values()] == [
        field.name for field in fields(MotorSheet)
    ]
    readers = {
        "maker": text,
        "mass_kg": positive,
        "rotor_bolts": positive_integer,
        "rotor_thread": text,
    }
    assert {name: columns[name].read for name in readers} == readers
    with pytest.raises(ValueError, match="not one of six-step, foc, foc-rms"):
        columns["kt_convention"].read("sine")


REDUCER = Gear("r", 3.0, 0.9, 0.1, 1e-6, 1e4, math.inf, 10.0, reverses=False, source="made up")


def published_over_estimated_inertia(kind):
    """Ratios of published rotor inertia and estimate for motors of a kind that have both."""
    shares = []
    for row in motors().values():
        estimate, _ = estimated_rotor_inertia(row.kind, row.mass, row.diameter)
        published = None if row.rotor_inertia_source else row.rotor_inertia
        if row.kind is kind and published is not None and estimate is not None:
            shares.append(published / estimate)
    return shares


@pytest.mark.parametrize(("kind", "least_count"), [("outrunner", 3), ("frameless", 6)])
def test_published_rotor_inertias_are_within_the_spread_of_the_estimate(kind, least_count):
    """The estimate is never too high, since that would make the wheel too light."""
    kind = MotorKind(kind)
    shares = published_over_estimated_inertia(kind)
    least, most = INERTIA_SHARE[kind]
    assert len(shares) >= least_count
    assert min(shares) >= 1.0
    assert max(shares) <= most / least
    assert median(shares) < 1.5


def test_an_inrunner_and_a_motor_without_mass_have_no_estimate():
    assert estimated_rotor_inertia(MotorKind.INRUNNER, 0.1, 0.04) == (None, "")
    assert estimated_rotor_inertia(MotorKind.OUTRUNNER, None, 0.04) == (None, "")
    assert estimated_rotor_inertia(None, 0.1, 0.04) == (None, "")


def test_the_estimate_is_a_share_of_mass_and_diameter_squared():
    """0.05 x 0.108 kg x (35.2 mm)^2."""
    inertia, source = estimated_rotor_inertia(MotorKind.OUTRUNNER, 0.108, 0.0352)
    assert inertia == pytest.approx(6.691e-6, rel=1e-3)
    assert "0.05 m D^2" in source


def test_only_an_estimated_rotor_inertia_has_a_source():
    estimated, published = motor("MN5212 KV340"), motor("EC 45 flat 70 W 411812")
    assert estimated.rotor_inertia and "estimate" in estimated.rotor_inertia_source
    assert (published.rotor_inertia, published.rotor_inertia_source) == (1.81e-5, "")
    drive = Drive.of(estimated, DIRECT, 24.0)
    assert drive.rotor_inertia == estimated.rotor_inertia
    assert drive.rotor_inertia_source == estimated.rotor_inertia_source


def test_behind_a_reducing_gear_an_estimate_is_not_enough():
    assert missing_figures(motor("MN5212 KV340"), REDUCER) == ("rotor inertia",)
    assert missing_figures(motor("MN5212 KV340"), DIRECT) == ()


def test_estimated_continuous_torque():
    """A cylinder 50 mm wide and 40 mm long, 0.05 ohm, 0.03 N m/A.

    A = pi 0.05 (0.04 + 0.025) = 0.010210 m^2; 10 x 75 A = 7.658 W = 0.05 x 1.29475 i^2: 10.876 A.
    """
    torque, source = estimated_continuous_torque(0.03, 0.05, 0.05, 0.04)
    assert torque == pytest.approx(0.03 * 10.876, rel=1e-4)
    assert "still air" in source
    assert estimated_continuous_torque(0.03, 0.05, 0.05, None) == (None, "")


def test_estimated_continuous_torques_are_below_published_ones():
    shares = []
    for row in motors().values():
        estimate, _ = estimated_continuous_torque(
            row.torque_constant, row.resistance, row.diameter, row.length
        )
        published = None if row.continuous_torque_source else row.continuous_torque
        if estimate is not None and published is not None:
            shares.append(estimate / published)
    assert len(shares) >= 7
    assert max(shares) <= 1.0
    assert median(shares) > 0.5


def test_every_complete_motor_is_held_by_known_screws():
    complete = [row for row in motors().values() if not build_gaps(row)]
    assert len(complete) >= 60
    for row in complete:
        assert mount_of(row, None).holes.screws is not None, row.name
        assert row.mounting.stator_face in set(Face)


@pytest.mark.parametrize("form", [ShaftForm.PLAIN, ShaftForm.FLAT, ShaftForm.THREAD])
def test_a_wheel_is_bonded_on_a_cylinder_and_on_no_thread(form):
    """A bore does not centre a wheel on a thread for a propeller's nut."""
    threaded = motors()["XING 2806.5 KV1800"]
    assert threaded.mounting.shaft_form is ShaftForm.THREAD
    gaps = build_gaps(replace(threaded, mounting=replace(threaded.mounting, shaft_form=form)))
    assert len(gaps) == (form is ShaftForm.THREAD)
    assert all("shaft without thread" in gap for gap in gaps)


def test_heavy_robots_have_motors_that_can_be_built_with():
    """Up to 230 N m and 19 N m/kg, with threads in stator and rotor."""
    complete = [row for row in motors().values() if not build_gaps(row)]
    strong = [row for row in complete if row.peak_torque > 14.0]
    assert [row.peak_torque for row in strong if row.maker == "EMRAX"] == [90.0, 140.0, 230.0]
    assert max(row.peak_torque / row.mass for row in strong) > 19.0
    assert {(str(row.mounting.stator), str(row.mounting.rotor)) for row in strong} == {
        ("4 x M6 on 50 mm", "4 x M5 on 30 mm"),
        ("6 x M6 on 62 mm", "6 x M6 on 64 mm"),
        ("6 x M8 on 78 mm", "6 x M8 on 75 mm"),
    }


def test_threads_by_convention_are_marked():
    for row in motors().values():
        words = "convention of makers" in row.source or "of the same series" in row.source
        assert words <= (BY_CONVENTION in row.confidence), row.name


def test_threads_have_a_source():
    for row in motors().values():
        mounting = row.mounting
        if mounting is not None and (mounting.rotor or mounting.stator):
            assert "threads: " in row.source, row.name


def test_mountings_in_json_and_text():
    (row,) = json.loads(motors_to_json([motor("MN5212 KV340")]))["motors"]
    assert row["mounting"]["rotor"] == {
        "diameter": 0.017,
        "bolts": 3,
        "thread": "M3",
        "screws": "8.8",
        "depth": None,
        "depth_max": None,
        "drawn": None,
    }
    words = motor_mounting(motor("MN5212 KV340").mounting)
    assert words == "shaft 4 mm, rotor 3 x M3 on 17 mm, stator 4 x M3 on 25 mm (back)"
    assert motor_mounting(None) == ""
