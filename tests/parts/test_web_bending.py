"""A wheel's web under a push along its axis."""

from math import log, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_bvp

from ocs_design.parts.rim import HoleRing
from ocs_design.parts.web_bending import bent_web

STEEL = {"elastic_modulus": 193e9, "poisson_ratio": 0.28}


@given(st.floats(0.005, 0.04), st.floats(1.3, 8.0), st.floats(0.8e-3, 3e-3))
def test_a_full_web_is_a_plate_with_guided_edges(hub, ratio, thickness):
    """Its slope is f = A r + B / r + F r (2 log r - 1) / (8 pi D), zero at both edges."""
    bore, force, nu = ratio * hub, 100.0, STEEL["poisson_ratio"]
    plate = STEEL["elastic_modulus"] * thickness**3 / (12.0 * (1.0 - nu**2))
    load = force / (8.0 * pi * plate)
    edges = np.array([[hub, 1.0 / hub], [bore, 1.0 / bore]])
    pushed = [load * r * (2.0 * log(r) - 1.0) for r in (hub, bore)]
    a, b = np.linalg.solve(edges, pushed)

    def rim(r):
        return a * r**2 / 2.0 + b * log(r) - load * r**2 * (log(r) - 1.0)

    def moment(r):
        slope = a - b / r**2 - load * (2.0 * log(r) + 1.0)
        return plate * (slope + nu * (a + b / r**2 - load * (2.0 * log(r) - 1.0)))

    found = bent_web(force, (hub, bore), thickness, **STEEL)
    assert found.deflection == pytest.approx(rim(bore) - rim(hub), rel=3e-3)
    most = max(abs(moment(hub)), abs(moment(bore)))
    assert found.stress == pytest.approx(6.0 * most / thickness**2, rel=3e-3)


def test_holes_make_it_softer_as_a_boundary_value_solver_finds():
    """Go2's web of 1 mm between 15.8 and 64.6 mm, with 134 N: 20 g on 0.68 kg."""
    holes, force, nu = HoleRing(6, 0.0416, 0.0162), 134.0, STEEL["poisson_ratio"]
    plate = STEEL["elastic_modulus"] * 1e-9 / (12.0 * (1.0 - nu**2))

    def rigidity(r):
        cosine = (r**2 + 0.0416**2 - 0.0162**2) / (2.0 * r * 0.0416)
        return plate * (1.0 - 6.0 / pi * np.arccos(np.clip(cosine, -1.0, 1.0)))

    def slopes(r, state):
        slope, moment, _ = state
        turned = moment / (r * rigidity(r)) - nu * slope / r
        return np.stack([turned, rigidity(r) * (slope / r + nu * turned) - force / (2 * pi), slope])

    def ends(low, high):
        return np.array([low[0], high[0], low[2]])

    radii = np.linspace(0.0158, 0.0646, 400)
    solved = solve_bvp(slopes, ends, radii, np.zeros((3, radii.size)), tol=1e-6, max_nodes=20_000)
    assert solved.success
    found = bent_web(force, (0.0158, 0.0646), 1e-3, holes=holes, **STEEL)
    assert found.deflection == pytest.approx(abs(solved.sol(0.0646)[2]), rel=2e-3)
    at_hub = 6.0 * abs(solved.sol(0.0158)[1]) / 0.0158 / 1e-6
    assert found.stress == pytest.approx(at_hub, rel=2e-3)
    full = bent_web(force, (0.0158, 0.0646), 1e-3, **STEEL)
    assert 1.2 * full.deflection < found.deflection < 1.7 * full.deflection
    assert found.stress == pytest.approx(139.8e6, rel=1e-3)
