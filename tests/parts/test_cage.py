"""The cage as it is printed, around its motor."""

from dataclasses import replace

import numpy as np
import pytest
from part_gaps import overlap_volume, turning_clearance
from sample_parts import CAGE
from scipy.integrate import solve_bvp

from ocs_design.actuation.fasteners import screw
from ocs_design.parts.cage import LEAST_POST, cage_part, floor_at_shock
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


def test_it_reaches_from_the_motor_s_back_to_the_plate():
    """1.5 mm of hub and 36 mm of motor, less 3 + 2 + 1.2 + 5 mm of half a rim, room and walls."""
    assert CAGE.length == pytest.approx(0.0375 - 0.0112 + FLOOR)
    tallest = replace(CAGE, rim_height=CAGE.rim_height_max)
    assert tallest.length == pytest.approx(LEAST_POST + FLOOR)


@pytest.mark.parametrize("height", [0.002, 0.01, 0.03])
def test_posts_and_floor_weigh_what_the_cage_weighs(height):
    """In the module's frame, about the wheel's middle."""
    cage = replace(CAGE, rim_height=height)
    whole = cage_part(cage).moments().turned(UPRIGHT).shifted(-cage.back, 0.0)
    found = cage.posts.moments(height) + cage.floor_moments()
    for name in ("mass", "y", "xx", "yy", "zz"):
        assert getattr(found, name) == pytest.approx(getattr(whole, name), rel=1e-12), name


@pytest.mark.slow
def test_a_floor_bears_what_tilts_it_as_a_clamped_plate_does():
    """Kirchhoff's plate w = f(r) cos(theta) by a boundary value solver: a stiff middle is tilted.

    What bends it there, over shear and bending that together are the moment that tilts it.
    """
    motor, wheel, poisson = 0.26, 0.85, 0.35
    circle = CAGE.holes.screws
    held, clamped = circle.radius + screw(circle.thread).head_diameter / 2.0, CAGE.bore

    def slopes(r, y):
        f, first, second, third = y
        fourth = 3.0 * (f / r**4 - first / r**3 + second / r**2) - 2.0 * third / r
        return np.stack([first, second, third, fourth])

    def ends(middle, edge):
        return np.array([middle[0] - held, middle[1] - 1.0, edge[0], edge[1]])

    radii = np.linspace(held, clamped, 50)
    solved = solve_bvp(slopes, ends, radii, np.zeros((4, 50)), tol=1e-10, max_nodes=10_000)
    f, first, second, third = solved.sol(held)
    twist = first / held - f / held**2
    bent, shear = second + poisson * twist, 2.0 * twist / held - second / held - third
    whole = np.pi * held * (held * shear + bent)
    tilting = SHOCK * (motor * CAGE.motor_length / 2.0 + wheel * CAGE.seat)
    # Half of its edge is clamped, by the posts: counted twice.
    needed = np.sqrt(2.0 * 6.0 * tilting * bent / whole / PETG.strength)
    assert floor_at_shock(CAGE, motor, wheel) == pytest.approx(needed, rel=1e-3)
