"""What feet stand on: contact in closed form on a box, plates on trunks that are too narrow."""

from dataclasses import replace
from math import acos, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import ROBOTS
from wheels import driven_device

from ocs_design.device.device import Module
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.device.solids import foot_of, module_solids, plate_heads, plate_solids
from ocs_design.parts.carrier_plate import SAFETY, STOCK, YIELD_STRENGTH
from ocs_design.requirement.froude import default_envelope
from ocs_design.robot.collision import collision_model
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.footing import (
    FLATNESS,
    contacts_of,
    feet_of,
    footing_of,
    stand_on_trunk,
)
from ocs_design.sizing.mounting import mounting_of, mounting_open_points
from ocs_design.sizing.placement import place_free

DEVICE = driven_device()
FOOT = foot_of(DEVICE)
TOP = 0.05

BOX = """<robot name="boxed">
  <link name="base">
    <inertial><mass value="10"/><inertia ixx="0.1" iyy="0.4" izz="0.4" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision><geometry><box size="{length} {width} 0.1"/></geometry></collision>
    {more}
  </link>
</robot>"""

REAL = [
    "solo_description/robots/solo12",
    "a1_description/urdf/a1",
    "go2_description/urdf/go2",
    "bolt_description/robots/bolt",
    "anymal_c_simple_description/urdf/anymal",
]


@pytest.fixture
def boxed(tmp_path):
    def read(width, length=0.6, more=""):
        path = tmp_path / "boxed.urdf"
        path.write_text(BOX.format(width=width, length=length, more=more))
        return read_robot(path, trunk="base")

    return read


def standing(out, up=0.0):
    """With its feet so far to both sides, so far above the trunk's top [m]."""
    left, right = DEVICE.modules
    place = np.array([0.0, out, TOP + FOOT.wheel_height + up])
    return replace(
        DEVICE,
        modules=(replace(left, position=place), replace(right, position=place * [1.0, -1.0, 1.0])),
    )


def segment_share(over):
    """Share of a disc within a line that is `over` radii off its middle."""
    return 1.0 - (acos(over) - over * sqrt(1.0 - over**2)) / pi


def test_on_a_wide_box_all_of_a_foot_stands(boxed):
    for contact in contacts_of(boxed(0.6), standing(0.1)):
        assert contact.held
        assert contact.area == pytest.approx(pi * FOOT.base_radius**2)
        assert contact.gap == pytest.approx(0.0, abs=1e-9)


def test_half_over_the_edge_half_the_area(boxed):
    for contact in contacts_of(boxed(0.2), standing(0.1)):
        assert contact.share == pytest.approx(0.5, abs=0.02)
        assert contact.held is False
        assert contact.gap == np.inf


@settings(max_examples=15, deadline=None)
@given(over=st.floats(-0.9, 0.9))
def test_the_share_is_that_of_a_circle_cut_by_a_line(tmp_path_factory, over):
    path = tmp_path_factory.mktemp("box") / "boxed.urdf"
    path.write_text(BOX.format(width=0.3, length=0.6, more=""))
    robot = read_robot(path, trunk="base")
    out = 0.15 - over * FOOT.base_radius
    for contact in contacts_of(robot, standing(out)):
        assert contact.share == pytest.approx(segment_share(over), abs=0.03)


@pytest.mark.parametrize(("up", "held"), [(0.5 * FLATNESS, True), (2.0 * FLATNESS, False)])
def test_a_foot_in_the_air_is_not_held(boxed, up, held):
    found = contacts_of(boxed(0.6), standing(0.1, up))
    assert [contact.held for contact in found] == [held, held]
    assert found[0].gap == pytest.approx(up)


def test_a_foot_in_the_trunk_is_told(boxed):
    robot = boxed(0.6)
    device = standing(0.1, -0.004)
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting.feet[0].proud == pytest.approx(0.004)
    assert "reaches 4 mm above" in mounting_open_points(mounting)[0].what


def test_on_a_wide_trunk_there_is_no_plate(boxed):
    robot = boxed(0.6)
    device = stand_on_trunk(standing(0.1, 0.02), robot, stated=False)
    assert device.plate is None
    assert device.modules[0].position[2] == pytest.approx(TOP + FOOT.wheel_height)
    assert all(contact.held for contact in contacts_of(robot, device))


@pytest.mark.parametrize("width", [0.05, 0.1, 0.13])
def test_on_a_narrow_trunk_a_plate_carries_both(boxed, width):
    robot = boxed(width)
    device = stand_on_trunk(standing(0.1), robot, stated=False)
    plate = device.plate
    assert plate.position[2] == pytest.approx(TOP)
    assert device.modules[0].position[2] == pytest.approx(plate.top + FOOT.wheel_height)
    assert device.mass == pytest.approx(DEVICE.mass + plate.mass)
    assert all(contact.held for contact in contacts_of(robot, device))
    feet = feet_of(device)
    least = YIELD_STRENGTH / SAFETY
    assert plate.stress(feet.mass, feet.height) <= least
    thinner = [replace(plate, thickness=each) for each in STOCK if each < plate.thickness]
    assert all(each.stress(feet.mass, feet.height) > least for each in thinner)


@pytest.mark.parametrize("width", [0.1, 0.6])
def test_two_pairs_stand_on_the_trunk_or_on_a_plate_each(boxed, width):
    """Mirrored in the sagittal plane, and alike in front and behind."""
    robot, layout = boxed(width), Layout(LayoutName.DOUBLE_PAIR)
    axes = layout.axes(DEVICE.incidence).T
    modules = tuple(
        Module(name, axis, DEVICE.modules[0].position)
        for name, axis in zip(layout.names, axes, strict=True)
    )
    two = replace(DEVICE, modules=modules, layout=layout)
    device = stand_on_trunk(two, robot, stated=False)
    assert (device.plate is None) == (width == 0.6)
    if device.plate is not None:
        assert len(device.plate.rows) == 2
        assert len(device.plate.trunk) == len(device.plate.feet) == 8
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting_open_points(mounting) == ()
    assert all(contact.held for contact in mounting.feet)
    assert mounting.nearest.distance > 0.0
    front_left, front_right, back_left, _ = (each.position for each in device.modules)
    np.testing.assert_allclose(front_right, front_left * [1.0, -1.0, 1.0], atol=1e-12)
    assert back_left[0] < front_left[0]
    frames = [each.frame for each in device.modules]
    np.testing.assert_allclose(frames, layout.frames(DEVICE.incidence), atol=1e-12)
    np.testing.assert_allclose(frames[:2], [each.frame for each in DEVICE.modules], atol=1e-12)


def test_heavier_modules_have_a_thicker_plate(boxed):
    robot, heavy = boxed(0.1), replace(DEVICE.carrier, mass=30.0 * DEVICE.carrier.mass)
    light = stand_on_trunk(standing(0.1), robot, stated=False).plate
    found = stand_on_trunk(replace(standing(0.1), carrier=heavy), robot, stated=False).plate
    assert found.thickness > light.thickness


def test_a_bump_is_bridged_by_sleeves(boxed):
    bump = (
        '<collision><origin xyz="0 0 0.05"/><geometry><sphere radius="0.006"/></geometry>'
        "</collision>"
    )
    robot = boxed(0.1, more=bump)
    device = stand_on_trunk(standing(0.1), robot, stated=True)
    # The feet are where they were stated to be: what is under them is in the way.
    assert device.plate is None
    higher = stand_on_trunk(standing(0.1, 0.012), robot, stated=True)
    assert max(higher.plate.sleeves) == pytest.approx(0.012 - higher.plate.thickness, abs=1e-4)
    assert all(contact.held for contact in contacts_of(robot, higher))


def test_a_trunk_too_narrow_for_four_screws_carries_nothing(boxed):
    robot = boxed(0.02)
    device = stand_on_trunk(standing(0.1), robot, stated=False)
    assert device.plate is None
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    (point,) = mounting_open_points(mounting)
    assert point.what.startswith("the feet hang in the air")
    assert "--position" in point.cure


def test_without_shapes_nothing_is_known():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07))
    device = stand_on_trunk(standing(0.1), robot, stated=False)
    assert device is not None
    assert [contact.held for contact in contacts_of(robot, device)] == [None, None]


def test_wheels_without_feet_stand_on_nothing(boxed):
    bare = replace(DEVICE, carrier=replace(DEVICE.carrier, mass=0.0))
    assert contacts_of(boxed(0.2), bare) == ()
    assert stand_on_trunk(bare, boxed(0.2), stated=False) is bare


def test_the_selection_carries_the_plate_of_the_largest_modules(boxed):
    robot = boxed(0.1)
    footing = footing_of(robot, default_envelope(robot))
    carried = footing.carried(robot.mass_properties)
    assert carried.mass == pytest.approx(robot.mass + footing.plate.mass)
    assert footing.place.origins[0][2] == pytest.approx(TOP + footing.plate.thickness)
    wide = boxed(1.0)
    assert (
        footing_of(wide, default_envelope(wide)).place
        == place_free(wide, default_envelope(wide)).place
    )


@pytest.mark.parametrize("name", REAL)
def test_nothing_hangs_and_nothing_collides_over_a_full_turn(name):
    """A wheel is within its housing whatever its angle: cylinders are all that they sweep."""
    robot = read_robot(ROBOTS / f"{name}.urdf")
    device = stand_on_trunk(standing(0.1), robot, stated=False)
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    assert mounting_open_points(mounting) == ()
    assert mounting.known
    assert all(contact.held for contact in mounting.feet)
    assert mounting.nearest.distance > 0.0
    between = collision_model(robot).between
    left, right = (module_solids(device, module) for module in device.modules)
    assert min(between(one, other) for one in left.all for other in right.all) > 0.0
    heads = plate_heads(device)
    for module in (left, right):
        assert all(between(head, solid) > 0.0 for head in heads for solid in module.all)
        # A foot stands on its plate.
        for solid in module.foot:
            nearest = min(between(disc, solid) for disc in plate_solids(device))
            assert nearest == pytest.approx(0.0, abs=1e-6)
