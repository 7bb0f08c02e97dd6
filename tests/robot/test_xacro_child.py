"""What a xacro file may not do: run code, read what is not the robot's, write, or never end."""

from pathlib import Path

import pytest

from ocs_design.common.errors import RobotError
from ocs_design.robot import xacro
from ocs_design.robot.reader import load
from ocs_design.robot.xacro_child import check_expression, check_variable

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


def test_functions_that_lead_there_are_not_given(tmp_path: Path):
    with pytest.raises(RobotError, match="vars"):
        link_named("${python.vars(python.dict)}", tmp_path)


def test_what_robots_need_is_evaluated(tmp_path: Path):
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
    with pytest.raises(RobotError, match="outside of the robot's folder"):
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


def test_other_variables_are(tmp_path: Path, monkeypatch):
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
    monkeypatch.setattr(xacro, "SECONDS", 1.0)
    with pytest.raises(RobotError, match="cannot expand"):
        link_named(f"${{{expression}}}", tmp_path)
