"""The example robot has the names and mass properties of the public description of Solo12."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio
import pytest
from mass_oracles import assert_same_mass_properties, pinocchio_mass_properties
from pinocchio_robots import configuration
from robots import SOLO12

EXAMPLE = Path(__file__).parents[2] / "examples" / "solo12.urdf"
TOLERANCE = 1e-9

KNEES_OUT = {"F": {"HFE": 0.8, "KFE": -1.6}, "H": {"HFE": -0.8, "KFE": 1.6}}
POSTURES = {
    "zero": lambda leg, joint: 0.0,
    "stand": lambda leg, joint: KNEES_OUT[leg[0]].get(joint, 0.0),
    "legs spread": lambda leg, joint: 0.9 if leg[1] == "L" and joint == "HAA" else -0.3,
    "folded": lambda leg, joint: {"HAA": 0.0, "HFE": 1.5, "KFE": -3.0}[joint],
    # Without symmetry, so that the wrong sign of one leg is not cancelled by another leg.
    "asymmetric": lambda leg, joint: (
        0.37 * ("FL", "FR", "HL", "HR").index(leg) - 0.61 * ("HAA", "HFE", "KFE").index(joint)
    ),
}


@pytest.fixture(scope="module")
def example():
    return pinocchio.buildModelFromUrdf(str(EXAMPLE), pinocchio.JointModelFreeFlyer())


@pytest.fixture(scope="module")
def public():
    return pinocchio.buildModelFromUrdf(str(SOLO12), pinocchio.JointModelFreeFlyer())


def composite(model, angle_of):
    """Mass properties with locked joints and the trunk at the origin."""
    angles = {name: angle_of(*name.split("_")) for name in model.names[2:]}
    return pinocchio_mass_properties(model, configuration(model, angles))


@pytest.mark.parametrize("posture", POSTURES)
def test_composite_inertia_is_that_of_the_public_robot(example, public, posture):
    actual, expected = (composite(model, POSTURES[posture]) for model in (example, public))
    assert_same_mass_properties(actual, expected, TOLERANCE)


def test_inertias_are_those_of_the_theory(example):
    """The locked inertias that docs/theory.md quotes."""
    zero, stand = (composite(example, POSTURES[name]) for name in ("zero", "stand"))
    assert stand.mass == pytest.approx(2.50000279, abs=1e-12)
    assert np.diag(zero.inertia) == pytest.approx([0.0367786, 0.0705134, 0.0802918], abs=5e-8)
    assert np.diag(stand.inertia) == pytest.approx([0.0300029, 0.0514912, 0.0680453], abs=5e-8)
    assert stand.com[2] == pytest.approx(-0.0240347, abs=5e-8)


def test_names_and_joint_frames_are_those_of_the_public_robot(example, public):
    assert list(example.names) == list(public.names)
    assert {frame.name for frame in example.frames} == {frame.name for frame in public.frames}
    for ours, theirs in zip(example.jointPlacements, public.jointPlacements, strict=True):
        assert ours.isApprox(theirs, 1e-12)


def test_feet_are_in_the_places_of_the_public_robot(example, public):
    for leg in ("FL", "FR", "HL", "HR"):
        ours, theirs = (m.frames[m.getFrameId(f"{leg}_FOOT")].placement for m in (example, public))
        assert ours.isApprox(theirs, 1e-12)


def test_drives_have_the_published_torque_and_speed():
    motor_constant, current, gear, no_load_speed = 0.025, 12.0, 9.0, 300.0 * 24.0 * np.pi / 30.0
    limits = list(ElementTree.parse(EXAMPLE).iter("limit"))
    assert len(limits) == 12
    for limit in limits:
        assert float(limit.get("effort")) == pytest.approx(motor_constant * current * gear)
        assert float(limit.get("velocity")) == pytest.approx(no_load_speed / gear, rel=1e-3)


def test_the_file_needs_no_mesh():
    shapes = {
        shape.tag for geometry in ElementTree.parse(EXAMPLE).iter("geometry") for shape in geometry
    }
    assert shapes == {"box", "cylinder", "sphere"}
