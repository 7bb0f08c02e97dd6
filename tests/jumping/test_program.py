"""Splines and derivatives that the program is given, against SciPy's and CasADi's own."""

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
    """Unknowns of all nodes at random, and the load."""
    random = np.random.default_rng(0)
    x = 0.3 * random.normal(size=program._nlp["x"].numel())
    size = (len(x) - 3) // NODES
    x[size - 1 :: size][:NODES] = random.uniform(0.2, 0.4, NODES)
    return x, Load.values(9.81, body.trunk)


def along(program, name, direction):
    """Derivative of the goal or of the constraints along a direction, by forward mode."""
    x, load = program._nlp["x"], program._nlp["p"]
    return ca.Function("along", [x, load], [ca.jtimes(program._nlp[name], x, direction)])


def test_slopes_of_goal_and_constraints(program, point):
    x, _ = point
    for name, option, out in (("f", "grad_f", 1), ("g", "jac_g", 1)):
        given = np.asarray(program._options[option](*point)[out])
        for seed in range(3):
            direction = np.random.default_rng(seed).normal(size=len(x))
            expected = np.asarray(along(program, name, direction)(*point)).ravel()
            found = given.T @ direction if name == "f" else given @ direction
            np.testing.assert_allclose(found.ravel(), expected, rtol=1e-9, atol=1e-8)


def test_curvature_of_the_lagrangian(program, point):
    """Upper triangle, made of squares and of multipliers; here by differentiating the sum twice."""
    x, load = program._nlp["x"], program._nlp["p"]
    on_rows = np.random.default_rng(1).normal(size=program._nlp["g"].numel())
    lagrangian = 0.7 * program._nlp["f"] + ca.dot(on_rows, program._nlp["g"])
    upper = np.asarray(program._options["hess_lag"](*point, 0.7, on_rows))
    whole = upper + np.triu(upper, 1).T
    gradient = ca.gradient(lagrangian, x)
    for seed in range(3):
        direction = np.random.default_rng(seed).normal(size=x.numel())
        twice = ca.Function("twice", [x, load], [ca.jtimes(gradient, x, direction)])
        expected = np.asarray(twice(*point)).ravel()
        scale = np.abs(expected).max()
        np.testing.assert_allclose(whole @ direction, expected, atol=1e-10 * scale)


def test_the_nodes_fill_the_push_off_and_weigh_as_trapezoids():
    assert SHARES[-1] == pytest.approx(1.0)
    assert (np.diff(STEPS) < 0.0).all()
    assert pytest.approx(np.trapezoid(SHARES, SHARES)) == WEIGHTS @ SHARES
