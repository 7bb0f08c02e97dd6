"""What is said of a design that may not do what it was sized for."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ocs_design.design_file import read_design
from ocs_design.report.doubts import LOPSIDED, doubts

DESIGN = Path(__file__).parents[1] / "data" / "design_0_1_0.json"


def lopsided(share, incidence):
    """A design whose pure pitch takes this share of its momentum about roll, and pitches alone."""
    design = read_design(DESIGN)
    cross = share * 2.0
    inertia = ((1.0, cross, 0.0), (cross, 2.0, 0.0), (0.0, 0.0, 2.0))
    demand = replace(
        design.requirement.demands[0],
        source="drop",
        incidence=incidence,
        roll_momentum=0.0,
        pitch_momentum=1.0,
    )
    return replace(
        design,
        ocs=replace(design.ocs, total_inertia=inertia, incidence=incidence),
        requirement=replace(design.requirement, demands=(demand,)),
    )


def test_wheels_that_hardly_roll_cannot_hold_a_lopsided_trunk():
    (said,) = doubts(lopsided(0.08, np.radians(6.6)))
    assert said.startswith("drop: robot and device are lopsided")
    extra = 0.08 / np.tan(np.radians(6.6))
    assert f"8% of its momentum about roll too, at 6.6 deg {extra:.0%} more" in said
    angle = np.degrees(np.arctan(0.08 / LOPSIDED))
    assert f"--alpha {angle:.0f}deg" in said


def test_wheels_that_roll_well_enough_can():
    assert not list(doubts(lopsided(0.08, np.radians(25.0))))


def test_a_symmetric_robot_is_not_doubted():
    assert not list(doubts(lopsided(0.0, np.radians(6.6))))
