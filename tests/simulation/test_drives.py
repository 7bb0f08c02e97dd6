import mujoco
import numpy as np
import pytest
from robots import ROBOTS, SOLO12
from wheels import paper_device

from ocs_design.export.physics import leg_joints
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import WorldBuilder

SELECTED = [
    SOLO12,
    ROBOTS / "a1_description" / "urdf" / "a1.urdf",
    ROBOTS / "hyq_description" / "robots" / "hyq_no_sensors.urdf",
    ROBOTS / "bolt_description" / "robots" / "bolt.urdf",
    pytest.param(
        ROBOTS / "icub_description" / "robots" / "icub.urdf", marks=pytest.mark.slow, id="icub"
    ),
]


def drop_of(robot: Robot) -> World:
    _, drop, _ = default_maneuvers(robot)
    return WorldBuilder(robot, paper_device()).flight(drop, Wheels.BRAKED)


@pytest.mark.parametrize("path", SELECTED, ids=lambda path: path.stem)
def test_drives_are_stable_at_the_time_step(path):
    """Eigenvalues of the joints' own second-order system, against Runge-Kutta's limit of 2.78."""
    robot = read_robot(path)
    world = drop_of(robot)
    model, data = world.model, mujoco.MjData(world.model)
    data.qpos[:] = world.qpos
    mujoco.mj_forward(model, data)
    inverse = np.empty((model.nv, model.nv))
    mujoco.mj_solveM(model, data, inverse, np.eye(model.nv))
    drives = [model.actuator(name).id for name in leg_joints(robot)]
    dofs = [int(model.joint(name).dofadr[0]) for name in leg_joints(robot)]
    inverse = inverse[np.ix_(dofs, dofs)]
    zero, one = np.zeros_like(inverse), np.eye(len(dofs))
    stiffness = inverse @ np.diag(model.actuator_gainprm[drives, 0])
    joint_damping = model.dof_damping[dofs]
    damping = inverse @ np.diag(joint_damping - model.actuator_biasprm[drives, 2])
    poles = np.linalg.eigvals(np.block([[zero, one], [-stiffness, -damping]]))
    assert np.all(poles.real < 0.0)
    assert np.abs(poles).max() * model.opt.timestep < 1.5


def test_joints_of_a_standing_robot_sag_by_less_than_half_a_radian(solo12):
    world = drop_of(solo12)
    model, data = world.model, mujoco.MjData(world.model)
    data.qpos[:], data.ctrl[:] = world.qpos, world.ctrl
    data.qpos[2], data.qpos[3:7] = world.standing_height, (1.0, 0.0, 0.0, 0.0)
    mujoco.mj_step(model, data, 2000)
    sag = np.abs(data.qpos[7:19] - world.qpos[7:19]).max()
    assert 0.01 < sag < 0.5
    assert np.abs(data.qvel).max() < 0.05


def test_legs_are_stiff_enough_for_robot_and_device(solo12):
    """k_p = m g L / 2 by hand; without the device m is the robot's alone."""
    device, drop = paper_device(), default_maneuvers(solo12)[1]
    lengths = [leg.length for leg in solo12.legs for _ in leg.joints]
    for wheels, mass in ((Wheels.BRAKED, device.mass), (Wheels.ABSENT, 0.0)):
        model = WorldBuilder(solo12, device).flight(drop, wheels).model
        stiffness = model.actuator_gainprm[: len(lengths), 0]
        np.testing.assert_allclose(
            np.sort(stiffness), np.sort(0.5 * (solo12.mass + mass) * 9.81 * np.array(lengths))
        )


def test_drives_do_not_exceed_the_joint_effort():
    robot = read_robot(ROBOTS / "a1_description" / "urdf" / "a1.urdf")
    model = drop_of(robot).model
    for name, joint in robot.tree.joints.items():
        np.testing.assert_allclose(model.actuator(name).forcerange, (-joint.effort, joint.effort))


@pytest.mark.slow
def test_joints_outside_the_legs_keep_their_posture():
    """In iCub's file the head has hardly any inertia, and the neck a damping that is too high for
    time steps of a millisecond."""
    robot = read_robot(ROBOTS / "icub_description" / "robots" / "icub.urdf")
    world = drop_of(robot)
    model, data = world.model, mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = world.qpos, world.qvel, world.ctrl
    mujoco.mj_step(model, data, round(1e3 * world.duration))
    others = set(robot.tree.joints) - set(leg_joints(robot))
    assert {"neck_yaw", "torso_pitch", "l_elbow"} <= others
    held = [int(model.joint(name).qposadr[0]) for name in others]
    np.testing.assert_allclose(data.qpos[held], world.qpos[held], atol=1e-3)
