"""Impossible figures of a device, as in an edited `design.json`, are refused."""

from dataclasses import make_dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import OcsError
from ocs_design.common.ranges import Length, ranges_of
from ocs_design.device.checks import check_device, device_warnings
from ocs_design.device.device import Device
from ocs_design.device.records.design import read_design
from ocs_design.parts.carrier_plate import CarrierPlate, Mast
from ocs_design.parts.pedestal import Pedestal
from ocs_design.parts.rim import HoleRing, Hub
from ocs_design.parts.wheel import Flywheel, Web
from ocs_design.robot.mass import MassProperties

DEVICE = Device.of_record(read_design(Path(__file__).parents[1] / "data" / "design_0_1_0.json").ocs)


def test_a_designed_device_passes():
    check_device(DEVICE)


@pytest.mark.parametrize("value", [0.0, -0.1, 1e-320, 1e30, np.nan, np.inf])
@pytest.mark.parametrize(
    ("part", "figure"),
    [
        ("flywheel", "outer_radius"),
        ("flywheel", "height"),
        ("flywheel", "density"),
        ("flywheel", "mass"),
        ("motor", "no_load_speed"),
        ("motor", "speed_max"),
    ],
)
def test_impossible_figures_are_refused(part, figure, value):
    changed = replace(getattr(DEVICE, part), **{figure: value})
    with pytest.raises(OcsError, match=f"{part}.{figure} is"):
        check_device(replace(DEVICE, **{part: changed}))


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"guard_wall": -1.0}, "ocs.guard_wall is -1, not between 0 and 100"),
        ({"foot_plate": 0.0}, "ocs.foot_plate is 0, not between 1e-07 and 100"),
        ({"incidence": 1e13}, "ocs.incidence is 1e+13, not between -1e+12 and 1e+12"),
        (
            {"pedestals": (Pedestal(0.027, 0.02, 0.05, 2.0, 500.0),)},
            "pedestals.lean is 2, not between 1e-06 and 1.5708; "
            "pedestals.middle is 500, not between 1e-07 and 100",
        ),
    ],
)
def test_a_fault_is_reported_with_its_range(change, rule):
    with pytest.raises(OcsError) as refused:
        check_device(replace(DEVICE, **change))
    assert rule in str(refused.value)
    assert "the design describes a device that cannot exist: " in str(refused.value)


@pytest.mark.parametrize("record", [Flywheel, Web, Hub, HoleRing, Mast, CarrierPlate, Pedestal])
def test_every_number_of_a_part_has_a_range(record):
    """Also numbers of parts that the device of these tests does not have."""
    assert ranges_of(record)


def test_a_number_without_a_range_is_an_error():
    with pytest.raises(TypeError, match=r"Row.height states no range"):
        ranges_of(make_dataclass("Row", [("radius", Length), ("height", float | None)]))


@pytest.mark.parametrize("value", [0.0, -5.0, np.nan])
@pytest.mark.parametrize("figure", ["voltage", "current_max", "power_max"])
def test_impossible_supplies_are_refused(figure, value):
    supply = Supply(24.0)
    check_device(replace(DEVICE, supply=supply))
    with pytest.raises(OcsError, match=f"supply.{figure} is"):
        check_device(replace(DEVICE, supply=replace(supply, **{figure: value})))


def test_a_bore_is_zero_or_possible_and_within_the_wheel():
    for bore, valid in ((0.0, True), (DEVICE.flywheel.outer_radius, False), (1e-320, False)):
        device = replace(DEVICE, flywheel=replace(DEVICE.flywheel, inner_radius=bore))
        if valid:
            check_device(device)
        else:
            with pytest.raises(OcsError, match="inner_radius"):
                check_device(device)


@pytest.mark.parametrize(
    "change", [{"axis": np.array([0.0, 2.0, 0.0])}, {"position": np.full(3, np.nan)}]
)
def test_modules_without_direction_or_place_are_refused(change):
    left, right = DEVICE.modules
    with pytest.raises(OcsError, match="of module left"):
        check_device(replace(DEVICE, modules=(replace(left, **change), right)))


@pytest.mark.parametrize(("share", "count"), [(0.29, 0), (0.31, 1)])
def test_a_device_of_a_third_of_the_robot_raises_a_warning(share, count):
    robot = MassProperties(DEVICE.mass / share, np.zeros(3), np.eye(3))
    assert len(device_warnings(DEVICE, robot)) == count
