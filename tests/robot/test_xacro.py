import sys
from pathlib import Path

import pytest

from ocs_design.common.errors import MissingToolError, RobotError
from ocs_design.robot.reader import load
from ocs_design.robot.robot import Format

XACRO = """<robot name="test" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="{include}"/>
  <xacro:property name="m" value="2.5"/>
  <xacro:trunk mass="${{2*m}}"/>
</robot>"""
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="trunk" params="mass">
    <link name="trunk">
      <inertial><mass value="${mass}"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
    </link>
  </xacro:macro>
</robot>"""


def write(folder: Path, include: str) -> Path:
    path = folder / "bot" / "urdf" / "robot.urdf.xacro"
    path.parent.mkdir(parents=True)
    path.write_text(XACRO.format(include=include))
    (path.parent / "trunk.xacro").write_text(MACRO)
    return path


@pytest.mark.parametrize("include", ["trunk.xacro", "$(find bot)/urdf/trunk.xacro"])
def test_a_xacro_is_expanded(tmp_path: Path, include: str):
    pytest.importorskip("xacro", reason="the extra [xacro] is not installed")
    loaded = load(write(tmp_path, include))
    assert loaded.format is Format.URDF
    assert loaded.tree.bodies[0].mass_properties.mass == 5.0
    assert b"xacro:" not in loaded.content
    assert "ament_index_python" not in sys.modules


@pytest.mark.parametrize("include", ["gone.xacro", "$(find nowhere)/trunk.xacro"])
def test_what_cannot_be_expanded_says_what_is_missing(tmp_path: Path, include: str):
    pytest.importorskip("xacro", reason="the extra [xacro] is not installed")
    with pytest.raises(RobotError, match=r"gone\.xacro|nowhere") as caught:
        load(write(tmp_path, include))
    assert "--package-path" in caught.value.hint


@pytest.mark.parametrize("declared", [True, False])
def test_without_xacro_the_command_that_installs_it_is_told(tmp_path: Path, monkeypatch, declared):
    monkeypatch.setitem(sys.modules, "xacro", None)
    path = write(tmp_path, "trunk.xacro")
    if not declared:
        path.write_text('<robot name="r"><link name="${prefix}trunk"/></robot>')
    with pytest.raises(MissingToolError) as caught:
        load(path)
    assert caught.value.exit_code == 5
    assert "pip install 'ocs-design[xacro]'" in caught.value.hint


def test_an_undeclared_prefix_is_told_as_xacro(tmp_path: Path):
    path = tmp_path / "robot.urdf"
    path.write_text('<robot name="r"><xacro:trunk/></robot>')
    with pytest.raises(RobotError, match="xacro"):
        load(path)
