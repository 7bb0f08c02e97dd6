import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mass_oracles import assert_same_mass_properties

from ocs_design.common.frames import rotation_about, rotation_from_rpy
from ocs_design.common.quaternions import rotation_from_quaternion
from ocs_design.robot.mass import (
    MassProperties,
    ball_density,
    combine,
    impossible_size,
    physical_defect,
)

seeds = st.integers(min_value=0, max_value=2**32 - 1)


def random_cloud(rng: np.random.Generator, count: int = 8) -> MassProperties:
    """Random point masses, which are physical by construction."""
    return combine(
        MassProperties(rng.uniform(0.1, 2.0), rng.uniform(-1, 1, 3), np.zeros((3, 3)))
        for _ in range(count)
    )


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    return rotation_from_quaternion(rng.normal(size=4))


@given(seeds)
def test_transport_and_sum_agree_with_pinocchio(seed):
    rng = np.random.default_rng(seed)
    first, second = random_cloud(rng), random_cloud(rng)
    rotation, shift = random_rotation(rng), rng.normal(size=3)
    ours = combine([first, second.moved(rotation, shift)])
    theirs = pin.Inertia(first.mass, first.com, first.inertia) + pin.SE3(rotation, shift).act(
        pin.Inertia(second.mass, second.com, second.inertia)
    )
    assert_same_mass_properties(ours, MassProperties(theirs.mass, theirs.lever, theirs.inertia))


@given(seeds)
def test_clouds_of_points_have_no_defect(seed):
    assert physical_defect(random_cloud(np.random.default_rng(seed))) is None


def test_points_massless_bodies_and_rounding_are_no_defect():
    point = MassProperties(1.0, np.ones(3), np.zeros((3, 3)))
    lamina = MassProperties(1.0, np.zeros(3), np.diag([0.1, 0.2, 0.3 + 1e-11]))
    dust = MassProperties(0.5, np.zeros(3), np.diag([-5e-20, 0.0, 1e-19]))
    for body in (point, lamina, dust, combine([])):
        assert physical_defect(body) is None


@pytest.mark.parametrize(
    ("density", "message"),
    [(0.0119, "thinner than air"), (0.0121, None), (19_250.0, None), (19_350.0, "tungsten")],
)
def test_a_ball_of_impossible_density_is_refused(density, message):
    """Tungsten has 19,300 kg/m^3, a hundredth of air 0.012; the inertia is 2 m R^2 / 5."""
    radius = 0.3
    mass = density * 4.0 / 3.0 * np.pi * radius**3
    ball = MassProperties(mass, np.zeros(3), 0.4 * mass * radius**2 * np.eye(3))
    assert ball_density(ball) == pytest.approx(density, rel=1e-12)
    reason = impossible_size(ball)
    assert (reason is None) == (message is None)
    assert message is None or message in reason


@given(seeds)
def test_rotations_agree_with_pinocchio(seed):
    rng = np.random.default_rng(seed)
    rpy, angle, xyzw = rng.uniform(-4, 4, 3), rng.uniform(-7, 7), rng.normal(size=4)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    np.testing.assert_allclose(rotation_from_rpy(*rpy), pin.rpy.rpyToMatrix(*rpy), atol=1e-14)
    np.testing.assert_allclose(
        rotation_about(axis, angle), pin.AngleAxis(angle, axis).matrix(), atol=1e-13
    )
    theirs = pin.Quaternion(xyzw / np.linalg.norm(xyzw)).matrix()
    np.testing.assert_allclose(rotation_from_quaternion(np.roll(xyzw, 1)), theirs, atol=1e-14)
