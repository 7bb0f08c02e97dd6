"""What is said of robots that are not symmetric to their sagittal plane."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ocs_design.design_file import read_design
from ocs_design.report.coupling import coupling_notes

DESIGN = Path(__file__).parents[1] / "data" / "design_0_1_0.json"


def lopsided(share, incidence, name="drop"):
    """A design whose pure pitch takes this share of its momentum about roll."""
    design = read_design(DESIGN)
    (demand,) = (each for each in design.requirement.demands if each.source == name)
    reached = incidence > 0.0
    asked = replace(
        demand, incidence=incidence, roll_momentum=share if reached else 0.0, pitch_momentum=1.0
    )
    inertia = ((1.0, share * 2.0, 0.0), (share * 2.0, 2.0, 0.0), (0.0, 0.0, 2.0))
    return replace(
        design,
        ocs=replace(design.ocs, total_inertia=inertia),
        requirement=replace(design.requirement, demands=(asked,)),
    )


@pytest.mark.parametrize("name", ["drop", "back-flip"])
def test_what_a_pitch_asks_more_is_that_of_the_rhombus(name):
    """|L_x| / s + |L_y| / c over |L_y| / c."""
    angle = np.radians(6.6)
    (said,) = coupling_notes(lopsided(0.08, angle, name))
    more = 0.08 / np.sin(angle) * np.cos(angle)
    assert f"{name}: robot and device are not symmetric" in said
    assert f"{more:.0%} more of the busier wheel at 6.6 deg" in said


def test_an_axis_out_of_reach_drifts():
    """I_xx w_x = -I_xy w_y: 0.16 of roll per pitch."""
    (said,) = coupling_notes(lopsided(0.08, 0.0))
    assert "do not reach roll" in said
    assert "0.16 deg of roll per degree of pitch" in said


@pytest.mark.parametrize("incidence", [0.0, 0.1])
def test_nothing_is_said_of_symmetric_robots(incidence):
    assert not list(coupling_notes(lopsided(0.0, incidence)))
    assert not list(coupling_notes(lopsided(1e-5, incidence)))


def test_a_push_asks_for_what_it_is():
    assert not list(coupling_notes(lopsided(0.5, 0.1, "disturbance")))
