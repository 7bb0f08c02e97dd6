"""Reading a robot: its file, and the SRDF beside it."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from anatomy import ANATOMY, tree_of
from robots import ROBOTS, SOLO12, one_per_folder
from urdf_text import TWO_LINKS

from ocs_design.common.errors import RobotError
from ocs_design.robot.reader import find_srdfs, load, read_group_states, read_robot
from ocs_design.robot.robot import RobotFormat

QUADRUPED = ROBOTS / "quadruped_description/urdf/quadruped.urdf"
HUMAN = ROBOTS / "human_description/robots/human.urdf"


def test_solo12_with_no_option():
    solo12 = read_robot(SOLO12)
    assert solo12.name == "solo"
    assert solo12.format is RobotFormat.URDF
    assert solo12.mount is None
    assert (solo12.trunk, solo12.floating_base, solo12.posture_name) == (
        "base_link",
        "base_link",
        "stand",
    )
    assert solo12.sha256 == hashlib.sha256(SOLO12.read_bytes()).hexdigest()
    assert solo12.mass == pytest.approx(2.50000279)
    # 1000 N m: a placeholder, of a robot of 2.5 kg.
    (warning,) = solo12.warnings
    assert "efforts over 10 times" in warning


def test_another_trunk_is_another_frame_of_the_same_robot():
    """Legs, posture and inertia stay the same; only the origin moves."""
    path = ROBOTS / "talos_data/robots/talos_reduced.urdf"
    pelvis, chest = read_robot(path), read_robot(path, trunk="torso_2_link")
    assert [leg.name for leg in chest.legs] == [leg.name for leg in pelvis.legs]
    assert dict(chest.posture) == pytest.approx(dict(pelvis.posture), abs=1e-6)
    assert chest.inertia == pytest.approx(pelvis.inertia, rel=1e-5, abs=1e-5)
    rise = pelvis.com[2] - chest.com[2]
    assert chest.standing_height - pelvis.standing_height == pytest.approx(rise, abs=1e-6)


def test_an_unknown_trunk_lists_the_nearest_links():
    with pytest.raises(RobotError) as caught:
        read_robot(SOLO12, trunk="base")
    assert caught.value.exit_code == 3
    assert "no link 'base'" in caught.value.message
    assert caught.value.hint.startswith("did you mean 'base_link'? available: base_link")


def test_sideways_and_lying_frames_raise_a_warning():
    sideways = read_robot(QUADRUPED, trunk="base_link").warnings
    assert any("knees turn about the x axis" in text for text in sideways)
    lying = next(
        text for text in read_robot(HUMAN, trunk="middle_pelvis").warnings if "hang" in text
    )
    assert "-y" in lying
    assert "--trunk" in lying


@pytest.mark.parametrize("name", one_per_folder(ANATOMY))
def test_warnings_are_unique_and_rarely_about_the_frame(name):
    warnings = read_robot(ROBOTS / f"{name}.urdf").warnings
    assert len(set(warnings)) == len(warnings)
    of_frame = [text for text in warnings if "frame of the trunk" in text]
    assert len(of_frame) == (1 if "quadruped_desc" in name or "human_desc" in name else 0)


MJCF = (
    b'<mujoco model="m"><worldbody><body name="trunk"><freejoint/><geom size="1"/></body>'
    b"</worldbody></mujoco>"
)


@pytest.mark.parametrize(
    ("content", "expected"), [(TWO_LINKS, RobotFormat.URDF), (MJCF, RobotFormat.MJCF)]
)
@pytest.mark.parametrize("name", ["robot.urdf", "robot.xml", "robot"])
def test_the_content_chooses_the_format_and_not_the_name(tmp_path: Path, content, expected, name):
    path = tmp_path / name
    path.write_bytes(content)
    loaded = load(path)
    assert loaded.format is expected
    assert loaded.content == content
    assert loaded.source == str(path)
    assert loaded.sha256 == hashlib.sha256(content).hexdigest()


@pytest.mark.slow
def test_nearly_all_real_robots_find_their_meshes():
    incomplete = [name for name in ANATOMY if "not found" in str(tree_of(name).warnings)]
    assert incomplete == ["romeo_description/urdf/romeo_laas_small"]


def test_reading_a_urdf_imports_nothing_slow():
    code = (
        "import sys; from ocs_design.robot.reader import load; load(sys.argv[1]);"
        "print(sorted({'mujoco', 'trimesh', 'cvxpy', 'scipy'} & set(sys.modules)))"
    )
    process = subprocess.run(
        [sys.executable, "-c", code, str(SOLO12)], check=True, capture_output=True, text=True
    )
    assert process.stdout == "[]\n"


def srdf(*states: str, name: str = "test") -> bytes:
    return f'<robot name="{name}">{"".join(states)}</robot>'.encode()


def state(name: str, joint: str, value: str, group: str = "all") -> str:
    inside = f'<joint name="{joint}" value="{value}"/>'
    return f'<group_state name="{name}" group="{group}">{inside}</group_state>'


def test_states_of_one_name_are_joined_over_their_groups_and_joints_of_several_values_left_out():
    content = srdf(
        state("home", "a", "1", "left"),
        state("home", "b", "2", "right"),
        state("up", "a", "3"),
        state("home", "root_joint", "0 0 0.2 0 0 0 1"),
    )
    assert read_group_states(content) == {"home": {"a": 1.0, "b": 2.0}, "up": {"a": 3.0}}


def test_other_xml_is_refused_as_an_srdf():
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


def test_a_broken_srdf_only_raises_a_warning(tmp_path: Path):
    (tmp_path / "some.urdf").write_bytes(TWO_LINKS)
    (tmp_path / "some.srdf").write_bytes(srdf(state("up", "hip", "nan")))
    tree = load(tmp_path / "some.urdf").tree
    assert tree.named_postures == {}
    (warning,) = tree.warnings
    assert "some.srdf" in warning


def test_a_pipe_named_like_an_srdf_is_left_alone(tmp_path):
    os.mkfifo(tmp_path / "robot.srdf")
    assert find_srdfs(tmp_path, "robot", "robot") == []
