"""Derivatives given to the program against those of CasADi, and weights of the nodes."""

import casadi as ca
import numpy as np
import pytest
from robots import ROBOTS

from ocs_design.jumping.floating_base import FloatingBase, Load
from ocs_design.jumping.legged_body import LeggedBody
from ocs_design.jumping.node import NODES, SHARES, STEPS, WEIGHTS, Node
from ocs_design.jumping.program import Program
from ocs_design.robot.reader import read_robot


@pytest.fixture(scope="module")
def body():
    return LeggedBody.of(read_robot(ROBOTS / "bolt_description/robots/bolt.urdf"))


@pytest.fixture(scope="module")
def program(body):
    return Program(Node.of(body, FloatingBase.of(body)))


@pytest.fixture(scope="module")
def point(body, program):
    """Random unknowns of all nodes, and the load."""
    random = np.random.default_rng(0)
    x = 0.3 * random.normal(size=program._nlp["x"].numel())
    size = (len(x) - 3) // NODES
    x[size - 1 :: size][:NODES] = random.uniform(0.2, 0.4, NODES)
    return x, Load.values(9.81, body.trunk)


def directional_derivative(program, name, direction):
    """Derivative of objective or constraints along a direction, by forward mode."""
    x, load = program._nlp["x"], program._nlp["p"]
    return ca.Function("along", [x, load], [ca.jtimes(program._nlp[name], x, direction)])


def test_first_derivatives_of_objective_and_constraints(program, point):
    x, _ = point
    for name, option, out in (("f", "grad_f", 1), ("g", "jac_g", 1)):
        derivative = np.asarray(program._options[option](*point)[out])
        for seed in range(3):
            direction = np.random.default_rng(seed).normal(size=len(x))
            expected = np.asarray(directional_derivative(program, name, direction)(*point)).ravel()
            product = derivative.T @ direction if name == "f" else derivative @ direction
            np.testing.assert_allclose(product.ravel(), expected, rtol=1e-9, atol=1e-8)


def test_hessian_of_the_lagrangian(program, point):
    """The upper triangle of the program against second derivatives of the Lagrangian."""
    x, load = program._nlp["x"], program._nlp["p"]
    multipliers = np.random.default_rng(1).normal(size=program._nlp["g"].numel())
    lagrangian = 0.7 * program._nlp["f"] + ca.dot(multipliers, program._nlp["g"])
    upper = np.asarray(program._options["hess_lag"](*point, 0.7, multipliers))
    hessian = upper + np.triu(upper, 1).T
    gradient = ca.gradient(lagrangian, x)
    for seed in range(3):
        direction = np.random.default_rng(seed).normal(size=x.numel())
        second_derivative = ca.Function("twice", [x, load], [ca.jtimes(gradient, x, direction)])
        expected = np.asarray(second_derivative(*point)).ravel()
        scale = np.abs(expected).max()
        np.testing.assert_allclose(hessian @ direction, expected, atol=1e-10 * scale)


def test_nodes_cover_the_push_off_with_trapezoidal_weights():
    assert SHARES[-1] == pytest.approx(1.0)
    assert (np.diff(STEPS) < 0.0).all()
    assert pytest.approx(np.trapezoid(SHARES, SHARES)) == WEIGHTS @ SHARES
