"""What an MJCF model may name: plain files of a bounded size, includes of its own folder."""

import os

import pytest

from ocs_design.common.errors import RobotError
from ocs_design.robot import mjcf_spec
from ocs_design.robot.mjcf import read_mjcf

BODY = '<body name="trunk"><freejoint/><geom size="0.1"/></body>'
MODEL = '<mujoco><include file="{}"/><worldbody>' + BODY + "</worldbody></mujoco>"
INCLUDED = "<mujoco><option timestep='0.01'/></mujoco>"
WITH_MESH = (
    '<mujoco><asset><mesh name="m" file="m.stl"/></asset><worldbody><body name="trunk"><freejoint/>'
    '<geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "out.xml").write_text(INCLUDED)
    return tmp_path / "robot"


def read(folder, include):
    return read_mjcf(MODEL.format(include).encode(), folder)


def test_an_include_may_not_leave_the_folder(folder):
    (folder / "link.xml").symlink_to(folder / "../out.xml")
    for file in ("../out.xml", folder.parent / "out.xml", "link.xml"):
        with pytest.raises(RobotError, match="outside of the model's folder"):
            read(folder, file)


def test_within_a_repository_it_may(folder):
    (folder.parent / ".git").mkdir()
    assert read(folder, "../out.xml").bodies[0].name == "trunk"


def test_a_pipe_or_a_giant_is_not_waited_for(folder, monkeypatch):
    os.mkfifo(folder / "pipe.xml")
    with pytest.raises(RobotError, match="no plain file"):
        read(folder, "pipe.xml")
    monkeypatch.setattr(mjcf_spec, "LARGEST_ASSET", 10)
    (folder / "m.stl").write_bytes(bytes(11))
    with pytest.raises(RobotError, match=r"m\.stl cannot be read: it is larger"):
        read_mjcf(WITH_MESH.encode(), folder)


@pytest.mark.parametrize("number", ["1e300", "-1e80", "inf", "1e999"])
def test_numbers_beyond_all_measure_are_refused(number):
    text = (
        f'<mujoco><worldbody><body name="a" pos="{number} 0 0">{BODY}</body></worldbody></mujoco>'
    )
    with pytest.raises(RobotError):
        read_mjcf(text.encode(), None)
