"""The printed cage around its motor."""

from dataclasses import replace

import numpy as np
import pytest
from part_gaps import overlap_volume, turning_clearance
from sample_parts import CAGE
from scipy.integrate import solve_bvp

from ocs_design.actuation.fasteners import screw
from ocs_design.parts.cage import cage_part, floor_at_shock
from ocs_design.parts.printed import CLEARANCE, FLOOR, PETG, SHOCK, UPRIGHT
from ocs_design.parts.solids import Part, hollow_cylinder

MOTOR = Part(
    "motor", 1.0, (hollow_cylinder(0.0, CAGE.motor_radius, FLOOR, FLOOR + CAGE.motor_length),)
)
TURNING = Part(
    "bell", 1.0, (hollow_cylinder(0.0, CAGE.motor_radius, FLOOR + 2.0 * CLEARANCE, 0.036),)
)


def test_the_motor_stands_on_its_floor_and_turns_freely():
    cage = cage_part(CAGE)
    assert overlap_volume(cage, MOTOR) == pytest.approx(0.0, abs=1e-15)
    assert turning_clearance([TURNING], [cage], 0.01) == pytest.approx(CLEARANCE, abs=5e-6)


def test_the_cage_reaches_from_the_motors_back_to_the_plate():
    """1.5 mm of hub and 36 mm of motor, less 3 + 2 + 1.2 + 5 mm of half rim, gap and walls."""
    assert CAGE.length == pytest.approx(0.0375 - 0.0112 + FLOOR)
    tallest = replace(CAGE, rim_height=CAGE.rim_height_max)
    assert tallest.length == pytest.approx(3.0 * CAGE.screw.diameter + FLOOR)


@pytest.mark.parametrize("height", [0.002, 0.01, 0.03])
def test_moments_of_posts_and_floor_add_up_to_the_cage(height):
    """In the module's frame, about the wheel's centre."""
    cage = replace(CAGE, rim_height=height)
    expected = cage_part(cage).moments().turned(UPRIGHT).shifted(-cage.back, 0.0)
    summed = cage.posts.moments(height) + cage.floor_moments()
    for name in ("mass", "y", "xx", "yy", "zz"):
        assert getattr(summed, name) == pytest.approx(getattr(expected, name), rel=1e-12), name


@pytest.mark.slow
def test_floor_thickness_is_that_of_a_clamped_plate_with_a_tilted_centre():
    """Kirchhoff's plate w = f(r) cos(theta) by a boundary value solver, with a rigid centre.

    Bending at the centre, over shear and bending, which together are the tilting moment.
    """
    motor, wheel, poisson = 0.26, 0.85, 0.35
    circle = CAGE.holes.screws
    inner, outer = circle.radius + screw(circle.thread).head_diameter / 2.0, CAGE.bore

    def slopes(r, y):
        f, first, second, third = y
        fourth = 3.0 * (f / r**4 - first / r**3 + second / r**2) - 2.0 * third / r
        return np.stack([first, second, third, fourth])

    def ends(middle, edge):
        return np.array([middle[0] - inner, middle[1] - 1.0, edge[0], edge[1]])

    radii = np.linspace(inner, outer, 50)
    solution = solve_bvp(slopes, ends, radii, np.zeros((4, 50)), tol=1e-10, max_nodes=10_000)
    f, first, second, third = solution.sol(inner)
    twist = first / inner - f / inner**2
    bending, shear = second + poisson * twist, 2.0 * twist / inner - second / inner - third
    moment = np.pi * inner * (inner * shear + bending)
    load = SHOCK * (motor * CAGE.motor_length / 2.0 + wheel * CAGE.seat)
    # The posts clamp half of the edge: a factor of two.
    needed = np.sqrt(2.0 * 6.0 * load * bending / moment / PETG.strength)
    assert floor_at_shock(CAGE, motor, wheel) == pytest.approx(needed, rel=1e-3)
