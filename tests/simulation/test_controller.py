"""The control law of the wheels against the gyrostat's equation and brute force."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from wheels import motor

from ocs_design.device.layout import Layout, LayoutName, module_axes
from ocs_design.requirement.froude import Gains
from ocs_design.simulation.motor_limits import MotorLimits
from ocs_design.simulation.target import Target
from ocs_design.simulation.wheel_law import Allocation, WheelLaw, tilt_error
from ocs_design.sizing.trajectory.gyrostat import Gyrostat

INERTIA = np.array([[0.030, 0.001, 0.003], [0.001, 0.0535, -0.002], [0.003, -0.002, 0.068]])
UNLIMITED = MotorLimits(np.inf, 0.0, np.inf)
angles = st.floats(-1.2, 1.2)
vectors = st.tuples(angles, angles, angles)
spins = st.floats(-800.0, 800.0)


FORTY_DEGREES = np.radians(40.0)


def gyrostat(incidence=FORTY_DEGREES):
    return Gyrostat(INERTIA, module_axes(incidence), 7.1e-5)


def law_of(body, limits=UNLIMITED, allocation=Allocation.PSEUDO_INVERSE, **options):
    return WheelLaw.of(body, Gains(60.0, 12.0), limits, allocation, **options)


def vertical_in(rotation):
    """The vertical in the frame of the trunk, by SciPy."""
    return rotation.inv().apply([[0.0, 0.0, 1.0]])


def level(rate=(0.0, 0.0, 0.0), acceleration=(0.0, 0.0, 0.0)):
    vertical = np.array([[0.0, 0.0, 1.0]])
    on_ground = np.zeros(1, dtype=bool)
    return Target(vertical, np.array([rate]), np.array([acceleration]), np.zeros((1, 1)), on_ground)


NO_RATE, NO_SPEED = (0.0, 0.0, 0.0), (0.0, 0.0)


def torque_of(law, rotation_vector, rate=NO_RATE, speed=NO_SPEED, target=None, period=1e-3):
    """Torque of each wheel of a trunk rotated by a rotation vector; the default target is level."""
    target = level() if target is None else target
    vertical = vertical_in(Rotation.from_rotvec(rotation_vector))
    return law.torque(vertical, np.array([rate]), np.array([speed]), target, period)[0]


def acceleration(body, torque, rate, wheel_speed):
    """Angular acceleration by the gyrostat's equation (docs/theory.md, The robot's inertia)."""
    momentum = body.inertia @ rate + body.spin_inertia * body.axes @ wheel_speed
    return np.linalg.solve(body.actuated_inertia, -body.axes @ torque - np.cross(rate, momentum))


def nearest_target(attitude, target):
    """The target at the heading in which it is nearest to the attitude, by brute force."""
    headings = Rotation.from_rotvec(np.outer(np.linspace(-np.pi, np.pi, 20_001), [0.0, 0.0, 1.0]))
    candidates = headings * target
    return candidates[int(np.argmin((attitude.inv() * candidates).magnitude()))]


@settings(max_examples=25, deadline=None)
@given(vectors, vectors)
def test_the_error_is_the_smallest_rotation_over_all_headings(attitude_vector, target_vector):
    attitude, target = Rotation.from_rotvec(attitude_vector), Rotation.from_rotvec(target_vector)
    shortest = (attitude.inv() * nearest_target(attitude, target)).as_rotvec()
    error = tilt_error(vertical_in(attitude), vertical_in(target))[0]
    np.testing.assert_allclose(error, shortest[:2], atol=1e-3)


@given(angles, angles, st.floats(-3.0, 3.0))
def test_the_error_does_not_depend_on_the_heading(roll, pitch, yaw):
    tilted = Rotation.from_rotvec([roll, pitch, 0.0])
    drifted = Rotation.from_rotvec([0.0, 0.0, yaw]) * tilted
    upright = vertical_in(Rotation.identity())
    np.testing.assert_allclose(
        tilt_error(vertical_in(drifted), upright),
        tilt_error(vertical_in(tilted), upright),
        atol=1e-9,
    )
    np.testing.assert_allclose(
        tilt_error(vertical_in(tilted), upright)[0], [-roll, -pitch], atol=1e-9
    )


@given(vectors, vectors, st.tuples(spins, spins))
def test_the_trunk_gets_the_commanded_roll_and_pitch_acceleration(rotation_vector, rate, spin):
    """For any rates, wheel speeds and products of inertia."""
    body, w, W = gyrostat(), np.array(rate), np.array(spin)
    target = level(rate=(0.3, -0.2, 9.0), acceleration=(1.0, -4.0, 9.0))
    torque = torque_of(law_of(body), rotation_vector, rate, spin, target)
    error = tilt_error(vertical_in(Rotation.from_rotvec(rotation_vector)), target.vertical)[0]
    expected = 60.0 * error + 12.0 * (np.array([0.3, -0.2]) - w[:2]) + np.array([1.0, -4.0])
    np.testing.assert_allclose(acceleration(body, torque, w, W)[:2], expected, rtol=0, atol=1e-8)


@given(vectors, vectors, st.tuples(spins, spins, spins, spins))
def test_a_pyramid_gives_the_commanded_acceleration_about_all_axes(rotation_vector, rate, spin):
    """Its four wheels span all three axes."""
    body = Gyrostat(INERTIA, Layout(LayoutName.PYRAMID).axes(np.radians(35.0)), 7.1e-5)
    target = level(rate=(0.3, -0.2, 0.5), acceleration=(1.0, -4.0, 2.0))
    torque = torque_of(law_of(body), rotation_vector, rate, spin, target)
    tilt = tilt_error(vertical_in(Rotation.from_rotvec(rotation_vector)), target.vertical)[0]
    feedback = 60.0 * np.append(tilt, 0.0) + 12.0 * (target.rate[0] - rate)
    actual = acceleration(body, torque, np.array(rate), np.array(spin))
    np.testing.assert_allclose(actual, feedback + target.acceleration[0], rtol=0, atol=1e-8)


def test_the_transpose_scales_the_torque_by_C_times_its_transpose():
    """C C^T = diag(2 sin^2 a, 2 cos^2 a, 0) (docs/theory.md, The control law)."""
    body = Gyrostat(np.diag([0.03, 0.05, 0.07]), module_axes(np.radians(30.0)), 7e-5)
    torques = {
        allocation: -body.axes @ torque_of(law_of(body, allocation=allocation), (0.1, -0.2, 0.0))
        for allocation in Allocation
    }
    scaled = torques[Allocation.PSEUDO_INVERSE] * [2 * 0.25, 2 * 0.75, 0.0]
    np.testing.assert_allclose(torques[Allocation.TRANSPOSE], scaled, atol=1e-12)


def test_wheels_on_the_pitch_axis_give_no_roll_torque():
    torque = torque_of(law_of(gyrostat(incidence=0.0)), (0.3, 0.0, 0.0))
    assert np.abs(torque).max() < 0.05


@given(
    st.floats(-700.0, 700.0),
    st.floats(-700.0, 700.0),
    st.floats(-3.0, 3.0),
    st.one_of(st.none(), st.floats(0.2, 5.0)),
    st.floats(1e-4, 5e-3),
)
def test_speeds_and_torques_stay_within_the_limits_of_the_motor(left, right, tilt, stall, period):
    body, W = gyrostat(), np.array([left, right])
    limits = MotorLimits.of(motor(no_load_speed=700.0, stall_torque=stall, torque_limit=1.0))
    law = WheelLaw.of(body, Gains(600.0, 12.0), limits, Allocation.PSEUDO_INVERSE)
    torque = torque_of(law, (0.0, tilt, 0.0), speed=W, period=period)
    w_dot = acceleration(body, torque, np.zeros(3), W)
    later = W + period * (torque / body.spin_inertia - body.axes.T @ w_dot)
    assert np.abs(torque).max() <= 1.0
    assert np.abs(later).max() <= 700.0 * (1.0 + 1e-9)
    if stall is not None:
        driving = np.abs(torque[torque * W > 0.0])
        assert np.all(driving <= stall * (1.0 - np.abs(W[torque * W > 0.0]) / 700.0) + 1e-12)


def test_braking_at_full_speed_is_not_limited():
    """The voltage line lets a motor brake with up to twice its stall torque at no-load speed."""
    limits = MotorLimits.of(motor(no_load_speed=700.0, stall_torque=1.0))
    limited, free = (
        torque_of(law_of(gyrostat(), limits=motor_limits), (0.0, 0.1, 0.0), speed=(-700.0, -700.0))
        for motor_limits in (limits, UNLIMITED)
    )
    assert free[0] > 0.0
    np.testing.assert_array_equal(limited, free)


def test_a_law_that_is_off_gives_no_torque():
    torque = torque_of(WheelLaw.off(2), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0))
    np.testing.assert_array_equal(torque, 0.0)


def test_on_the_ground_the_wheels_damp_and_leave_the_attitude_to_the_legs():
    """A constant tilt in stance needs no torque."""
    law, tilt = law_of(gyrostat()), (0.1, -0.25, 0.0)
    in_flight = level(rate=(0.3, -0.2, 0.0), acceleration=(1.0, -4.0, 0.0))
    on_ground = in_flight.landed(np.ones(1, dtype=bool))
    assert np.abs(torque_of(law, tilt, target=in_flight)).max() > 0.1
    np.testing.assert_array_equal(torque_of(law, tilt, target=on_ground), 0.0)
    balancing = torque_of(law_of(gyrostat(), balances=True), tilt, target=on_ground)
    righting = acceleration(gyrostat(), balancing, np.array(NO_RATE), np.array(NO_SPEED))
    error = tilt_error(vertical_in(Rotation.from_rotvec(tilt)), on_ground.vertical)[0]
    np.testing.assert_allclose(righting[:2], 60.0 * error, atol=1e-9)
    turning = np.array([0.4, 0.0, 0.0])
    damped = torque_of(law, tilt, turning, target=on_ground)
    slowing = acceleration(gyrostat(), damped, turning, np.array(NO_SPEED))
    np.testing.assert_allclose(slowing[:2], [-12.0 * 0.4, 0.0], atol=1e-9)
