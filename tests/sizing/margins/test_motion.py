"""Motions are integrated exactly between samples."""

import numpy as np
import pytest

from ocs_design.sizing.margins import SampledMotion, integral
from ocs_design.sizing.trajectory.motion import Trajectory


def trajectory(n=4):
    rng = np.random.default_rng(0)
    return Trajectory(
        time=np.linspace(0.0, 1.0, n),
        vertical=np.tile([0.0, 0.0, 1.0], (n, 1)),
        rate=rng.normal(size=(n, 3)),
        acceleration=rng.normal(size=(n, 3)),
        wheel_speed=rng.normal(size=(n, 2)),
        wheel_torque=rng.normal(size=(n, 2)),
        note="",
    )


def test_a_reference_is_used_unchanged():
    reference = trajectory()
    motion = SampledMotion.along(reference)
    assert np.array_equal(motion.wheel_torque, reference.wheel_torque)
    assert np.ptp(motion.time) == 1.0


def test_a_flown_torque_is_piecewise_constant_and_its_last_value_unused():
    time = np.array([0.0, 0.1, 0.3])
    speed = np.array([[0.0, 0.0], [1.0, 2.0], [5.0, 6.0]])
    torque = np.array([[1.0, 2.0], [3.0, 4.0], [np.nan, np.nan]])
    rate = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.4, 0.0]])
    motion = SampledMotion.flown(time, speed, torque, rate)
    assert np.array_equal(motion.time, [0.0, 0.1, 0.1, 0.3])
    assert np.array_equal(motion.wheel_speed[:, 1], [0.0, 2.0, 2.0, 6.0])
    assert np.array_equal(motion.wheel_torque[:, 0], [1.0, 1.0, 3.0, 3.0])
    assert motion.acceleration[:, :2] == pytest.approx(
        np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 2.0], [0.0, 2.0]])
    )


def test_work_of_a_constant_torque_is_torque_times_angle():
    motion = SampledMotion.flown(
        np.array([0.0, 0.1, 0.3]),
        np.array([[0.0, 0.0], [1.0, 0.0], [5.0, 0.0]]),
        np.array([[1.0, 0.0], [3.0, 0.0], [0.0, 0.0]]),
        np.zeros((3, 3)),
    ).between()
    work = integral((motion.wheel_torque * motion.wheel_speed)[:, 0], motion.time)
    assert work == pytest.approx(1.0 * 0.05 + 3.0 * 0.6, rel=1e-14)


def test_products_of_linear_signals_are_exact():
    """Two linear signals over one interval: the integral of (1 - t)(2 + 4 t) is 7/3 - 2/3."""
    ends = np.array([[1.0, 2.0], [0.0, 6.0]])
    zero = np.zeros((2, 3))
    fine = SampledMotion(np.array([0.0, 1.0]), ends, ends, zero, zero).between()
    product = fine.wheel_speed[:, 0] * fine.wheel_torque[:, 1]
    assert integral(product, fine.time) == pytest.approx(5.0 / 3.0, rel=1e-15)
