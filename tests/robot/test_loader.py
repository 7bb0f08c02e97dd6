import gzip
import hashlib
import io
import subprocess
import sys
from pathlib import Path

import pytest
from robots import ALL_URDFS, SOLO12
from urdf_text import TWO_LINKS

from ocs_design.robot.reader import load
from ocs_design.robot.robot import Format

MJCF = (
    b'<mujoco model="m"><worldbody><body name="trunk"><freejoint/><geom size="1"/></body>'
    b"</worldbody></mujoco>"
)


@pytest.mark.parametrize(("content", "expected"), [(TWO_LINKS, Format.URDF), (MJCF, Format.MJCF)])
@pytest.mark.parametrize("name", ["robot.urdf", "robot.xml", "robot"])
def test_the_content_chooses_the_format_and_not_the_name(tmp_path: Path, content, expected, name):
    path = tmp_path / name
    path.write_bytes(content)
    loaded = load(path)
    assert loaded.format is expected
    assert loaded.content == content
    assert loaded.source == str(path)
    assert loaded.sha256 == hashlib.sha256(content).hexdigest()


@pytest.mark.parametrize("content", [TWO_LINKS, MJCF])
def test_gzipped_files_are_read(tmp_path: Path, content):
    path = tmp_path / "robot.gz"
    path.write_bytes(gzip.compress(content))
    assert load(path).content == content


def test_standard_input_is_read(monkeypatch):
    stream = io.TextIOWrapper(io.BytesIO(TWO_LINKS))
    monkeypatch.setattr(sys, "stdin", stream)
    loaded = load("-")
    assert loaded.source == "-"
    assert set(loaded.tree.joints) == {"hip"}


def test_the_meshes_of_solo12_are_found():
    tree = load(SOLO12).tree
    meshes = [shape for body in tree.bodies for shape in body.shapes if shape.kind == "mesh"]
    assert meshes
    assert all(shape.mesh is not None for shape in meshes)
    assert tree.warnings == ()


def test_nearly_all_real_robots_find_their_meshes():
    readable = [path for path in ALL_URDFS if path.name != "ur3.urdf"]
    without = [path.stem for path in readable if "not found" in str(load(path).tree.warnings)]
    assert without == ["romeo_laas_small"]


def test_reading_a_urdf_imports_nothing_slow():
    code = (
        "import sys; from ocs_design.robot.reader import load; load(sys.argv[1]);"
        "print(sorted({'mujoco', 'trimesh', 'cvxpy', 'scipy'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(SOLO12)], check=True, capture_output=True, text=True
    )
    assert done.stdout == "[]\n"
