"""Screws between a motor and its foot: friction, and dowels in holes filled with epoxy."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from ocs_design.actuation.fasteners import BoltedJoint, Fastening, screw
from ocs_design.actuation.motor import Face, build_gaps
from ocs_design.catalogue.motors import motors
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.tightening import MotorGrip, dowel_force, motor_grips

PRESSED = 23.5e6
"""Half of the yield strength of PETG [Pa]."""


def by_limit_analysis(name, through, into=None, cells=100):
    """Largest shear of a dowel in equilibrium that yields nowhere [N], as a linear program.

    Loads per length and moments are limited. The end under the head is free, and so is the other
    one, unless it is held in metal.
    """
    held = screw(name)
    line, plastic = PRESSED * held.diameter, 640e6 * held.stressed_diameter**3 / 6.0
    steps = np.full(cells, through / cells)
    if into is not None:
        steps = np.append(steps, np.full(cells, into / cells))
    ends = np.cumsum(steps)
    arms = np.maximum(ends[:, None] - (ends - steps / 2.0), 0.0)
    shear = np.tri(steps.size) * steps
    moments = shear * arms * line / plastic
    free = {}
    if into is not None:
        free = {"A_eq": np.vstack([shear[-1] / through, moments[-1]]), "b_eq": np.zeros(2)}
    both = np.vstack([moments, -moments])
    found = linprog(-shear[cells - 1] / through, both, np.ones(len(both)), bounds=(-1, 1), **free)
    return -found.fun * through * line


@pytest.mark.parametrize(
    ("name", "through", "into"),
    [
        ("M2", 6.2e-3, 5.8e-3),
        ("M2", 21.9e-3, 8.1e-3),
        ("M3", 21.9e-3, 8.1e-3),
        ("M6", 5.0e-3, 12.0e-3),
        ("M6", 14.0e-3, 6.0e-3),
        ("M5", 4.0e-3, 4.0e-3),
        ("M3", 3.0e-3, None),
        ("M2", 20.0e-3, None),
        ("M6", 8.7e-3, None),
    ],
)
def test_a_dowel_carries_what_limit_analysis_finds(name, through, into):
    assert dowel_force(screw(name), through, into) == pytest.approx(
        by_limit_analysis(name, through, into), rel=0.01
    )


def test_screws_hold_a_motor_by_hand():
    """Six M6 on 62 mm through a floor of 8.7 mm into an EMRAX: 6 x 23.5 MPa x 6 mm x 8.7 mm.

    Their heads press on 4.43 cm^2 / 10 of PETG: 1,040 N, of which 1 / 1.6 is left, times 0.1.
    """
    held = Fastening(screw("M6"), 6, 8.7e-3, BoltedJoint.MOTOR_IN_CAGE)
    grip = MotorGrip(held, 0.031)
    assert grip.filled == pytest.approx(6 * 23.5e6 * 6e-3 * 8.7e-3 * 0.031, rel=1e-9)
    area = np.pi / 4.0 * (10e-3**2 - 6.6e-3**2)
    assert grip.friction == pytest.approx(0.1 * 6 * area * 23.5e6 / 1.6 * 0.031, rel=1e-9)
    assert grip.play == pytest.approx(0.6e-3 / 0.031)


@pytest.mark.parametrize("foot_plate", [PLATE_THICKNESS, 0.015])
def test_light_motors_are_held_against_one_and_a_half_times_their_peak_torque(foot_plate):
    """Those above 4 kg have thick feet, and cages with floors to match."""
    for motor in motors().values():
        if build_gaps(motor) or (motor.mass > 4.0 and foot_plate < 0.01):
            continue
        for grip in motor_grips(mount_of(motor, None, foot_plate)):
            held = max(grip.friction, grip.filled)
            assert held >= 1.5 * motor.peak_torque or motor.mass > 9.0, (motor.name, grip)


def test_the_screws_of_a_cage_grow_with_its_motor():
    """Heads on PETG of 47 MPa under twice the motor at 20 g: M2 to 3.3 kg, M3 from 5.2 to 7.0."""
    emrax, smaller = motors()["188 LV"], motors()["U15 II KV100"]
    sizes = [(emrax, "M3"), (smaller, "M2"), (replace(emrax, mass=3.2), "M2"),
             (replace(emrax, mass=3.4), "M2.5"), (replace(emrax, mass=7.1), "M4")]  # fmt: skip
    for motor, name in sizes:
        mount = mount_of(motor, None, 0.015)
        assert mount.cage.screw.name == mount.holes.screws.thread == name
        (on_plate,) = (
            ring for ring in mount.screwed if ring.fastening.joint is BoltedJoint.CAGE
        )  # fmt: skip
        assert on_plate.fastening.screw.name == name
    # There is no room for ears of the best size between the posts of a narrow cage.
    narrow = replace(motors()["Antigravity MN5006 KV450"], mass=40.0)
    assert mount_of(narrow, None).cage.screw.diameter < 8e-3


def test_webs_clear_the_heads_under_them():
    """Half the rim and 2 mm of clearance, less half the web of 1 mm and the head: 0.5 mm."""
    for motor in motors().values():
        if build_gaps(motor):
            continue
        mount = mount_of(motor, None)
        head = screw(mount.holes.screws.thread).head_height
        assert mount.heads_rim_height / 2.0 + 2e-3 - 0.5e-3 - head >= 0.5e-3 - 1e-12
        if motor.mounting.stator_face is Face.OUTPUT:
            assert mount.heads_rim_height == pytest.approx(2.0 * head - 2e-3)
