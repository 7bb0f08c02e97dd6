"""Active limits of a module."""

from dataclasses import replace

import numpy as np
import pytest
from rims import STEEL, envelope_with

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.parts.module import Printed
from ocs_design.sizing.bound.rim_problem import RimProblem, limits_with_web
from ocs_design.sizing.lightest_module import (
    HOUSING,
    binding_limits,
    lightest_module,
    lightest_module_at,
)

ENVELOPE = envelope_with(
    0.03, 0.01, inner_radius_min=0.005, height_min=0.002, wall_min=0.001, stress_safety=2.0
)
LIMITS = RimProblem(7.11e-5, ENVELOPE, STEEL, 100.0).limits
SHELL = Printed(mount_reach=0.0)
MODULE = lightest_module(np.array([7.11e-5]), LIMITS, SHELL)


def test_the_lightest_module_is_at_r_max_and_h_max():
    assert binding_limits(MODULE.take(0), LIMITS, ENVELOPE) == ("r_max", "h_max")


@pytest.mark.parametrize("off", [4e-6, -4e-6])
def test_a_dimension_within_tolerance_of_its_limit_is_at_it(off):
    near = replace(MODULE, outer_radius=MODULE.outer_radius * (1.0 + off))
    assert "r_max" in binding_limits(near.take(0), LIMITS, ENVELOPE)


def test_a_dimension_within_its_limit_is_bounded_by_the_housing():
    wider = replace(LIMITS, outer_radius_max=0.03 * 1.0001)
    assert binding_limits(MODULE.take(0), wider, ENVELOPE) == ("h_max", HOUSING)


def test_hub_and_web_are_named_where_they_exceed_the_specified_limits():
    seated = limits_with_web(LIMITS, 0.02 - LIGAMENT)
    module = replace(
        lightest_module_at(np.array([2e-5]), 0.03, seated, SHELL),
        inner_radius=np.array([0.02]),
        height=np.atleast_1d(seated.height_min),
    )
    named = binding_limits(module.take(0), seated, replace(ENVELOPE, height_min=0.001))
    assert {"hub", "web"} <= set(named)
    assert not {"r_min", "h_min"} & set(named)


def test_the_mount_is_named_where_it_needs_a_wider_housing():
    mounted = replace(LIMITS, outer_radius_min=0.03)
    assert binding_limits(MODULE.take(0), replace(mounted, outer_radius_max=0.04), ENVELOPE) == (
        "h_max",
        "mount",
    )
