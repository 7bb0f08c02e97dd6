"""The symbolic tree against MuJoCo's inverse dynamics, for robots of different conventions."""

import casadi as ca
import mujoco
import numpy as np
import pytest
from robots import ROBOTS

from ocs_design.common.frames import rotation_from_rpy
from ocs_design.jumping.floating_base import FloatingBase, Load
from ocs_design.jumping.legged_body import LeggedBody
from ocs_design.robot.mujoco_bodies import quaternion
from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot

NAMES = (
    "solo_description/robots/solo12",
    "anymal_c_simple_description/urdf/anymal",
    "bolt_description/robots/bolt",
    pytest.param("go1_description/urdf/go1", marks=pytest.mark.slow),
)


@pytest.fixture(scope="module", params=NAMES)
def robot(request):
    return read_robot(ROBOTS / f"{request.param}.urdf")


def rate_matrix(angles):
    """Matrix from the rates of roll, pitch and yaw to the angular velocity in B."""
    (sr, sp, _), (cr, cp, _) = np.sin(angles), np.cos(angles)
    return np.array([[1.0, 0.0, -sp], [0.0, cr, sr * cp], [0.0, -sr, cr * cp]])


def set_motion(data, body, y, v, a):
    """Set MuJoCo's motion, linear in the world and angular in B; return the base's rotation."""
    rotation, matrix, step = rotation_from_rpy(*y[3:6]), rate_matrix(y[3:6]), 1e-6
    ahead, behind = (rate_matrix(y[3:6] + s * step * v[3:6]) for s in (1.0, -1.0))
    matrix_rate = (ahead - behind) / (2.0 * step) @ v[3:6]
    data.qpos[:7] = *y[:3], *quaternion(rotation)
    data.qvel[:6] = *v[:3], *(matrix @ v[3:6])
    data.qacc[:6] = *a[:3], *(matrix @ a[3:6] + matrix_rate)
    for i, joint in enumerate(body.joints):
        data.joint(joint.name).qpos[:] = y[6 + i]
        data.joint(joint.name).qvel[:] = v[6 + i]
        data.joint(joint.name).qacc[:] = a[6 + i]
    return rotation


def test_inverse_dynamics_and_momentum_are_those_of_mujoco(robot):
    body = LeggedBody.of(robot)
    base = FloatingBase.of(body)
    model = build_spec(robot, visuals=False).spec.compile()
    model.opt.gravity[:] = 0.0, 0.0, -9.81
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    model.dof_damping[:] = 0.0
    data, random = mujoco.MjData(model), np.random.default_rng(0)
    y, v, a = random.normal(size=(3, 6 + len(body.joints)))
    rotation = set_motion(data, body, 0.3 * y, v, a)
    mujoco.mj_inverse(model, data)
    outputs = [base.torque, base.imbalance, base.spin, base.momentum]
    inputs = [base.y, base.v, base.a, base.f, base.load.packed()]
    load = Load.values(9.81, body.trunk)
    results = ca.Function("all", inputs, outputs)(0.3 * y, v, a, np.zeros(base.f.numel()), load)
    torque, imbalance, spin, momentum = (np.asarray(value).ravel() for value in results)
    resistance = [
        joint.damping * speed + joint.friction * np.tanh(speed / 0.1)
        for joint, speed in zip(body.joints, v[6:], strict=True)
    ]
    expected = [data.joint(joint.name).qfrc_inverse[0] for joint in body.joints]
    np.testing.assert_allclose(torque - resistance, expected, atol=1e-9)
    np.testing.assert_allclose(rotation @ imbalance[:3], data.qfrc_inverse[:3], atol=1e-9)
    np.testing.assert_allclose(imbalance[3:], data.qfrc_inverse[3:6], atol=1e-8)
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_subtreeVel(model, data)
    np.testing.assert_allclose(rotation @ spin, data.subtree_angmom[1], atol=1e-12)
    np.testing.assert_allclose(momentum, robot.mass * data.subtree_linvel[1], atol=1e-12)


def test_a_force_on_a_foot_acts_at_its_sole(robot):
    """Virtual work: joint torques follow from the Jacobian at the ball's lowest point."""
    body = LeggedBody.of(robot)
    base = FloatingBase.of(body)
    random = np.random.default_rng(1)
    y = np.concatenate([np.zeros(6), body.posture])
    force = random.normal(size=base.f.numel())
    inputs = [base.y, base.v, base.a, base.f, base.load.packed()]
    torque = ca.Function("torque", inputs, [base.torque])
    no_motion, load = np.zeros_like(y), Load.values(9.81, body.trunk)
    pushed = torque(y, no_motion, no_motion, force, load) - torque(
        y, no_motion, no_motion, 0.0 * force, load
    )
    expected = []
    for i, (leg, where) in enumerate(body.joint_slices):
        pose = leg.chain.pose(body.posture[where])
        sole = pose.point(leg.foot) - np.array([0.0, 0.0, leg.foot_radius])
        expected.append(-leg.chain.point_jacobian(pose, sole).T @ force[3 * i : 3 * i + 3])
    np.testing.assert_allclose(np.asarray(pushed).ravel(), np.concatenate(expected), atol=1e-9)
