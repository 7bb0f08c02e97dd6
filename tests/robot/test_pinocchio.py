"""The URDF reader against Pinocchio, on every robot of example-robot-data that Pinocchio loads."""

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from mass_oracles import pinocchio_mass_properties
from pinocchio_robots import configuration, free_model
from robots import ALL_URDFS, ROBOTS, one_per_folder

from ocs_design.robot.tree import JointKind, Tree
from ocs_design.robot.urdf import read_urdf

POSTURES = 10
RELATIVE = 1e-12
UNEXPANDED_XACRO = "ur3.urdf"
LOADED = [path for path in ALL_URDFS if path.name != UNEXPANDED_XACRO]


def random_posture(tree: Tree, rng: np.random.Generator) -> dict[str, float]:
    """Values within the limits, or within half a turn or 0.1 m where these are wider."""
    posture = {}
    for name, joint in tree.joints.items():
        limit = np.pi if joint.kind is JointKind.REVOLUTE else 0.1
        lower, upper = max(joint.lower, -limit), min(joint.upper, limit)
        posture[name] = rng.uniform(min(lower, upper), max(lower, upper))
    return tree.complete(posture)


def worst_difference(model: pin.Model, tree: Tree, posture: dict[str, float]) -> float:
    """Largest of the relative differences of mass, centre of mass and locked inertia."""
    theirs = pinocchio_mass_properties(model, configuration(model, posture))
    ours = tree.locked_mass_properties(posture, tree.bodies[0].name)
    return max(
        abs(ours.mass - theirs.mass) / theirs.mass,
        float(np.abs(ours.com - theirs.com).max() / theirs.gyration_radius),
        float(np.abs(ours.inertia - theirs.inertia).max() / np.abs(theirs.inertia).max()),
    )


@pytest.mark.parametrize("path", one_per_folder(LOADED))
def test_mass_com_and_inertia_agree(path: Path, record_property):
    model = free_model(path)
    tree = read_urdf(path.read_bytes(), find_mesh=lambda _: None)
    assert set(model.names[2:]) == set(tree.joints)
    rng = np.random.default_rng(0)
    postures = [tree.complete({}), *(random_posture(tree, rng) for _ in range(POSTURES))]
    worst = max(worst_difference(model, tree, posture) for posture in postures)
    record_property("worst_relative_difference", worst)
    assert worst < RELATIVE


def test_link_frames_stand_where_pinocchio_has_them():
    path = ROBOTS / "talos_data" / "robots" / "talos_full_v2.urdf"
    model = free_model(path)
    tree = read_urdf(path.read_bytes(), find_mesh=lambda _: None)
    posture = random_posture(tree, np.random.default_rng(1))
    data = model.createData()
    pin.framesForwardKinematics(model, data, configuration(model, posture))
    placements = tree.placements(posture)
    for name, index in tree.body_of_link.items():
        ours = placements[index] @ tree.bodies[index].links[name]
        theirs = data.oMf[model.getFrameId(name, pin.FrameType.BODY)]
        np.testing.assert_allclose(ours.rotation, theirs.rotation, atol=1e-12)
        np.testing.assert_allclose(ours.position, theirs.translation, atol=1e-12)


def test_joint_limits_and_drives_are_those_of_pinocchio():
    path = ROBOTS / "g1_description" / "urdf" / "g1_29dof_rev_1_0.urdf"
    model = free_model(path)
    tree = read_urdf(path.read_bytes(), find_mesh=lambda _: None)
    for index in range(2, model.njoints):
        ours, q, v = tree.joints[model.names[index]], model.joints[index].idx_q, model.idx_vs[index]
        assert ours.lower == model.lowerPositionLimit[q]
        assert ours.upper == model.upperPositionLimit[q]
        assert ours.effort == model.upperEffortLimit[v]
        assert ours.velocity == model.upperVelocityLimit[v]
