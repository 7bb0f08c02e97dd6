"""Bearing moment against the change of momentum in the world, by finite differences."""

import numpy as np
import pytest
from driven_wheels import EC45, driven_wheel
from scipy.spatial.transform import Rotation

from ocs_design.device.layout import module_axes
from ocs_design.sizing.margins import SampledMotion, bearing_moment

AXES = module_axes(np.radians(35.0))


def steady(rate, speed):
    """A single instant without acceleration."""
    rate = np.asarray([rate], dtype=float)
    speeds = np.full((1, 2), speed)
    return SampledMotion(np.zeros(1), speeds, np.zeros((1, 2)), rate, np.zeros((1, 3)))


def test_gyroscopic_moment_of_a_fast_wheel_on_a_rolling_trunk():
    """h W w: EC 45 with the paper's rim at 700 rad/s, the trunk at 5 rad/s across its axis."""
    wheel = driven_wheel()
    moment = bearing_moment(steady([5.0, 0.0, 0.0], 700.0), module_axes(0.0), wheel)
    # 7.2346e-5 from the rim (8000 kg/m^3) and 1.81e-5 from the rotor.
    assert moment == pytest.approx(np.full((1, 2), 9.0446e-5 * 700.0 * 5.0), rel=1e-3)


def test_no_moment_on_a_trunk_that_turns_about_the_axis():
    moment = bearing_moment(steady(AXES[:, 0], 700.0), AXES, driven_wheel())
    assert moment[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert moment[0, 1] > 0.01


def attitude(t):
    """Attitude of a trunk that turns about all axes."""
    return Rotation.from_euler("zyx", [0.3 * np.sin(2 * t), 1.2 * t**2, 0.7 * t])


def wheel_angle(t):
    return 40.0 * t + 15.0 * t**2


def rate_in_world(orientation, t, step):
    """Angular velocity by finite differences of the rotation."""
    change = orientation(t + step) * orientation(t - step).inv()
    return change.as_rotvec() / (2.0 * step)


def rotor(t, axis):
    """Orientation of a wheel whose own z axis is the spin axis."""
    onto_axis = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])[0]
    return attitude(t) * Rotation.from_rotvec(wheel_angle(t) * axis) * onto_axis


def momentum(t, axis, inertia, step):
    """Momentum in the world, from the wheel's own inertia and rate alone."""
    rotation = rotor(t, axis).as_matrix()
    rate = rate_in_world(lambda u: rotor(u, axis), t, step)
    return rotation @ inertia @ rotation.T @ rate


@pytest.mark.parametrize("side", [0, 1])
def test_against_the_momentum_of_a_solid_wheel_in_the_world(side):
    wheel = driven_wheel(motor=EC45)
    t, step = 0.4, 1e-4
    axis = AXES[:, side]
    transverse, axial = wheel.wheel.transverse_inertia, wheel.wheel.axial_inertia
    inertia = np.diag([transverse] * 2 + [axial + wheel.rotor_inertia])
    torque = (momentum(t + step, axis, inertia, step) - momentum(t - step, axis, inertia, step)) / (
        2.0 * step
    )
    in_trunk = attitude(t).inv().apply(torque)
    across = np.linalg.norm(in_trunk - (in_trunk @ axis) * axis)

    def rate(u):
        return attitude(u).inv().apply(rate_in_world(attitude, u, step))

    acceleration = (rate(t + step) - rate(t - step)) / (2.0 * step)
    speed = np.full((1, 2), 40.0 + 30.0 * t)
    motion = SampledMotion(
        np.array([t]), speed, np.zeros((1, 2)), rate(t)[None], acceleration[None]
    )
    assert bearing_moment(motion, AXES, wheel)[0, side] == pytest.approx(across, rel=1e-5)
