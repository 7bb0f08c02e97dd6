import os
from pathlib import Path

import pinocchio as pin
import pytest
from robots import ROBOTS, SOLO12
from urdf_text import TWO_LINKS

from ocs_design.common.errors import RobotError
from ocs_design.robot.reader import find_srdfs, load, read_group_states

STATE = (
    '<group_state name="{name}" group="{group}"><joint name="{joint}" value="{value}"/>'
    "</group_state>"
)


def srdf(*states: str, name: str = "test") -> bytes:
    return f'<robot name="{name}">{"".join(states)}</robot>'.encode()


def state(name: str, joint: str, value: str, group: str = "all") -> str:
    return STATE.format(name=name, group=group, joint=joint, value=value)


def test_states_of_one_name_are_joined_over_their_groups():
    content = srdf(
        state("home", "a", "1", "left"), state("home", "b", "2", "right"), state("up", "a", "3")
    )
    assert read_group_states(content) == {"home": {"a": 1.0, "b": 2.0}, "up": {"a": 3.0}}


def test_joints_with_several_values_are_left_out():
    content = srdf(state("home", "root_joint", "0 0 0.2 0 0 0 1"))
    assert read_group_states(content) == {}


def test_what_is_no_srdf_is_refused():
    with pytest.raises(RobotError, match="SRDF"):
        read_group_states(b"<html/>")


@pytest.mark.parametrize("place", [".", "../srdf"])
def test_the_loader_finds_the_srdf_of_the_same_robot(tmp_path: Path, place: str):
    folder = tmp_path / "urdf"
    folder.mkdir()
    (folder / "some.urdf").write_bytes(TWO_LINKS)
    (folder / place).resolve().mkdir(exist_ok=True)
    (folder / place / "a.srdf").write_bytes(srdf(state("up", "hip", "9"), name="another"))
    (folder / place / "b.srdf").write_bytes(
        srdf(state("up", "hip", "0.5"), state("x", "nobody", "1"))
    )
    assert load(folder / "some.urdf").tree.named_postures == {"up": {"hip": 0.5}}


def test_the_srdf_of_the_same_file_name_goes_first(tmp_path: Path):
    for name in ("some.srdf", "a.srdf"):
        (tmp_path / name).write_bytes(srdf())
    assert find_srdfs(tmp_path, "some", "test") == [tmp_path / "some.srdf"]


def test_a_broken_srdf_is_only_warned_of(tmp_path: Path):
    (tmp_path / "some.urdf").write_bytes(TWO_LINKS)
    (tmp_path / "some.srdf").write_bytes(srdf(state("up", "hip", "nan")))
    tree = load(tmp_path / "some.urdf").tree
    assert tree.named_postures == {}
    (warning,) = tree.warnings
    assert "some.srdf" in warning


def test_solo12_stands_as_pinocchio_has_it():
    model = pin.buildModelFromUrdf(str(SOLO12), pin.JointModelFreeFlyer())
    pin.loadReferenceConfigurations(
        model, str(ROBOTS / "solo_description" / "srdf" / "solo.srdf"), False
    )
    postures = load(SOLO12).tree.named_postures
    assert set(postures) == {"standing", "straight_standing"}
    for name, posture in postures.items():
        q = model.referenceConfigurations[name]
        assert len(posture) == 12
        assert posture == {
            joint: q[model.joints[model.getJointId(joint)].idx_q] for joint in posture
        }


def test_a_pipe_named_like_an_srdf_is_left_alone(tmp_path):
    os.mkfifo(tmp_path / "robot.srdf")
    assert find_srdfs(tmp_path, "robot", "robot") == []
