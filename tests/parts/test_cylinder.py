"""The hollow cylinder against published figures, quadrature and elasticity."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp

from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import (
    cylinder_spin_inertia,
    cylinder_transverse_inertia,
    hoop_stress,
    stored_energy,
)

PAPER = (0.022, 0.030, 0.0100, 7860.0)
SPINNING = {"density": 7850.0, "poisson_ratio": 0.3, "wheel_speed": 800.0}


def test_theory_example():
    assert cylinder_mass(*PAPER) == pytest.approx(0.10273, abs=1e-5)
    assert cylinder_spin_inertia(*PAPER) == pytest.approx(7.108e-5, abs=5e-9)
    assert cylinder_transverse_inertia(*PAPER) == pytest.approx(3.640e-5, abs=5e-9)


def test_the_papers_height_contradicts_its_own_figures():
    """Table 2 prints m = 1.02e-1, I_xx = 3.64e-5 and I_zz = 7.11e-5 beside h = 1.02e-2."""

    def agrees(height):
        inner, outer, _, density = PAPER
        figures = (
            cylinder_mass(inner, outer, height, density),
            cylinder_transverse_inertia(inner, outer, height, density),
            cylinder_spin_inertia(inner, outer, height, density),
        )
        return np.isclose(figures, (1.02e-1, 3.64e-5, 7.11e-5), rtol=8e-3)

    assert agrees(1.00e-2).all()
    assert not agrees(1.02e-2).any()


def test_against_quadrature():
    inner, outer, height, density = 0.02, 0.07, 0.03, 2700.0

    def shells(weight):
        return quad(lambda x: density * 2.0 * np.pi * x * height * weight(x), inner, outer)[0]

    assert cylinder_mass(inner, outer, height, density) == pytest.approx(shells(lambda x: 1.0))
    spin = shells(lambda x: x**2)
    assert cylinder_spin_inertia(inner, outer, height, density) == pytest.approx(spin)
    across = shells(lambda x: x**2 / 2.0 + height**2 / 12.0)
    assert cylinder_transverse_inertia(inner, outer, height, density) == pytest.approx(across)


def test_arrays():
    inner, outer, height = np.array([0.01, 0.02]), np.array([0.03, 0.04]), np.array([0.01, 0.02])
    found = cylinder_spin_inertia(inner, outer, height, 7860.0)
    for index in range(2):
        alone = cylinder_spin_inertia(inner[index], outer[index], height[index], 7860.0)
        assert found[index] == alone


def test_stresses_against_the_equation_of_elasticity():
    """Solve (r s_r)' - s_t + rho w^2 r^2 = 0 in plane stress, free at both edges."""
    inner, outer, nu = 0.02, 0.05, SPINNING["poisson_ratio"]
    load = SPINNING["density"] * SPINNING["wheel_speed"] ** 2
    modulus = 200e9

    def stresses(x, displacement, slope):
        stiffness = modulus / (1.0 - nu**2)
        radial = stiffness * (slope + nu * displacement / x)
        return radial, stiffness * (displacement / x + nu * slope)

    def equation(x, y):
        curvature = y[0] / x**2 - y[1] / x - load * x * (1.0 - nu**2) / modulus
        return np.vstack([y[1], curvature])

    def edges(ya, yb):
        return np.array([stresses(inner, *ya)[0], stresses(outer, *yb)[0]]) / load

    x = np.linspace(inner, outer, 4001)
    solution = solve_bvp(equation, edges, x, np.zeros((2, x.size)), tol=1e-8, max_nodes=20000)
    radial, tangential = stresses(x, *solution.sol(x))
    assert tangential.argmax() == 0
    assert hoop_stress(inner, outer, **SPINNING) == pytest.approx(tangential.max(), rel=1e-6)
    assert radial.max() < tangential.max()


def test_thin_ring():
    """rho v^2, as any handbook has it."""
    found = hoop_stress(0.05, 0.05, **SPINNING)
    assert found == pytest.approx(7850.0 * (800.0 * 0.05) ** 2, rel=1e-12)


def test_stored_energy():
    assert stored_energy(7.11e-5, 754.0) == pytest.approx(20.2107, abs=1e-4)
