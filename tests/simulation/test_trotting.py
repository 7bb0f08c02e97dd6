"""References of the trot against MuJoCo's kinematics and statics; shoves of a trotting robot."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from robots import ROBOTS
from wheels import paper_device

from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.pushes import Shove
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.trotting import STEP_HEIGHT, require_trot, shove_instant, trot

STRIDE = 0.4
WEIGHT = 27.0
SHOVE = Shove(name="shove", torque=(2.0, 8.0, 0.0), duration=0.05, settling=0.5, stride=STRIDE)


@pytest.fixture(scope="module")
def world(builder):
    return builder.flight(SHOVE, Wheels.ABSENT)


@pytest.fixture(scope="module")
def references(solo12):
    return trot(solo12, STRIDE, start=0.5, duration=2.0, weight=WEIGHT)


@pytest.fixture(scope="module")
def feet_and_forces(solo12, world, references):
    """Feet under a level trunk [m] and forces on them by the torques [N], both (k, legs, 3)."""
    model = world.model
    data = mujoco.MjData(model)
    bodies = [model.body(solo12.tree.bodies[leg.body].name).id for leg in solo12.legs]
    joints = [model.joint(name) for name in references.joints]
    jacobian, feet, forces = np.zeros((3, model.nv)), [], []
    for angles, torques in zip(references.position[::5], references.torque[::5], strict=True):
        data.qpos[:] = world.qpos
        data.qpos[[int(joint.qposadr[0]) for joint in joints]] = angles
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        torque = np.zeros(model.nv)
        torque[[int(joint.dofadr[0]) for joint in joints]] = torques
        for leg, body in zip(solo12.legs, bodies, strict=True):
            point = data.xpos[body] + data.xmat[body].reshape(3, 3) @ leg.foot
            mujoco.mj_jac(model, data, jacobian, None, point, body)
            moved = jacobian[:, 6:].any(axis=0)
            feet.append(point)
            forces.append(np.linalg.solve(jacobian[:, 6:][:, moved].T, -torque[6:][moved]))
    shape = (-1, len(bodies), 3)
    return np.reshape(feet, shape), np.reshape(forces, shape)


def test_feet_lift_straight_up_by_the_step_height(feet_and_forces):
    feet, _ = feet_and_forces
    moved = feet - feet[0]
    assert np.abs(moved[:, :, :2]).max() < 1e-5
    assert moved[:, :, 2].min() > -1e-9
    assert moved[:, :, 2].max(axis=0) == pytest.approx([STEP_HEIGHT] * 4, rel=0.02)


def test_diagonal_feet_lift_together_and_the_others_stand(feet_and_forces):
    lifted = feet_and_forces[0][:, :, 2] - feet_and_forces[0][0, :, 2]
    feet = feet_and_forces[0][0]
    first = feet[:, 0] * feet[:, 1] > 0.0
    np.testing.assert_allclose(np.ptp(lifted[:, first], axis=1), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.ptp(lifted[:, ~first], axis=1), 0.0, atol=1e-9)
    assert np.minimum(lifted[:, first][:, 0], lifted[:, ~first][:, 0]).max() < 1e-9


def test_the_torques_carry_the_weight_on_the_standing_feet(feet_and_forces):
    feet, forces = feet_and_forces
    np.testing.assert_allclose(forces[:, :, 2].sum(axis=1), WEIGHT, rtol=1e-3)
    assert np.abs(forces[:, :, :2]).max() < 0.02 * WEIGHT
    lifted = feet[:, :, 2] - feet[0, :, 2] > 0.5 * STEP_HEIGHT
    later = np.arange(len(feet)) > len(feet) // 2
    assert np.abs(forces[later][lifted[later]]).max() < 1e-3 * WEIGHT


@pytest.mark.parametrize("earliest", [0.0, 0.31, 3.0])
def test_the_shove_starts_when_two_feet_lift(solo12, earliest):
    instant = shove_instant(STRIDE, earliest)
    assert earliest <= instant < earliest + STRIDE
    references = trot(solo12, STRIDE, start=1e-3, duration=instant + 0.1, weight=WEIGHT)
    bent = np.abs(references.position - references.position[0]).max(axis=1)
    before, after = (np.abs(references.time - instant - shift).argmin() for shift in (-0.02, 0.03))
    assert bent[before] < 1e-9
    assert bent[after] > 0.1


@pytest.mark.slow
def test_the_device_reduces_the_swing_of_a_trotting_robot(solo12, world):
    with_device, without = run_scenarios(Flights(solo12, paper_device(), [SHOVE]))
    assert [with_device.passed, without.passed] == [True, True]
    assert with_device.metrics.pitch_swing < 0.9 * without.metrics.pitch_swing
    assert world.stands == shove_instant(STRIDE, 3.0)


def test_feet_leave_the_floor(solo12, world):
    recording = simulate([world], pose_rate=200.0)
    data, feet = mujoco.MjData(world.model), []
    bodies = [world.model.body(solo12.tree.bodies[leg.body].name).id for leg in solo12.legs]
    # The last strides before the shove.
    for pose in recording.qpos[400:680, 0]:
        data.qpos[:] = pose
        mujoco.mj_kinematics(world.model, data)
        rotation = data.xmat[bodies].reshape(-1, 3, 3)
        local = [leg.foot for leg in solo12.legs]
        feet.append(data.xpos[bodies] + np.einsum("nij,nj->ni", rotation, local))
    height = np.array(feet)[:, :, 2]
    assert np.all(np.ptp(height, axis=0) > 0.7 * STEP_HEIGHT)


def test_a_biped_cannot_trot():
    bolt = read_robot(ROBOTS / "bolt_description" / "robots" / "bolt.urdf")
    with pytest.raises(SpecificationError, match="bolt cannot trot: it does not have") as refused:
        require_trot([SHOVE], bolt)
    assert "`stride`" in refused.value.hint
    require_trot([replace(SHOVE, stride=0.0)], bolt)
