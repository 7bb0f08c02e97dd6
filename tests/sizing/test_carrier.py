"""What stands still of a module: motor, gear and housing."""

from dataclasses import replace

import pytest

from ocs_design.drive.gear import DIRECT
from ocs_design.drive.motor import Motor
from ocs_design.sizing.carrier import drive_carrier, housed
from ocs_design.sizing.housing import housing_axial_inertia, housing_mass

MOTOR = Motor(
    name="m", maker="test", mass=0.12, diameter=0.04, length=0.03, torque_constant=None,
    resistance=None, rated_voltage=None, no_load_speed=None, speed_max=None, peak_torque=None,
    peak_current=None, continuous_torque=None, rotor_inertia=None, source="made up",
    confidence="good",
)  # fmt: skip


def test_a_motor_is_a_solid_cylinder():
    body = drive_carrier(MOTOR, replace(DIRECT, mass=0.03))
    assert body.mass == pytest.approx(0.15)
    assert body.axial_inertia == pytest.approx(0.12 * 0.02**2 / 2.0)
    assert body.transverse_inertia == pytest.approx(0.12 * (0.02**2 / 4.0 + 0.03**2 / 12.0))


def test_a_disc_without_its_length_and_a_point_without_its_diameter():
    disc = drive_carrier(replace(MOTOR, length=None), DIRECT)
    assert disc.axial_inertia == pytest.approx(2.0 * disc.transverse_inertia)
    point = drive_carrier(replace(MOTOR, length=None, diameter=None), DIRECT)
    assert (point.axial_inertia, point.transverse_inertia) == (0.0, 0.0)


def test_the_housing_comes_on_top():
    drive = drive_carrier(MOTOR, DIRECT)
    whole = housed(drive, 0.05, 0.01)
    assert whole.mass - drive.mass == pytest.approx(housing_mass(0.05, 0.01))
    added = whole.axial_inertia - drive.axial_inertia
    assert added == pytest.approx(housing_axial_inertia(0.05, 0.01))
