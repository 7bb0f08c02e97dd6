import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ocs_design.common import quaternions

angles = st.floats(-3.0, 3.0)


def wxyz(rotation: Rotation):
    return rotation.as_quat(scalar_first=True)


@given(st.tuples(angles, angles, angles), st.tuples(angles, angles, angles))
def test_products_matrices_and_inverses_agree_with_scipy(first, second):
    a, b = Rotation.from_rotvec(first), Rotation.from_rotvec(second)
    product = quaternions.product(wxyz(a), wxyz(b))
    np.testing.assert_allclose(quaternions.matrix(product), (a * b).as_matrix(), atol=1e-12)
    inverse = quaternions.matrix(quaternions.conjugate(wxyz(a)))
    np.testing.assert_allclose(inverse, a.inv().as_matrix(), atol=1e-12)


@given(st.tuples(angles, angles, angles))
def test_the_vertical_agrees_with_scipy(vector):
    rotation = Rotation.from_rotvec(vector)
    expected = rotation.inv().apply([0.0, 0.0, 1.0])
    np.testing.assert_allclose(quaternions.vertical(wxyz(rotation)), expected, atol=1e-12)


@given(st.floats(-1.5, 1.5), st.floats(-1.0, 1.0), angles)
def test_tilt_is_roll_and_pitch_at_any_heading(pitch, roll, yaw):
    only_pitch = wxyz(Rotation.from_euler("ZY", [yaw, pitch]))
    np.testing.assert_allclose(quaternions.tilt(only_pitch), (0.0, pitch), atol=1e-12)
    only_roll = wxyz(Rotation.from_euler("ZX", [yaw, roll]))
    np.testing.assert_allclose(quaternions.tilt(only_roll), (roll, 0.0), atol=1e-12)


@given(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4), angles)
def test_heading_is_the_twist_about_the_vertical(roll, pitch, yaw):
    swing = Rotation.from_rotvec([roll, pitch, 0.0])
    rotation = wxyz(swing * Rotation.from_rotvec([0.0, 0.0, yaw]))
    difference = quaternions.heading(rotation) - yaw
    np.testing.assert_allclose(np.cos(difference), 1.0, atol=1e-12)


def test_pitch_can_be_unwrapped_through_a_flip():
    angle = np.linspace(0.0, -2.0 * np.pi, 50)
    _, pitch = quaternions.tilt(quaternions.from_axis_angle(np.array([0.0, 1.0, 0.0]), angle))
    np.testing.assert_allclose(np.unwrap(pitch), angle, atol=1e-12)
