"""Rim problems for tests: the paper's, and random ones in which each limit is active in some."""

import numpy as np
from hypothesis import strategies as st
from numpy import pi

from ocs_design.catalogue.materials import Material
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.bound.rim_problem import RimProblem

PAPER_STEEL = Material(name="stainless-paper", density=7860.0, source="Roscia 2023, Table 2")
STEEL = Material(
    name="steel", density=7850.0, yield_strength=250e6, ultimate_strength=400e6,
    poisson_ratio=0.3, source="for tests",
)  # fmt: skip
UNLIMITED = float("inf")


def envelope_with(outer_radius_max, height_max, **others):
    """An envelope without limits other than those given."""
    limits = {
        "inner_radius_min": 0.0,
        "height_min": 0.0,
        "wall_min": 0.0,
        "mass_max": UNLIMITED,
        "stress_safety": 1.0,
    }
    return Envelope(outer_radius_max, height_max=height_max, **(limits | others))


def utilization(problem, inner, outer, height, mass):
    """Utilization of each limit by a rim, by name; all are at most 1 for a feasible one."""
    limits, material = problem.envelope, problem.material
    nu, speed = material.poisson_ratio, problem.wheel_speed
    stress = material.density * speed**2 / 4.0 * ((3.0 + nu) * outer**2 + (1.0 - nu) * inner**2)
    return {
        "r_max": outer / limits.outer_radius_max,
        "r_min": limits.inner_radius_min / np.maximum(inner, 1e-12),
        "h_max": height / limits.height_max,
        "h_min": limits.height_min / height,
        "wall_min": limits.wall_min / (outer - inner),
        "wheel_mass_max": mass / limits.mass_max,
        "hoop_stress": stress / problem.hoop_stress_max,
    }


def paper_problem(spin_inertia, outer_radius_max, height_max):
    """A case of docs/theory.md, The rim."""
    return RimProblem(spin_inertia, envelope_with(outer_radius_max, height_max), PAPER_STEEL, 754.0)


def scaled_problem(*, size, slim, fill, bore, flat, wall, mass, stress):
    """A problem from figures of order one, so that each limit may be active or not.

    `size` is r_max, `slim` is h_max over r_max, `fill` the spin inertia over that of a solid disc;
    `bore`, `flat` and `wall` are lower limits over upper ones; `mass` and `stress` are limits over
    the values of thin rings.
    """
    height, speed = slim * size, 900.0
    spin = fill * pi * STEEL.density * height * size**4 / 2.0
    ring_stress = STEEL.density * (speed * size) ** 2
    envelope = Envelope(
        outer_radius_max=size,
        inner_radius_min=bore * size,
        height_max=height,
        height_min=flat * height,
        wall_min=wall * size,
        mass_max=mass * spin / size**2,
        stress_safety=STEEL.yield_strength / (stress * ring_stress),
    )
    return RimProblem(spin, envelope, STEEL, speed)


def random_problem(rng):
    """A random `scaled_problem`; every limit is absent in some."""
    return scaled_problem(
        size=rng.uniform(0.02, 0.2),
        slim=rng.uniform(0.1, 0.6),
        fill=10.0 ** rng.uniform(-2.0, 0.05),
        bore=rng.choice([0.0, rng.uniform(0.1, 0.7)]),
        flat=rng.choice([0.0, rng.uniform(0.1, 0.9)]),
        wall=rng.choice([0.0, rng.uniform(0.02, 0.5)]),
        mass=rng.choice([UNLIMITED, rng.uniform(1.0, 2.5)]),
        stress=rng.choice([100.0, rng.uniform(0.3, 1.5)]),
    )


def _absent_or(low, high):
    return st.one_of(st.just(0.0), st.floats(low, high))


def rim_problems():
    """Random scaled problems, as a Hypothesis strategy."""
    return st.builds(
        scaled_problem,
        size=st.floats(0.02, 0.2),
        slim=st.floats(0.1, 0.6),
        fill=st.floats(-2.0, 0.05).map(lambda power: 10.0**power),
        bore=_absent_or(0.1, 0.7),
        flat=_absent_or(0.1, 0.9),
        wall=_absent_or(0.02, 0.5),
        mass=st.one_of(st.just(UNLIMITED), st.floats(1.0, 2.5)),
        stress=st.one_of(st.just(100.0), st.floats(0.3, 1.5)),
    )
