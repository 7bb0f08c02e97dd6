"""What stands still of a module: motor, gear, housing and foot."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ocs_design.drive.gear import DIRECT
from ocs_design.drive.motor import Motor
from ocs_design.drive.mounting import BoltCircle, Face, Mounting
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.mesh import part_mesh
from ocs_design.parts.mount import motor_mount
from ocs_design.parts.part import total
from ocs_design.robot.mass_properties import MassProperties, combine
from ocs_design.sizing.carrier import Carrier, drive_moments, standing
from ocs_design.sizing.housing import LID_SCREW

MOTOR = Motor(
    name="m", maker="test", mass=0.12, diameter=0.04, length=0.03, torque_constant=None,
    resistance=None, rated_voltage=None, no_load_speed=None, speed_max=None, peak_torque=None,
    peak_current=None, continuous_torque=None, rotor_inertia=None, source="made up",
    confidence="good",
)  # fmt: skip

UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From the frame of the left wheel, its y axis down, to that of its module."""

MOUNTINGS = (
    None,
    Mounting(0.005, stator=BoltCircle(0.025, 4, "M3"), stator_face=Face.OUTPUT),
    Mounting(stator=BoltCircle(0.016, 2, "M2"), stator_face=Face.OUTPUT),
    Mounting(stator=BoltCircle(0.03, 3, "M2.5"), stator_face=Face.OUTPUT),
)


def made(outer_radius, height, mounting):
    housing = Housing(outer_radius, height, motor_mount(mounting), LID_SCREW)
    return housing_parts(housing), Foot(housing)


def test_a_motor_is_a_solid_cylinder():
    body = Carrier.of(drive_moments(MOTOR, replace(DIRECT, mass=0.03)))
    assert body.mass == pytest.approx(0.15)
    assert body.axial_inertia == pytest.approx(0.12 * 0.02**2 / 2.0)
    across = 0.12 * (0.02**2 / 4.0 + 0.03**2 / 12.0)
    assert (body.transverse_inertia, body.vertical_inertia) == pytest.approx((across, across))


def test_a_disc_without_its_length_and_a_point_without_its_diameter():
    disc = Carrier.of(drive_moments(replace(MOTOR, length=None), DIRECT))
    assert disc.axial_inertia == pytest.approx(2.0 * disc.transverse_inertia)
    dot = Carrier.of(drive_moments(replace(MOTOR, length=None, diameter=None), DIRECT))
    assert (dot.axial_inertia, dot.transverse_inertia) == (0.0, 0.0)


@settings(max_examples=30)
@given(st.floats(0.02, 0.15), st.floats(0.002, 0.06), st.sampled_from(MOUNTINGS))
def test_it_is_what_is_printed_with_its_motor_behind_the_plate(outer_radius, height, mounting):
    shell, foot = made(outer_radius, height, mounting)
    gear = replace(DIRECT, mass=0.02)
    across = MOTOR.mass * (3.0 * 0.02**2 + 0.03**2) / 12.0
    own = np.diag([across, MOTOR.mass * 0.02**2 / 2.0, across])
    behind = MassProperties(MOTOR.mass + 0.02, [0.0, -(foot.back + 0.015), 0.0], own)
    below = foot_part(foot).mass_properties().moved(np.eye(3), [0.0, 0.0, -foot.wheel_height])
    expected = combine([total(shell).moved(UPRIGHT, np.zeros(3)), below, behind])

    motor = replace(MOTOR, mounting=mounting)
    found = standing(motor, gear, outer_radius, height).mass_properties()
    assert found.mass == pytest.approx(expected.mass, rel=1e-12)
    np.testing.assert_allclose(found.com, expected.com, rtol=1e-12, atol=1e-15)
    scale = expected.inertia.max()
    np.testing.assert_allclose(found.inertia, expected.inertia, rtol=1e-9, atol=1e-12 * scale)


@pytest.mark.parametrize("mounting", MOUNTINGS[:2])
def test_it_is_what_the_meshes_weigh(mounting):
    """Meshes have exact masses, and inertias that are out by what polygons are off circles."""
    (drum, lid), foot = made(0.034, 0.004, mounting)
    weightless = replace(MOTOR, mass=0.0, mounting=mounting)
    found = standing(weightless, DIRECT, 0.034, 0.004).mass_properties()
    down = np.array([0.0, 0.0, -foot.wheel_height])
    still = np.zeros(3)
    pieces = [(drum, UPRIGHT, still), (lid, UPRIGHT, still), (foot_part(foot), np.eye(3), down)]
    expected = combine([weighed(*piece) for piece in pieces])
    assert found.mass == pytest.approx(expected.mass, rel=1e-6)
    np.testing.assert_allclose(found.com, expected.com, atol=1e-7)
    np.testing.assert_allclose(found.inertia, expected.inertia, rtol=1e-4, atol=1e-10)


def weighed(part, rotation, position):
    """A part's mesh by its own volume integrals."""
    mesh = part_mesh(part, 256)
    corners = mesh.vertices[mesh.triangles]
    volumes = np.linalg.det(corners) / 6.0
    mass = part.density * volumes.sum()
    com = part.density * np.einsum("t,tkx->x", volumes, corners) / 4.0 / mass
    both = corners.sum(axis=1)
    second = np.einsum("t,tkx,tky->xy", volumes, corners, corners)
    second = part.density * (second + np.einsum("t,tx,ty->xy", volumes, both, both)) / 20.0
    second -= mass * np.outer(com, com)
    own = MassProperties(mass, com, np.trace(second) * np.eye(3) - second)
    return own.moved(rotation, position)


def test_a_body_of_revolution_is_one_by_its_two_inertias_alone():
    plain = Carrier(0.2, 3e-5, 2e-5)
    np.testing.assert_array_equal(plain.inertia, np.diag([2e-5, 3e-5, 2e-5]))
    np.testing.assert_array_equal(plain.mass_properties().com, 0.0)
