"""Xacro files are expanded or refused with a reason; none may run code, read, write or hang."""

import sys
from pathlib import Path

import pytest

from ocs_design.common.errors import MissingToolError, RobotError
from ocs_design.robot import xacro
from ocs_design.robot.reader import load
from ocs_design.robot.robot import RobotFormat
from ocs_design.robot.xacro import check_expression, check_variable

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
    assert loaded.format is RobotFormat.URDF
    assert loaded.tree.bodies[0].mass_properties.mass == 5.0
    assert b"xacro:" not in loaded.content
    assert "ament_index_python" not in sys.modules


@pytest.mark.parametrize("include", ["gone.xacro", "$(find nowhere)/trunk.xacro"])
def test_an_unexpandable_xacro_names_what_is_missing(tmp_path: Path, include: str):
    pytest.importorskip("xacro", reason="the extra [xacro] is not installed")
    with pytest.raises(RobotError, match=r"gone\.xacro|nowhere") as caught:
        load(write(tmp_path, include))
    assert "--package-path" in caught.value.hint


@pytest.mark.parametrize("declared", [True, False])
def test_without_xacro_the_hint_is_the_command_that_installs_it(
    tmp_path: Path, monkeypatch, declared
):
    monkeypatch.setitem(sys.modules, "xacro", None)
    path = write(tmp_path, "trunk.xacro")
    if not declared:
        path.write_text('<robot name="r"><link name="${prefix}trunk"/></robot>')
    with pytest.raises(MissingToolError) as caught:
        load(path)
    assert caught.value.exit_code == 5
    assert "pip install 'ocs-design[xacro]'" in caught.value.hint


def test_an_undeclared_prefix_is_recognised_as_xacro(tmp_path: Path):
    path = tmp_path / "robot.urdf"
    path.write_text('<robot name="r"><xacro:trunk/></robot>')
    with pytest.raises(RobotError, match="xacro"):
        load(path)


pytest.importorskip("xacro", reason="the extra [xacro] is not installed")

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
TRUNK = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'


def link_named(expression, folder, **options):
    """Name of the only link of a xacro file that names it by an expression."""
    path = folder / "robot" / "r.xacro"
    path.parent.mkdir(exist_ok=True)
    path.write_text(
        f'{HEAD}<xacro:property name="a" value="2"/><link name="{expression}">{TRUNK}</robot>'
    )
    return load(path, **options).tree.bodies[0].name


@pytest.mark.parametrize(
    "expression",
    [
        "().__class__",
        "[c for c in [(lambda: ().__class__.__base__.__subclasses__())()]]",
        "'{0.__globals__}'.format(radians)",
        "map(str.format_map, [''], [{}])",
        "(x for x in [1]).gi_frame.f_back",
        "f'{len.__self__}'",
        "__import__('os')",
        "python.type.mro(int)",
    ],
)
def test_an_expression_that_reaches_into_python_is_refused(tmp_path: Path, expression):
    with pytest.raises(ValueError, match="is refused"):
        check_expression(expression)


def test_functions_that_reach_into_python_are_not_available(tmp_path: Path):
    with pytest.raises(RobotError, match="vars"):
        link_named("${python.vars(python.dict)}", tmp_path)


def test_expressions_of_usual_robots_are_evaluated(tmp_path: Path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "sizes.yaml").write_text("leg: {length: 0.25}")
    expression = "${xacro.load_yaml('sizes.yaml')['leg']['length'] * a}_${max(map(int, '123'))}"
    assert link_named(expression, tmp_path) == "0.5_3"


@pytest.mark.parametrize("name", ["secret.yaml", "link.yaml"])
def test_files_outside_of_the_robots_folder_are_not_read(tmp_path: Path, name):
    (tmp_path / "robot").mkdir()
    (tmp_path / "secret.yaml").write_text("token: s3cret")
    (tmp_path / "robot" / "link.yaml").symlink_to(tmp_path / "secret.yaml")
    path = tmp_path / "secret.yaml" if name == "secret.yaml" else "link.yaml"
    expression = f"${{xacro.load_yaml('{path}')['token']}}"
    with pytest.raises(RobotError, match="outside the robot's folder"):
        link_named(expression, tmp_path)
    allowed = {"any": tmp_path}
    assert link_named(expression, tmp_path, package_paths=allowed) == "s3cret"


def test_an_include_that_leaves_the_folder_is_refused(tmp_path: Path):
    (tmp_path / "out.xacro").write_text(f"{HEAD}</robot>")
    inside = tmp_path / "in.xacro"
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "r.xacro").write_text(f'{HEAD}<xacro:include filename="../{inside.name}"/></robot>')
    inside.write_text(f'{HEAD}<link name="a">{TRUNK}</robot>')
    with pytest.raises(RobotError, match="outside"):
        load(folder / "r.xacro")
    (tmp_path / "package.xml").write_text("<package/>")
    assert load(folder / "r.xacro").tree.bodies[0].name == "a"


@pytest.mark.parametrize("name", ["GITHUB_TOKEN", "aws_secret_access_key", "PGPASSWORD"])
def test_variables_that_may_be_secret_are_not_read(name):
    with pytest.raises(ValueError, match="may be secret"):
        check_variable(name)


def test_other_variables_are_read(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("ROBOT_SIDE", "left")
    monkeypatch.setenv("ROBOT_TOKEN", "s3cret")
    assert link_named("$(env ROBOT_SIDE)_$(optenv ROBOT_COLOR red)", tmp_path) == "left_red"
    for command in ("env", "optenv"):
        with pytest.raises(RobotError, match="may be secret"):
            link_named(f"$({command} ROBOT_TOKEN)", tmp_path)


@pytest.mark.parametrize(
    "expression", ["9**9**9**2", "len([0]*10**10)", "len(list(range(10**10)))"]
)
def test_an_endless_expression_is_stopped(tmp_path: Path, monkeypatch, expression):
    monkeypatch.setattr(xacro, "SECONDS", 0.3)
    with pytest.raises(RobotError, match="cannot expand"):
        link_named(f"${{{expression}}}", tmp_path)


def test_a_slow_expression_is_waited_for(tmp_path: Path):
    """Half a second or more of work, within the limit: its process lives as long as it may work."""
    assert link_named("${'arm' if max(range(2*10**7)) > 0 else 'leg'}", tmp_path) == "arm"
