import mujoco
import numpy as np
import pytest
from robots import ROBOTS, SOLO12

from ocs_design.robot.mujoco_model import build_spec, trunk_body
from ocs_design.robot.reader import read_robot
from ocs_design.simulation import quaternions
from ocs_design.simulation.world import TrunkChain

TALOS = ROBOTS / "talos_data" / "robots" / "talos_full_v2.urdf"


@pytest.mark.parametrize(
    ("path", "trunk", "hinges"),
    [(SOLO12, "base_link", 0), (TALOS, "imu_link", 2), (TALOS, "base_link", 0)],
)
def test_attitude_and_rate_are_mujocos(path, trunk, hinges):
    robot = read_robot(path, trunk=trunk)
    spec = build_spec(robot, visuals=False).spec
    body, frame = trunk_body(spec, robot)
    model, name = spec.compile(), body.name
    data = mujoco.MjData(model)
    chain = TrunkChain.of(robot, model)
    assert len(chain.links) == hinges
    random = np.random.default_rng(0)
    mujoco.mj_integratePos(model, data.qpos, random.normal(size=model.nv), 1.0)
    data.qvel[:] = random.normal(size=model.nv)
    mujoco.mj_forward(model, data)
    expected = data.body(name).xmat.reshape(3, 3) @ frame.rotation
    qpos, qvel = data.qpos[None], data.qvel[None]
    found = quaternions.matrix(chain.attitude(qpos))[0]
    np.testing.assert_allclose(found, expected, atol=1e-12)
    velocity = np.empty(6)
    mujoco.mj_objectVelocity(
        model, data, mujoco.mjtObj.mjOBJ_XBODY, model.body(name).id, velocity, 0
    )
    np.testing.assert_allclose(chain.rate(qpos, qvel)[0], expected.T @ velocity[:3], atol=1e-12)
