"""A robot taken out of the world that its file puts it into."""

import mujoco

from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot

WITH_A_BALL = """<mujoco model="player"><worldbody>
  <light name="lamp" mode="targetbody" target="ball" pos="0 0 3"/>
  <body name="dog" pos="0 0 0.5"><freejoint/><geom size="0.1" mass="3"/>
    <camera name="eye" mode="targetbody" target="ball"/>
    <camera name="self" mode="targetbody" target="tail"/>
    <body name="tail" pos="-0.2 0 0"><joint name="wag"/><geom size="0.02" mass="0.1"/></body></body>
  <body name="ball" pos="1 0 0.1"><freejoint/><geom size="0.1" mass="0.3"/></body>
</worldbody></mujoco>"""


def test_nobody_looks_at_what_is_left_out(tmp_path):
    (tmp_path / "player.xml").write_text(WITH_A_BALL)
    built = build_spec(read_robot(tmp_path / "player.xml"))
    model = built.spec.compile()
    fixed = mujoco.mjtCamLight.mjCAMLIGHT_FIXED
    assert [model.body(i).name for i in range(1, model.nbody)] == ["dog", "tail"]
    assert model.cam_mode[model.camera("eye").id] == model.light_mode[0] == fixed
    assert model.cam_targetbodyid[model.camera("self").id] == model.body("tail").id
    assert any("ball" in warning for warning in built.warnings)
