"""The nearest inertia that MuJoCo accepts."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.robot.mass import MassProperties
from ocs_design.robot.mujoco_bodies import inertial, nearest_physical_moments

FLOOR = 1e-12
MOMENT = st.floats(-1.0, 1.0)


def compiled(mass_properties):
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(**mass_properties).add_freejoint()
    return spec.compile()


CORNERS = 1e-3 * np.array([[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]])
RAYS = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]])
"""Corners and rays of the convex set of physical moments that are no less than 1e-3."""


@given(st.tuples(MOMENT, MOMENT, MOMENT))
def test_moments_are_the_nearest_that_exist(moments):
    """Projection on a convex set: no point of the set lies beyond the nearest one."""
    requested = np.sort(moments)
    nearest = nearest_physical_moments(requested, 1e-3)
    assert nearest.min() >= 1e-3
    assert nearest[0] + nearest[1] >= nearest[2] == nearest.max()
    assert (RAYS @ (requested - nearest)).max() <= 1e-12
    assert ((CORNERS - nearest) @ (requested - nearest)).max() <= 1e-12


@given(st.tuples(*[st.floats(1e-6, 1e3)] * 3))
def test_physical_moments_stay_as_they_are(second_moments):
    """Any three second moments of mass along the axes give moments of a real body."""
    x, y, z = second_moments
    moments = np.sort([y + z, x + z, x + y])
    np.testing.assert_array_equal(nearest_physical_moments(moments, FLOOR), moments)


@pytest.mark.parametrize("excess", [1e-16, 4e-16, 1e-15, 1e-12])
def test_mujoco_accepts_a_plate_that_rounding_has_made_too_flat(excess):
    too_flat = MassProperties(1.0, np.zeros(3), np.diag([1e-3, 1e-3, 2e-3 * (1.0 + excess)]))
    corrected, warning = inertial(too_flat)
    assert warning is None
    expected = np.diag(too_flat.inertia)
    np.testing.assert_allclose(compiled(corrected).body_inertia[1], expected, rtol=1e-9)


def test_full_inertia_survives_the_principal_axes():
    rng = np.random.default_rng(0)
    for _ in range(100):
        points = rng.normal(size=(20, 3)) * [1.0, 2.0, 0.5]
        inertia = sum(p @ p * np.eye(3) - np.outer(p, p) for p in points)
        principal, _ = inertial(MassProperties(2.0, np.array([0.1, 0.2, 0.3]), inertia))
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, principal["iquat"])
        axes = rotation.reshape(3, 3)
        np.testing.assert_allclose(
            axes @ np.diag(principal["inertia"]) @ axes.T, inertia, rtol=1e-12
        )


def test_an_impossible_inertia_is_corrected_with_a_warning():
    corrected, warning = inertial(MassProperties(1.0, np.zeros(3), np.diag([1.0, 1.0, 5.0])))
    np.testing.assert_allclose(corrected["inertia"], [2.0, 2.0, 4.0], rtol=1e-12)
    assert "2, 2, 4 kg m^2" in warning
    compiled(corrected)


def test_a_massless_body_gets_a_tiny_mass():
    corrected, warning = inertial(MassProperties.zero())
    assert corrected["mass"] == 1e-9
    assert warning is not None
    compiled(corrected)
