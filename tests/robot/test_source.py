import gzip
import hashlib
import io
import os
import sys
from pathlib import Path

import pytest
from urdf_text import TWO_LINKS

from ocs_design.common.errors import RobotError
from ocs_design.robot import source
from ocs_design.robot.source import read_source


@pytest.mark.parametrize("pack", [bytes, gzip.compress])
def test_a_file_is_read_with_its_folder_and_the_hash_of_its_bytes(tmp_path: Path, pack):
    path, packed = tmp_path / "robot.urdf", pack(TWO_LINKS)
    path.write_bytes(packed)
    for argument in (path, str(path)):
        loaded = read_source(argument)
        assert loaded.content == TWO_LINKS
        assert (loaded.folder, loaded.path_text) == (tmp_path, str(path))
        assert loaded.sha256 == hashlib.sha256(packed).hexdigest()


class StandardInput(io.TextIOWrapper):
    def __init__(self, content: bytes, *, terminal: bool = False):
        super().__init__(io.BytesIO(content))
        self.terminal = terminal

    def isatty(self):
        return self.terminal


@pytest.mark.parametrize("pack", [bytes, gzip.compress])
def test_standard_input_is_read(monkeypatch, pack):
    monkeypatch.setattr(sys, "stdin", StandardInput(pack(TWO_LINKS)))
    read = read_source("-")
    assert read.content == TWO_LINKS
    assert read.folder is None


def test_a_terminal_is_refused(monkeypatch):
    monkeypatch.setattr(sys, "stdin", StandardInput(b"", terminal=True))
    with pytest.raises(RobotError, match="standard input"):
        read_source("-")


@pytest.mark.parametrize(
    ("name", "message", "hint"),
    [
        ("sole12.urdf", "does not exist", "solo12.urdf"),
        ("gone/solo12.urdf", "does not exist", "gone"),
        ("", "is a folder", "solo12.urdf"),
    ],
)
def test_a_wrong_path_suggests_another(tmp_path: Path, name, message, hint):
    (tmp_path / "solo12.urdf").write_bytes(TWO_LINKS)
    with pytest.raises(RobotError, match=message) as caught:
        read_source(tmp_path / name)
    assert hint in caught.value.hint


@pytest.mark.parametrize(
    ("files", "robot"),
    [
        (("package.xml", "launch/view.launch.xml", "robots/b.xacro", "urdf/a.urdf"), "urdf/a.urdf"),
        (("package.xml", "urdf/a.urdf", "urdf/arm/hand.urdf", "z.xml"), "z.xml"),
        (("package.xml", ".git/a.urdf", "src/deep/a.urdf"), ""),
    ],
)
def test_the_robot_of_a_package_is_suggested(tmp_path: Path, files, robot):
    for file in files:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_bytes(TWO_LINKS)
    with pytest.raises(RobotError, match="is a folder") as caught:
        read_source(tmp_path)
    hint = f"give a file, such as {tmp_path / robot}" if robot else "give the URDF or MJCF file"
    assert caught.value.hint.startswith(hint)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_a_file_without_permission_is_refused(tmp_path: Path):
    path = tmp_path / "robot.urdf"
    path.write_bytes(TWO_LINKS)
    path.chmod(0)
    with pytest.raises(RobotError, match="permission"):
        read_source(path)


@pytest.mark.parametrize("name", ["a" * 5000, "a\0b", "robot.urdf/inside"])
def test_impossible_paths_are_refused(tmp_path: Path, name: str):
    (tmp_path / "robot.urdf").write_bytes(TWO_LINKS)
    with pytest.raises(RobotError):
        read_source(str(tmp_path / name))


def test_an_endless_file_is_refused(monkeypatch):
    monkeypatch.setattr(source, "MAX_BYTES", 2**20)
    with pytest.raises(RobotError, match="larger than 1 MiB"):
        read_source("/dev/zero")


def test_a_gzip_bomb_is_refused_before_it_unfolds(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(source, "MAX_BYTES", 2**20)
    path = tmp_path / "robot.urdf.gz"
    path.write_bytes(gzip.compress(b" " * 2**24))
    assert path.stat().st_size < 2**20
    with pytest.raises(RobotError, match="larger than 1 MiB unzipped"):
        read_source(path)
