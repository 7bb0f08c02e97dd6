"""Gears of the catalogue and the stages they offer."""

import math

import pytest

from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.gears import (
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


def test_stages_have_names_of_their_own_and_physical_figures():
    found = stages(gears().values())
    assert len({stage.name for stage in found} | {DIRECT.name}) == len(found) + 1
    for stage in found:
        assert 0.0 < stage.efficiency <= 1.0
        assert 0.0 < stage.mass < 2.5
        assert 0.0 < stage.inertia < 1e-2
        assert 0.0 < stage.torque_max < math.inf
        assert min(stage.motor_speed_max, stage.wheel_speed_max) < math.inf


def test_a_planetary_gear_as_its_maker_prints_it():
    """maxon GP 32 C, 166936: 23:1, 75 %, 160 g, 0.8 g cm2 at the motor, 3.75 N m, 8000 rpm."""
    (stage,) = gear("GP 32 C 166936").stages()
    assert stage.ratio == pytest.approx(576.0 / 25.0)
    assert stage.inertia == pytest.approx(0.8e-7 * (576.0 / 25.0) ** 2)
    assert (stage.efficiency, stage.mass, stage.torque_max) == (0.75, 0.16, 3.75)
    assert stage.motor_speed_max == pytest.approx(8000.0 * math.pi / 30.0)
    assert stage.wheel_speed_max == math.inf
    assert not stage.reverses


def test_a_gear_that_lacks_figures_offers_no_stage():
    sheet = gear("GP 42 C 203115")
    assert sheet.stages() == ()
    assert sheet.missing == ("inertia_kg_m2", "inertia_at", "motor_speed_max_rpm")


def test_inertia_at_the_wheel_is_taken_as_it_is():
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
