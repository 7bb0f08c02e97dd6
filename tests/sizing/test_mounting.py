"""Mounting of devices on robots: clearances by hand, and MuJoCo's contacts as an oracle."""

from dataclasses import replace

import numpy as np
import pytest
from mounted import MEASURED, contacts, flown_postures, mounted
from subsets import fast_subset, slow_subset
from wheels import layout_device, paper_device

from ocs_design.common.errors import SpecificationError
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.froude import default_envelope
from ocs_design.robot.clearance import landing_ranges, sampled_postures
from ocs_design.robot.manual import robot_by_hand
from ocs_design.sizing.mounting import mounting_of, mounting_open_points, placement_warnings

BOX = robot_by_hand(6.0, (0.05, 0.05, 0.05))
"""A cube of edge a: I = m a^2 / 6."""
HALF = np.sqrt(0.05) / 2.0


def device_at(x, y, z):
    """The paper's device with lateral axes and wheels at (x, +-y, z)."""
    device = paper_device(0.0)
    left, right = device.modules
    return replace(
        device,
        modules=(
            replace(left, position=np.array([x, y, z])),
            replace(right, position=np.array([x, -y, z])),
        ),
    )


def on_box(x, y, z):
    return mounting_of(BOX, device_at(x, y, z), (), BOX.mass_properties)


@pytest.mark.parametrize(
    ("y", "z", "part", "distance"),
    [
        (0.05, HALF + 0.03 + 0.004, "base", 0.004),
        # Two wheels 10 mm high, centres 13 mm apart.
        (0.0065, HALF + 0.2, "ocs_right_flywheel", 0.003),
    ],
)
def test_clearance_to_the_nearest_part(y, z, part, distance):
    nearest = on_box(0.0, y, z).nearest
    assert nearest.part == part
    assert nearest.distance == pytest.approx(distance, abs=1e-6)


def test_clearance_inside_the_robot_is_negative():
    assert on_box(0.0, 0.04, 0.0).nearest.distance < 0.0


def test_a_robot_without_limbs_has_none_in_reach():
    mounting = on_box(0.0, 0.05, 0.3)
    assert (mounting.landing, mounting.reachable) == (None, ())
    np.testing.assert_array_equal(mounting.com_shift, 0.0)
    np.testing.assert_array_equal(mounting.inertia_change, 0.0)


def test_a_specified_position_that_collides_is_a_warning_and_an_error_if_strict(solo12):
    robot, device = solo12, device_at(0.0, 0.05, 0.03)
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    arguments = (mounting, robot, device, default_envelope(robot))
    (warning,) = placement_warnings(*arguments, specified=True)
    assert "overlaps 'base_link'" in warning
    assert "--position 0.0mm" in warning
    with pytest.raises(SpecificationError, match="--strict: a module overlaps 'base_link'"):
        placement_warnings(*arguments, specified=True, strict=True)


@pytest.mark.parametrize(
    ("name", "option"),
    [
        (LayoutName.SINGLE, "--position X,Y,Z"),
        (LayoutName.TRIAD, "--position, with x, y and z of every wheel"),
        (LayoutName.DOUBLE_PAIR, "--position, with x, y and z of every wheel"),
    ],
)
@pytest.mark.parametrize("specified", fast_subset(2, [False, True]))
def test_the_cure_of_a_collision_names_the_option_for_its_layout(solo12, name, option, specified):
    """Only for a pair a free place is searched where one is specified."""
    robot, device = solo12, layout_device(Layout(name))
    low = [replace(each, position=each.position * [1.0, 1.0, 0.0]) for each in device.modules]
    device = replace(device, modules=tuple(low))
    mounting = mounting_of(robot, device, (), robot.mass_properties)
    (warning,) = placement_warnings(
        mounting, robot, device, default_envelope(robot), specified=specified
    )
    assert warning.endswith(f"with {option}")
    assert ("no free place was found" in warning) is not specified
    *_, collision = mounting_open_points(mounting)
    assert collision.cure == f"give another place with {option}"


@pytest.mark.parametrize("name", fast_subset(4, MEASURED[::2]))
def test_mujoco_sees_no_contact_of_device_and_robot(name):
    """In the nominal posture and in new random postures of the landing ranges."""
    robot, device, mounting = mounted(name)
    assert mounting.nearest.distance > 0.0
    assert mounting.landing.distance > 0.0
    postures = [{}, *sampled_postures(landing_ranges(robot), 700)[-150:]]
    for mounted_device in (device, device.at_incidence(0.0)):
        assert contacts(robot, mounted_device, postures) == []


def test_mujoco_sees_contact_where_a_limb_can_reach():
    robot, device, mounting = mounted("solo_description/robots/solo12")
    assert len(mounting.reachable) == 4
    # As designed, and turned by hand for the back-flip.
    incidences = (device.incidence, 0.0)
    for reach in mounting.reachable:
        touched = [contacts(robot, device.at_incidence(a), [reach.joints]) for a in incidences]
        assert any(reach.part in bodies for bodies in touched)


@pytest.mark.parametrize("name", slow_subset(6, MEASURED))
def test_mujoco_sees_no_contact_in_the_flights(name):
    """Postures of the legs as simulated, from lift-off to the end of a flight that passes."""
    robot, device, _ = mounted(name)
    postures = flown_postures(name)
    assert len(postures) > 100
    assert contacts(robot, device, postures) == []
