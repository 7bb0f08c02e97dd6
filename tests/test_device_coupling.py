"""Robots whose mass is to one side: pitch and roll are one turn."""

import numpy as np
import pytest
from wheels import paper_device

from ocs_design.device_warnings import COUPLED, device_warnings
from ocs_design.robot.mass_properties import MassProperties


def told(product, incidence=np.pi / 6.0):
    inertia = np.diag([0.04, 0.09, 0.1])
    inertia[0, 1] = inertia[1, 0] = product * 0.06
    device = paper_device(incidence)
    return " ".join(device_warnings(device, MassProperties(10.0, [0.0, 0.0, 0.0], inertia)))


@pytest.mark.parametrize("product", [0.0, 0.9 * COUPLED, -0.9 * COUPLED])
def test_robots_that_are_nearly_symmetric_are_not_told_of(product):
    assert "I_xy" not in told(product)


def test_what_a_pitch_asks_more_is_that_of_two_equations():
    """Momentum (I_xy, I_yy) theta, shared by the rhombus |L_x| / s + |L_y| / c."""
    sine, cosine, product = 0.5, np.sqrt(0.75), 0.1 * 0.06
    both = abs(product) / sine + 0.09 / cosine
    more = both / (0.09 / cosine) - 1.0
    assert f"up to {more:.0%} more than" in told(-0.1)
    assert "more than twice" in told(0.1, incidence=0.0)
