"""Air drag against exact laminar flows, and where its regimes meet."""

import numpy as np
import pytest
from wheels import PAPER_WHEEL

from ocs_design.simulation.imperfections import (
    AIR_DENSITY,
    AIR_VISCOSITY,
    air_drag,
    cylinder_drag,
    disc_drag,
)

MU = AIR_DENSITY * AIR_VISCOSITY
SPEEDS = np.geomspace(1e-3, 1e4, 2001)


def test_a_disc_close_to_its_walls_drags_as_torsional_couette_flow():
    """Twice the integral of `mu W r / s * r * 2 pi r dr`."""
    radius, gap, slow = 0.05, 5e-4, np.array([0.01, 0.1])
    exact = np.pi * MU * slow * radius**4 / gap
    np.testing.assert_allclose(disc_drag(slow, radius, gap), exact, rtol=1e-12)


def test_a_cylinder_that_turns_slowly_drags_as_couette_flow():
    inner, gap, height, slow = 0.04, 0.002, 0.01, np.array([0.01, 0.1])
    outer = inner + gap
    exact = 4.0 * np.pi * MU * slow * height * (inner * outer) ** 2 / (outer**2 - inner**2)
    np.testing.assert_allclose(cylinder_drag(slow, inner, height, gap), exact, rtol=1e-12)


def short_cylinder_drag(speed, radius, gap):
    return cylinder_drag(speed, radius, 0.01, gap)


@pytest.mark.parametrize("drag", [disc_drag, short_cylinder_drag])
def test_drag_grows_without_jumps_and_faster_than_speed(drag):
    torque = drag(SPEEDS, 0.04, 0.002)
    slope = np.diff(np.log(torque)) / np.diff(np.log(SPEEDS))
    assert np.all((slope > 1.0 - 1e-9) & (slope < 2.0))


def test_a_housing_is_better_than_open_air():
    """von Karman's turbulent free disc, `0.146 Re^-1/5` for both faces: no core turns with it."""
    fast = np.array([2000.0, 4000.0])
    radius = 0.08
    reynolds = fast * radius**2 / AIR_VISCOSITY
    free = 0.146 / reynolds**0.2 * 0.5 * AIR_DENSITY * fast**2 * radius**5
    assert np.all(disc_drag(fast, radius, 0.004) < free)


def test_a_turbulent_gap_drags_as_a_motor_designer_has_it():
    """Touhami's thesis (Toulouse 2020, equations II-70 and II-73) as FAST-OAD_CS23-HE checks it.

    The rotor of 0.1814 m turns 2.8 mm away from its stator at Re = 27082: `C = 0.001487`, of
    `C pi rho W^2 R^4 h`.
    """
    radius, gap, height = 0.0907, 0.0028, 0.01
    speed = np.array([27082.0 * AIR_VISCOSITY / (radius * gap)])
    quoted = 0.001487 * np.pi * AIR_DENSITY * speed**2 * radius**4 * height
    np.testing.assert_allclose(cylinder_drag(speed, radius, height, gap), quoted, rtol=5e-4)


def test_turbulent_faces_drag_as_a_review_has_it():
    """Harmand et al. (2013): `C = 0.051 (s/R)^0.1 Re^-1/5` of each face, boundary layers apart."""
    radius, gap, fast = 0.2, 0.02, np.array([1500.0])
    reynolds = fast * radius**2 / AIR_VISCOSITY
    each = 0.051 * (gap / radius) ** 0.1 / reynolds**0.2 * 0.5 * AIR_DENSITY * fast**2 * radius**5
    np.testing.assert_allclose(disc_drag(fast, radius, gap), 2.0 * each, rtol=1e-12)


def test_the_table_is_the_formula():
    curve = air_drag(PAPER_WHEEL, 0.002)
    between = np.random.default_rng(0).uniform(1.0, 3000.0, 200)
    exact = disc_drag(between, 0.03, 0.002) + cylinder_drag(between, 0.03, 0.01, 0.002)
    np.testing.assert_allclose(curve.at(between), exact, rtol=1e-3)
    assert curve.at(np.zeros(1)) == 0.0
