"""Gears and belts of the catalogue."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.gears import (
    FLANGE,
    PULLEY_GAP,
    BeltStage,
    GearKind,
    GearSheet,
    InertiaAt,
    gear,
    gears,
    gears_to_json,
    stages,
)


def test_stages_reduce_and_speed_up():
    ratios = [stage.ratio for stage in stages(gears().values())]
    assert min(ratios) < 0.5
    assert max(ratios) > 2.0
    assert sum(ratio < 1.0 for ratio in ratios) > 20
    assert 1.0 not in ratios


def test_stages_have_unique_names_and_physical_figures():
    all_stages = stages(gears().values())
    assert len({stage.name for stage in all_stages} | {DIRECT.name}) == len(all_stages) + 1
    for stage in all_stages:
        assert 0.0 < stage.efficiency <= 1.0
        assert 0.0 < stage.mass < 2.5
        assert 0.0 < stage.inertia < 1e-2
        assert 0.0 < stage.torque_max < math.inf
        assert min(stage.motor_speed_max, stage.wheel_speed_max) < math.inf


def test_a_planetary_gear_has_the_figures_of_its_maker():
    """maxon GP 32 C, 166936: 23:1, 75 %, 160 g, 0.8 g cm2 at the motor, 3.75 N m, 8000 rpm."""
    (stage,) = gear("GP 32 C 166936").stages()
    assert stage.ratio == pytest.approx(576.0 / 25.0)
    assert stage.inertia == pytest.approx(0.8e-7 * (576.0 / 25.0) ** 2)
    assert (stage.efficiency, stage.mass, stage.torque_max) == (0.75, 0.16, 3.75)
    assert stage.motor_speed_max == pytest.approx(8000.0 * math.pi / 30.0)
    assert stage.wheel_speed_max == math.inf
    assert not stage.reverses


def test_a_gear_without_all_figures_has_no_stage():
    sheet = gear("GP 42 C 203115")
    assert sheet.stages() == ()
    assert sheet.missing == ("inertia_kg_m2", "inertia_at", "motor_speed_max_rpm")


def test_inertia_at_the_wheel_is_not_converted():
    sheet = GearSheet(
        name="pair",
        maker="me",
        kind=GearKind.FIXED,
        source="bench",
        efficiency=0.98,
        reverses=True,
        ratios=(0.5, 3.0),
        mass_kg=0.02,
        inertia_kg_m2=1e-6,
        inertia_at=InertiaAt.WHEEL,
        torque_max_nm=0.5,
        motor_speed_max_rpm=10_000.0,
    )
    assert [stage.inertia for stage in sheet.stages()] == [1e-6, 1e-6]
    assert [stage.name for stage in sheet.stages()] == ["pair 0.5:1", "pair 3:1"]
    assert all(stage.reverses for stage in sheet.stages())


def test_json_has_no_infinity():
    assert b"Infinity" not in gears_to_json(gears().values())


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


def belt_length(stage):
    """Length of a thread around both pitch circles, from points on them."""
    angles = np.linspace(0.0, 2.0 * np.pi, 20_000)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    distance = stage.motor_radius + stage.wheel_radius + PULLEY_GAP
    points = np.vstack([stage.motor_radius * circle, stage.wheel_radius * circle + [distance, 0.0]])
    # In two dimensions `area` is the perimeter.
    return ConvexHull(points).area


@pytest.mark.parametrize("pair", [(20, 60), (60, 20), (20, 20), (18, 24), (16, 80)])
def test_the_belt_is_the_shortest_with_whole_teeth(pair):
    stage = replace(STAGE, motor_teeth=pair[0], wheel_teeth=pair[1])
    length = stage.belt_mass / stage.belt_density
    assert length / stage.pitch == pytest.approx(round(length / stage.pitch), abs=1e-9)
    least = belt_length(stage)
    assert least - 1e-6 <= length < least + stage.pitch


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
def test_a_reversed_stage_has_the_same_mass_and_power(first, second):
    stage = replace(STAGE, motor_teeth=first, wheel_teeth=second)
    reversed_stage = replace(STAGE, motor_teeth=second, wheel_teeth=first)
    assert stage.mass == pytest.approx(reversed_stage.mass, rel=1e-12)
    assert stage.torque_max == pytest.approx(reversed_stage.torque_max * stage.ratio, rel=1e-12)
    assert stage.inertia == pytest.approx(reversed_stage.inertia * stage.ratio**2, rel=1e-12)


def test_torque_agrees_with_the_table_of_the_maker():
    """SDP/SI, table 33: 20 grooves, 2 mm pitch, 6 mm wide, 10 rpm: 0.18 N m."""
    stages = {stage.name: stage for stage in gear("GT3 2 mm x 6 mm").stages()}
    assert 0.9 * 0.18 < stages["GT3 2 mm x 6 mm 40:20"].torque_max < 0.18


def test_few_teeth_in_mesh_reduce_the_torque():
    """Ten teeth, of which three are in mesh: 0.4 of the torque (SDP/SI, section 13.3)."""
    stage = replace(STAGE, motor_teeth=10, wheel_teeth=60)
    assert stage.teeth_in_mesh == 3
    assert stage.torque_max == pytest.approx(0.4 * 26.2 * stage.wheel_radius, rel=1e-12)


def test_the_belt_speed_limits_the_wheel():
    sheet = gear("GT3 2 mm x 6 mm")
    for stage in sheet.stages():
        belt_speed = stage.wheel_speed_max * stage.room.wheel_radius
        assert belt_speed == pytest.approx(sheet.belt_speed_max_m_s)
