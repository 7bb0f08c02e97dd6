"""Closed forms of solids against handbook figures and laws."""

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given
from hypothesis import strategies as st
from mass_oracles import assert_same_mass_properties
from scipy.integrate import solve_bvp

from ocs_design.common.frames import Placement, rotation_from_rpy
from ocs_design.export.meshes import solid_mesh
from ocs_design.parts.moments import cylinder_mass
from ocs_design.parts.rim import (
    cylinder_spin_inertia,
    cylinder_transverse_inertia,
    hoop_stress,
    stored_energy,
)
from ocs_design.parts.shapes import Rectangle
from ocs_design.parts.solids import Part, Prism, Revolution, hollow_cylinder, revolved
from ocs_design.robot.mass import MassProperties, physical_defect

LENGTHS = st.floats(0.01, 1.0)


def mass_properties_of(solid, density):
    """Mass properties of a solid of this density [kg/m^3]."""
    return Part("solid", density, (solid,)).mass_properties()


@given(LENGTHS, LENGTHS, LENGTHS)
def test_hollow_cylinder_agrees_with_the_formulas_of_the_rim(inner, wall, height):
    outer = inner + wall
    body = mass_properties_of(hollow_cylinder(inner, outer, -height / 2.0, height / 2.0), 7860.0)
    axial = cylinder_spin_inertia(inner, outer, height, 7860.0)
    across = cylinder_transverse_inertia(inner, outer, height, 7860.0)
    mass = cylinder_mass(inner, outer, height, 7860.0)
    assert_same_mass_properties(
        body, MassProperties(mass, np.zeros(3), np.diag([across, across, axial]))
    )


def test_cone():
    # Mass rho pi r^2 h / 3, centre of mass h/4 above the base, 3/10 m r^2 about its axis and
    # 3/80 m (4 r^2 + h^2) across it.
    r, h = 0.3, 0.8
    cone = mass_properties_of(revolved([(0.0, 0.0), (r, 0.0), (0.0, h)]), 1000.0)
    mass = 1000.0 * np.pi * r**2 * h / 3.0
    across = 3.0 / 80.0 * mass * (4.0 * r**2 + h**2)
    inertia = np.diag([across, across, 0.3 * mass * r**2])
    assert_same_mass_properties(cone, MassProperties(mass, np.array([0.0, 0.0, h / 4.0]), inertia))


def test_box_turned_and_moved():
    a, b, c, mass = 0.1, 0.2, 0.3, 1000.0 * 0.1 * 0.2 * 0.3
    rotation, position = rotation_from_rpy(0.3, -0.5, 1.1), np.array([0.4, -0.2, 0.7])
    box = Prism(
        Rectangle(-a / 2, a / 2, -b / 2, b / 2), -c / 2, c / 2, Placement(rotation, position)
    )
    inertia = mass / 12.0 * np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    expected = MassProperties(mass, position, rotation @ inertia @ rotation.T)
    assert_same_mass_properties(mass_properties_of(box, 1000.0), expected)


@pytest.mark.slow
@given(st.lists(st.tuples(st.floats(0.0, 1.0), st.floats(-1.0, 1.0)), min_size=3, max_size=3))
def test_a_revolved_triangle_has_the_mass_of_its_mesh(corners):
    profile = np.array(corners)
    (a, b), (c, d) = profile[1] - profile[0], profile[2] - profile[0]
    area = (a * d - b * c) / 2.0
    assume(abs(area) > 1e-3)
    solid = Revolution(profile if area > 0.0 else profile[::-1])
    body = mass_properties_of(solid, 1.0)
    assert physical_defect(body) is None
    # Pappus: area times the path of its centroid.
    assert body.mass == pytest.approx(2.0 * np.pi * profile[:, 0].mean() * abs(area), rel=1e-12)
    mesh = solid_mesh(solid)
    volume = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).volume
    assert volume == pytest.approx(body.mass, rel=1e-9)


def test_repeated_corners_are_left_out():
    solid = revolved([(0.1, 0.0), (0.2, 0.0), (0.2, 0.0), (0.2, 0.1), (0.1, 0.0)])
    np.testing.assert_array_equal(solid.profile, [[0.2, 0.0], [0.2, 0.1], [0.1, 0.0]])


PAPER = (0.022, 0.030, 0.0100, 7860.0)
SPINNING = {"density": 7850.0, "poisson_ratio": 0.3, "wheel_speed": 800.0}


def test_theory_example():
    assert cylinder_mass(*PAPER) == pytest.approx(0.10273, abs=1e-5)
    assert cylinder_spin_inertia(*PAPER) == pytest.approx(7.108e-5, abs=5e-9)
    assert cylinder_transverse_inertia(*PAPER) == pytest.approx(3.640e-5, abs=5e-9)


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


def test_stored_energy():
    assert stored_energy(7.11e-5, 754.0) == pytest.approx(20.2107, abs=1e-4)
