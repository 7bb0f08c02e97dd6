"""A robot's file says what the robot is, not how its own simulations are run."""

import mujoco
import numpy as np
import pytest
from wheels import driven_device

from ocs_design.robot.mujoco_model import build_spec
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scene import Wheels, compile_scene, robot_scene

DEFAULTS = """<default>
  <motor gear="75" ctrllimited="true" ctrlrange="-1 1" forcelimited="true" forcerange="-5 5"/>
  <general dyntype="filter" dynprm="0.1"/><geom margin="0.01" gap="0.001"/></default>"""
OPTION = """<option iterations="1" ls_iterations="5" noslip_iterations="4" tolerance="1e-3"
  timestep="0.01" integrator="Euler" density="1000" viscosity="0.1" wind="1 0 0">
  <flag eulerdamp="disable" warmstart="disable" contact="disable" gravity="disable"/></option>"""


@pytest.fixture(scope="module")
def compiled(solo12, tmp_path_factory):
    """The scene of Solo12 as MJCF, and of the same file with settings of its own."""
    text = build_spec(solo12, visuals=False).spec.to_xml()
    opened = text.index(">", text.index("<mujoco")) + 1
    folder = tmp_path_factory.mktemp("solo12")
    models = []
    for more in ("", OPTION, DEFAULTS):
        path = folder / "robot.xml"
        path.write_text(text[:opened] + more + text[opened:])
        mujoco.MjModel.from_xml_path(str(path))
        robot = read_robot(path, trunk=solo12.trunk)
        models.append(
            compile_scene(robot_scene(robot), robot, driven_device(), Wheels.ACTIVE, 9.81)
        )
    return models


@pytest.mark.parametrize("case", [1, 2], ids=["options", "defaults"])
def test_settings_of_the_file_do_not_reach_the_simulation(compiled, case):
    plain, other = compiled[0], compiled[case]
    assert plain.nu == other.nu > 0
    for name in dir(plain):
        if name.startswith(("actuator_", "geom_margin", "geom_gap")):
            np.testing.assert_array_equal(getattr(other, name), getattr(plain, name), name)
    for name in dir(plain.opt):
        if not name.startswith("_"):
            np.testing.assert_array_equal(getattr(other.opt, name), getattr(plain.opt, name), name)
