"""A belt's geometry against brute force, energy and the maker's tables."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from ocs_design.catalogue.gears import CLEARANCE, FLANGE, BeltStage, gear

STAGE = BeltStage(
    motor_teeth=20,
    wheel_teeth=60,
    pitch=2e-3,
    width=6e-3,
    belt_density=0.0112,
    pulley_density=2700.0,
    working_tension=26.2,
)
teeth = st.integers(10, 80)


def hull_length(stage):
    """Of a thread about both pitch circles, from points on them."""
    angles = np.linspace(0.0, 2.0 * np.pi, 20_000)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    distance = stage.motor_radius + stage.wheel_radius + CLEARANCE
    points = np.vstack([stage.motor_radius * circle, stage.wheel_radius * circle + [distance, 0.0]])
    # In two dimensions `area` is the perimeter.
    return ConvexHull(points).area


@pytest.mark.parametrize("pair", [(20, 60), (60, 20), (20, 20), (18, 24), (16, 80)])
def test_the_belt_is_the_shortest_with_whole_teeth(pair):
    stage = replace(STAGE, motor_teeth=pair[0], wheel_teeth=pair[1])
    length = stage.belt_mass / stage.belt_density
    assert length / stage.pitch == pytest.approx(round(length / stage.pitch), abs=1e-9)
    assert hull_length(stage) - 1e-6 <= length < hull_length(stage) + stage.pitch


@given(teeth, teeth)
def test_inertia_is_that_of_the_kinetic_energy(motor_teeth, wheel_teeth):
    stage = replace(STAGE, motor_teeth=motor_teeth, wheel_teeth=wheel_teeth)
    wheel_speed = 100.0
    motor_speed = stage.ratio * wheel_speed
    belt_speed = wheel_speed * stage.wheel_radius
    assert belt_speed == pytest.approx(motor_speed * stage.motor_radius, rel=1e-12)
    energy = 0.5 * stage.belt_mass * belt_speed**2
    for radius, speed in ((stage.motor_radius, motor_speed), (stage.wheel_radius, wheel_speed)):
        volume = math.pi * radius**2 * (stage.width + 2.0 * FLANGE)
        energy += 0.5 * (0.5 * stage.pulley_density * volume * radius**2) * speed**2
    assert 0.5 * stage.inertia * wheel_speed**2 == pytest.approx(energy, rel=1e-12)


@given(teeth, teeth)
def test_turned_about_a_stage_is_as_heavy_and_carries_the_same_power(first, second):
    stage = replace(STAGE, motor_teeth=first, wheel_teeth=second)
    turned = replace(STAGE, motor_teeth=second, wheel_teeth=first)
    assert stage.mass == pytest.approx(turned.mass, rel=1e-12)
    assert stage.torque_max == pytest.approx(turned.torque_max * stage.ratio, rel=1e-12)
    assert stage.inertia == pytest.approx(turned.inertia * stage.ratio**2, rel=1e-12)


def test_torque_agrees_with_the_makers_table():
    """SDP/SI, table 33: 20 grooves, 2 mm pitch, 6 mm wide, 10 rpm: 0.18 N m."""
    stages = {stage.name: stage for stage in gear("GT3 2 mm x 6 mm").stages()}
    assert 0.9 * 0.18 < stages["GT3 2 mm x 6 mm 40:20"].torque_max < 0.18


def test_few_teeth_in_mesh_cost_torque():
    """Ten teeth, of which four are wrapped: two fifths less (SDP/SI, section 13.3)."""
    stage = replace(STAGE, motor_teeth=10, wheel_teeth=60)
    assert stage.teeth_in_mesh == 3
    assert stage.torque_max == pytest.approx(0.4 * 26.2 * stage.wheel_radius, rel=1e-12)


def test_the_belts_speed_limits_the_wheel():
    assert STAGE.wheel_speed_max(33.0) * STAGE.wheel_radius == pytest.approx(33.0)
