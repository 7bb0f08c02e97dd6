"""Why motors are rejected: the largest wheel that a refusal names, against brute force."""

from dataclasses import replace

import numpy as np
import pytest
from naive_wheel import Rims
from rims import STEEL, UNLIMITED, envelope_with
from selections import ALUMINIUM, random_problem

from ocs_design.sizing.bound.rim_problem import BORE_SHARE
from ocs_design.sizing.selection.problem import Reason
from ocs_design.sizing.selection.rejections import CONSTRAINTS, largest_wheel

RADIUS, HEIGHT = 0.05, 0.015
STEPS = 20_000


def largest_by_brute_force(limits, web):
    """Largest spin inertia of rims of every bore, as wide and as tall as the limits permit."""
    outer = limits.outer_radius_max
    bores = np.linspace(
        max(limits.inner_radius_min, BORE_SHARE * outer), outer - limits.wall_min, STEPS
    )
    largest = 0.0
    for material in (STEEL, ALUMINIUM):
        radii = np.broadcast_to(outer, bores.shape), bores
        tall = Rims(*radii, np.full_like(bores, limits.height_max), material.density)
        fraction = np.minimum(1.0, limits.mass_max / tall.body[0])
        rims = Rims(*radii, fraction * limits.height_max, material.density)
        inertia = rims.body[1] + (rims.web(material.density)[1] if web else 0.0)
        largest = max(largest, float(inertia.max()))
    return largest


@pytest.mark.parametrize("web", [False, True])
@pytest.mark.parametrize(
    ("mass", "bore", "wall"),
    [
        (UNLIMITED, 0.0, 0.0),
        (UNLIMITED, 0.4 * RADIUS, 0.1 * RADIUS),
        (0.4, 0.1 * RADIUS, 0.05 * RADIUS),
        (0.1, 0.1 * RADIUS, 0.5 * RADIUS),
    ],
    ids=["envelope only", "a bore", "a mass", "a mass and a wall"],
)
def test_largest_wheel_agrees_with_brute_force(mass, bore, wall, web):
    limits = envelope_with(RADIUS, HEIGHT, mass_max=mass, inner_radius_min=bore, wall_min=wall)
    problem = replace(random_problem(9), web=web)
    largest = largest_by_brute_force(limits, web)
    # Between two bores of the grid it may be larger by one step.
    assert largest_wheel(problem, limits) == pytest.approx(largest, rel=4.0 / STEPS)


def test_bore_and_wall_that_leave_no_rim_have_no_largest_wheel():
    limits = envelope_with(RADIUS, HEIGHT, inner_radius_min=0.6 * RADIUS, wall_min=0.5 * RADIUS)
    assert largest_wheel(random_problem(9), limits) == 0.0


def test_every_reason_is_a_constraint_of_a_refusal():
    assert set(CONSTRAINTS) == set(Reason)
