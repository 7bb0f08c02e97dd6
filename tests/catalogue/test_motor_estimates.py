"""What is estimated where a motor's source says nothing, against the motors where it does."""

import math
from statistics import median

import pytest

from ocs_design.actuation.drive import Drive, missing_figures
from ocs_design.actuation.motor import (
    DIRECT,
    INERTIA_SHARE,
    Face,
    Gear,
    MotorKind,
    build_gaps,
    estimated_continuous_torque,
    estimated_rotor_inertia,
)
from ocs_design.catalogue.motors import motor, motors
from ocs_design.parts.motor_mount import mount_of

REDUCER = Gear("r", 3.0, 0.9, 0.1, 1e-6, 1e4, math.inf, 10.0, reverses=False, source="made up")


def known_inertia(kind):
    """Stated rotor inertia over the estimate, for every motor of that kind that has both."""
    shares = []
    for found in motors().values():
        estimate, _ = estimated_rotor_inertia(found.kind, found.mass, found.diameter)
        stated = None if found.rotor_inertia_source else found.rotor_inertia
        if found.kind is kind and stated is not None and estimate is not None:
            shares.append(stated / estimate)
    return shares


@pytest.mark.parametrize(("kind", "least_count"), [("outrunner", 3), ("frameless", 6)])
def test_known_rotor_inertias_lie_within_the_stated_spread(kind, least_count):
    """The estimate is never above: a rotor that is counted too heavy makes a wheel too light."""
    kind = MotorKind(kind)
    shares = known_inertia(kind)
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
    """Worked by hand: 0.05 x 0.108 kg x (35.2 mm)^2."""
    inertia, source = estimated_rotor_inertia(MotorKind.OUTRUNNER, 0.108, 0.0352)
    assert inertia == pytest.approx(6.691e-6, rel=1e-3)
    assert "0.05 m D^2" in source


def test_an_estimate_is_named_and_a_stated_figure_is_not():
    estimated, stated = motor("MN5212 KV340"), motor("EC 45 flat 70 W 411812")
    assert estimated.rotor_inertia and "estimate" in estimated.rotor_inertia_source
    assert (stated.rotor_inertia, stated.rotor_inertia_source) == (1.81e-5, "")
    drive = Drive.of(estimated, DIRECT, 24.0)
    assert drive.rotor_inertia == estimated.rotor_inertia
    assert drive.rotor_inertia_source == estimated.rotor_inertia_source


def test_behind_a_reducing_gear_the_least_inertia_is_not_the_safe_side():
    assert missing_figures(motor("MN5212 KV340"), REDUCER) == ("rotor inertia",)
    assert missing_figures(motor("MN5212 KV340"), DIRECT) == ()


def test_continuous_torque_by_hand():
    """Worked by hand: a cylinder 50 mm wide and 40 mm long, 0.05 ohm, 0.03 N m/A.

    A = pi 0.05 (0.04 + 0.025) = 0.010210 m^2; 10 x 75 A = 7.658 W = 0.05 x 1.29475 i^2: 10.876 A.
    """
    torque, source = estimated_continuous_torque(0.03, 0.05, 0.05, 0.04)
    assert torque == pytest.approx(0.03 * 10.876, rel=1e-4)
    assert "still air" in source
    assert estimated_continuous_torque(0.03, 0.05, 0.05, None) == (None, "")


def test_the_estimate_of_continuous_torque_is_below_what_makers_state():
    shares = []
    for found in motors().values():
        estimate, _ = estimated_continuous_torque(
            found.torque_constant, found.resistance, found.diameter, found.length
        )
        stated = None if found.continuous_torque_source else found.continuous_torque
        if estimate is not None and stated is not None:
            shares.append(estimate / stated)
    assert len(shares) >= 7
    assert max(shares) <= 1.0
    assert median(shares) > 0.5


def test_every_complete_motor_is_held_by_known_screws():
    complete = [found for found in motors().values() if not build_gaps(found)]
    assert len(complete) >= 60
    for found in complete:
        assert mount_of(found, None).holes.screws is not None, found.name
        assert found.mounting.stator_face in set(Face)


def test_heavy_robots_have_motors_that_can_be_built_with():
    """Up to 230 N m with up to 19 N m/kg, screwed on by their back and by their bell."""
    complete = [found for found in motors().values() if not build_gaps(found)]
    strong = [found for found in complete if found.peak_torque > 14.0]
    assert [found.peak_torque for found in strong if found.maker == "EMRAX"] == [90.0, 140.0, 230.0]
    assert max(found.peak_torque / found.mass for found in strong) > 19.0
    assert {(str(found.mounting.stator), str(found.mounting.rotor)) for found in strong} == {
        ("4 x M6 on 50 mm", "4 x M5 on 30 mm"),
        ("6 x M6 on 62 mm", "6 x M6 on 64 mm"),
        ("6 x M8 on 78 mm", "6 x M8 on 75 mm"),
    }
