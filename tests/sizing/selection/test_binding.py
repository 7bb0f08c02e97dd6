"""Which limits a module is held by."""

from dataclasses import replace

import numpy as np
import pytest
from rims import STEEL

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.parts.module import Printed
from ocs_design.requirement.device_sections import Envelope
from ocs_design.sizing.bound.rim_problem import RimProblem, limits_with_web
from ocs_design.sizing.lightest_module import (
    HOUSING,
    binding_limits,
    lightest_module,
    lightest_module_at,
)

ROOM = Envelope(
    outer_radius_max=0.03, inner_radius_min=0.005, height_max=0.01, height_min=0.002,
    wall_min=0.001, mass_max=np.inf, stress_safety=2.0,
)  # fmt: skip
LIMITS = RimProblem(7.11e-5, ROOM, STEEL, 100.0).limits
SHELL = Printed(mount_reach=0.0)
MODULE = lightest_module(np.array([7.11e-5]), LIMITS, SHELL)


def test_as_wide_and_as_tall_as_may_be():
    assert binding_limits(MODULE.take(0), LIMITS, ROOM) == ("r_max", "h_max")


@pytest.mark.parametrize("off", [4e-6, -4e-6])
def test_a_dimension_found_to_few_digits_still_touches_its_limit(off):
    near = replace(MODULE, outer_radius=MODULE.outer_radius * (1.0 + off))
    assert "r_max" in binding_limits(near.take(0), LIMITS, ROOM)


def test_a_dimension_that_is_off_its_limit_is_held_by_its_housing():
    room = replace(LIMITS, outer_radius_max=0.03 * 1.0001)
    assert binding_limits(MODULE.take(0), room, ROOM) == ("h_max", HOUSING)


def test_hub_and_web_are_named_where_they_ask_for_more_than_was_specified():
    seated = limits_with_web(LIMITS, 0.02 - LIGAMENT)
    module = replace(
        lightest_module_at(np.array([2e-5]), 0.03, seated, SHELL),
        inner_radius=np.array([0.02]),
        height=np.atleast_1d(seated.height_min),
    )
    named = binding_limits(module.take(0), seated, replace(ROOM, height_min=0.001))
    assert {"hub", "web"} <= set(named)
    assert not {"r_min", "h_min"} & set(named)


def test_a_motor_whose_mount_asks_for_a_wider_housing_is_named():
    mounted = replace(LIMITS, outer_radius_min=0.03)
    assert binding_limits(MODULE.take(0), replace(mounted, outer_radius_max=0.04), ROOM) == (
        "h_max",
        "mount",
    )
