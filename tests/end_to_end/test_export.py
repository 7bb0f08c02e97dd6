"""`export` writes the same files again from `design.json` and the robot's file."""

import gzip
import json
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

import mujoco
import pytest
import trimesh
from commands import (
    BY_HAND,
    EXPORT_FOLDERS,
    ROOT,
    SOLO12,
    all_paths_in,
    exported_files,
    failure,
    files_in,
    run,
    size_to_bound,
)
from exported import MJCF, pinocchio_model
from robots import ROBOTS

from ocs_design.export import formats
from ocs_design.export.formats import FORMATS, USUAL_FORMATS
from ocs_design.workflows.export import ON_DESIGN

HUMAN = next(ROBOTS.rglob("human.urdf"))
WITH_A_MESH = """<robot name="r">
  <link name="base"><inertial><mass value="2"/>
    <inertia ixx="0.03" iyy="0.05" izz="0.07" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://parts/cube.stl"/></geometry></visual></link>
</robot>"""


def refused(code, part, *arguments):
    """The message of a refused export, which writes nothing."""
    message = failure(code, "export", *arguments, "-o", "again")
    assert part in message
    assert not Path("again").exists()
    return message


@pytest.mark.slow
def test_every_file_is_that_of_size(product, folder):
    result = run("export", product.folder, "-o", "again")
    assert result.code == 0
    files = files_in("again")
    expected = {name for name in product.case.files if name.startswith(EXPORT_FOLDERS)}
    assert set(files) == {"design.json", *expected}
    assert exported_files("again") == exported_files(product.folder)
    assert list(json.loads(files["design.json"])["files"]) == sorted(exported_files("again"))


def robot_by_hand():
    return size_to_bound(*BY_HAND, "--rate-change", "6rad/s", "--wheel-speed-max", "7200rpm")


def robot_in_mjcf():
    Path("in.xml").write_text(MJCF)
    return size_to_bound("in.xml", "--rate-change", "1rad/s", "--trunk", "trunk")


def robot_gzipped():
    Path("solo.urdf.gz").write_bytes(gzip.compress(Path(SOLO12).read_bytes()))
    return size_to_bound("solo.urdf.gz", "--posture", "zero", "--joint", "FL_KFE=-0.5")


def robot_with_meshes_elsewhere():
    """The design records the folder of the meshes, which the robot's file does not name."""
    (Path("hidden") / "p").mkdir(parents=True)
    trimesh.creation.box((0.1, 0.1, 0.1)).export("hidden/p/cube.stl")
    Path("r.urdf").write_text(WITH_A_MESH)
    return size_to_bound("r.urdf", "--rate-change", "1rad/s", "--package-path", "parts=hidden/p")


@pytest.mark.slow
@pytest.mark.parametrize(
    "make",
    [robot_by_hand, robot_in_mjcf, robot_gzipped, robot_with_meshes_elsewhere],
)
def test_files_are_the_same_for_any_robot(folder, make):
    source = make()
    assert run("export", source, "-o", "again", "-q").code == 0
    assert exported_files("again") == exported_files(source)


def test_the_robot_is_found_from_anywhere(solo12, folder, monkeypatch):
    """The path of the robot is relative to the folder in which `size` ran."""
    (folder / "elsewhere").mkdir()
    monkeypatch.chdir(folder / "elsewhere")
    assert run("export", folder / "ocs", "-o", "again", "-q").code == 0
    assert exported_files("again") == exported_files(folder / "ocs")


def test_parts_and_snippets_need_no_robot(solo12):
    Path("solo12.urdf").unlink()
    message = refused(3, "solo12.urdf: the robot's file no longer exists", solo12)
    hint = "--formats stl,bom,drawing,printed,assembly,snippets"
    assert hint in message
    assert run("export", solo12, "-o", "again", "-q", *hint.split()).code == 0
    original, again = exported_files(solo12), exported_files("again")
    assert again == {name: original[name] for name in original if not name.startswith("robot")}


@pytest.mark.slow
def test_the_base_frame_of_a_robot_with_y_up_is_in_the_design(folder):
    shutil.copy(HUMAN, "h.urdf")
    source = size_to_bound("h.urdf")
    assert run("export", source, "-o", "whole", "-q").code == 0
    assert exported_files("whole") == exported_files(source)
    Path("h.urdf").unlink()
    assert run("export", source, "-o", "again", "-q", "--formats", "snippets").code == 0
    for name, content in exported_files("again").items():
        assert content == exported_files(source)[name]


def test_a_moved_robot_is_given_by_an_option(solo12):
    Path("solo12.urdf").rename("moved.urdf")
    result = run("export", solo12, "-o", "again", "--robot", "moved.urdf", "--json")
    assert result.code == 0
    assert result.document["warnings"] == []
    assert exported_files("again") == exported_files(solo12)


@pytest.mark.slow
def test_a_changed_robot_is_refused_unless_given_by_an_option(solo12):
    changed = Path("solo12.urdf").read_text().replace("</robot>", "<!-- new -->\n</robot>")
    Path("solo12.urdf").write_text(changed)
    message = refused(3, "has changed since the device was sized for it", solo12)
    assert "--robot solo12.urdf" in message
    arguments = (solo12, "--robot", "solo12.urdf")
    refused(3, "not the file that the device was sized for", *arguments, "--strict")
    result = run("export", *arguments, "-o", "again", "--json")
    (warning,) = result.document["warnings"]
    text = "not the file that the device was sized for; its mass is 2.5 kg, at sizing it was 2.5 kg"
    assert warning == f"solo12.urdf: {text}"
    assert "<!-- new -->" in Path("again/robot/solo12_ocs.urdf").read_text()


def test_a_robot_without_the_designs_trunk_is_refused(solo12):
    go2 = ROBOTS / "go2_description" / "urdf" / "go2.urdf"
    refused(3, "the robot has no link 'base_link'", solo12, "--robot", go2)


@pytest.mark.slow
def test_a_robot_from_standard_input_has_to_be_given(folder):
    source = size_to_bound("-", stdin=Path(SOLO12).read_bytes())
    refused(3, "--robot FILE", source)
    assert run("export", source, "-o", "again", "-q", "--robot", SOLO12).code == 0
    assert exported_files("again") == exported_files(source)


@pytest.mark.slow
def test_parts_and_snippets_import_neither_simulator_nor_solver(solo12):
    """Importing them takes most of the time of a start."""
    code = (
        "import sys\nfrom ocs_design.cli import errors\nfrom ocs_design.cli.app import app\n"
        f"assert not errors.run(app, ['export', {str(solo12)!r}, '-q', '--formats', 'stl,bom'])"
        "\nprint(*{name.partition('.')[0] for name in sys.modules})"
    )
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert {"mujoco", "cvxpy", "casadi", "trimesh", "scipy"}.isdisjoint(process.stdout.split())


def test_an_existing_folder_is_kept(solo12):
    before = files_in(solo12)
    assert "--force" in failure(3, "export", solo12, "-o", solo12)
    assert files_in(solo12) == before


@pytest.mark.slow
def test_export_into_the_folder_of_the_design_keeps_other_files(product, folder):
    shutil.copytree(product.folder, "ocs")
    Path("ocs/notes.txt").write_text("mine")
    Path("ocs/robot/solo12_ocs.glb").unlink()
    Path("ocs/cad/flywheel.stl").write_bytes(b"broken")
    assert run("export", "ocs", "-o", "ocs", "--force", "-q").code == 0
    original = files_in(product.folder)
    renewed = files_in("ocs")
    assert renewed.pop("notes.txt") == b"mine"
    assert {**renewed, "design.json": original["design.json"]} == original


def test_export_of_one_format_in_place_keeps_the_others(solo12):
    before = files_in(solo12)
    (solo12 / "cad" / "flywheel.stl").unlink()
    assert run("export", solo12, "-o", solo12, "--force", "-q", "--formats", "stl").code == 0
    assert files_in(solo12) == before


@pytest.mark.slow
def test_the_default_folder_is_named_after_the_robot(solo12):
    result = run("export", solo12)
    assert result.code == 0
    assert "Written to solo12-ocs-export/" in result.output
    assert Path("solo12-ocs-export/design.json").is_file()


@pytest.mark.slow
def test_relative_mesh_paths_raise_one_warning(folder):
    trimesh.creation.box((0.1, 0.1, 0.1)).export("cube.stl")
    Path("r.urdf").write_text(WITH_A_MESH.replace("package://parts/", ""))
    source = size_to_bound("r.urdf", "--rate-change", "1rad/s")
    warnings = json.loads((source / "design.json").read_text())["robot"]["warnings"]
    assert [warning for warning in warnings if "names 1 of its meshes relative" in warning]
    assert run("export", source, "-o", "again", "--json").document["warnings"] == []


def test_a_robot_without_read_permission_is_an_error(solo12, monkeypatch):
    denied = mock.Mock(side_effect=PermissionError(13, "Permission denied"))
    monkeypatch.setattr("ocs_design.robot.source._read_bounded", denied)
    refused(3, "cannot be read", solo12)


def test_the_json_document_lists_the_files(solo12):
    result = run("export", solo12, "-o", "again", "--json")
    assert (result.code, result.stderr) == (0, "")
    assert set(result.document) == {"schema_version", "folder", "files", "warnings", "notes"}
    assert set(result.document["files"]) == set(exported_files("again"))


NO_DESIGN = (None, b"", b"{}", b"[1, 2]", b"not json", b"\xff\xfe")
NO_DESIGN = (*NO_DESIGN, b'{"schema_version": 99}', b'{"schema_version": 1}')


@pytest.mark.parametrize("content", NO_DESIGN)
def test_other_files_are_refused_as_a_design(folder, content):
    if content is not None:
        Path("design.json").write_bytes(content)
    result = run("export", "design.json", "-o", "again", "--json")
    assert result.code == 3
    assert "design.json" in result.document["error"]["message"]
    assert all_paths_in(".") == ([] if content is None else ["design.json"])


def test_a_folder_without_a_design_is_an_error(folder):
    Path("empty").mkdir()
    refused(3, "empty/design.json", "empty")


def test_the_folder_can_be_moved(solo12, folder):
    run("export", solo12, "-o", "again", "-q")
    moved = folder / "far" / "away"
    moved.parent.mkdir()
    shutil.move("again", moved)
    shutil.rmtree(solo12)
    for name, content in exported_files(moved).items():
        assert str(folder).encode() not in content, name
        assert str(ROOT).encode() not in content, name
    assert mujoco.MjModel.from_xml_path(str(moved / "robot" / "solo12_ocs.xml")).nu >= 2
    assert trimesh.load_scene(moved / "robot" / "solo12_ocs.glb").geometry
    urdf = (moved / "robot" / "solo12_ocs.urdf").read_text()
    assert pinocchio_model(urdf).existJointName("ocs_left")
    assert 'filename="meshes/ocs_flywheel.stl"' in urdf
    assert (moved / "robot" / "meshes" / "ocs_flywheel.stl").is_file()


@pytest.mark.parametrize("file_format", USUAL_FORMATS, ids=lambda file_format: file_format.name)
def test_one_format_alone(solo12, file_format):
    source = solo12 / "design.json"
    assert run("export", source, "-o", "again", "-q", "--formats", file_format.name).code == 0
    again = exported_files("again")
    assert again
    assert again.items() <= exported_files(solo12).items()


@pytest.mark.slow
@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_formats_that_are_written_on_request_alone(product, folder):
    """3MF and STL for the printer, STEP for CAD."""
    options = ("--formats", "3mf,step,printed")
    result = run("export", product.folder, "-o", "again", *options)
    assert result.code == 0, result.output
    files = files_in("again")
    printed = [f"housing_{part}" for part in ("drum", "lid", "foot", "cage")]
    named = [f"{part}.stl" for part in printed]
    named += [f"{part}.step" for part in (*printed, "flywheel", "plate", "module", "device")]
    named += ["flywheel.3mf", "housing.3mf"]
    assert set(files) == {"design.json", *(f"cad/{name}" for name in named)}


@pytest.mark.parametrize("name", ["step", "dxf"])
def test_a_format_without_its_extra_is_a_missing_tool(solo12, monkeypatch, name):
    monkeypatch.setattr(formats, "find_spec", lambda _: None)
    refused(5, f"pip install 'ocs-design[{name}]'", solo12, "--formats", name)


@pytest.mark.parametrize("name", ["step", "dxf"])
def test_a_library_that_does_not_load_is_a_missing_tool(solo12, monkeypatch, name):
    """For example where a shared library is missing on the system."""
    (file_format,) = (file_format for file_format in FORMATS if file_format.name == name)
    monkeypatch.setitem(sys.modules, f"ocs_design.export.{file_format.module}", None)
    refused(5, "cannot be loaded", solo12, "--formats", name)


def test_dxf_of_each_piece(solo12):
    assert run("export", solo12, "-o", "one", "-q", "--formats", "dxf").code == 0
    pieces = {f"cad/{path.stem}.dxf" for path in (solo12 / "cad").glob("flywheel*.stl")}
    assert set(files_in("one")) == {"design.json", *pieces}


def test_formats_are_separated_by_commas_or_repeated_in_any_case(solo12):
    run("export", solo12, "-o", "a", "-q", "--formats", "stl,bom")
    run("export", solo12, "-o", "b", "-q", "--formats", "BOM", "--formats", "Stl")
    assert files_in("a") == files_in("b")
    assert run("export", solo12, "-o", "c", "-q", "--formats", "Report").code == 0
    assert set(files_in("c")) == {"design.json", "report.html"}
    assert set(files_in("a")) == {"design.json", "cad/flywheel.stl", "cad/bill_of_materials.csv"}


def test_an_unknown_format_is_wrong_usage(solo12):
    result = run("export", solo12, "-o", "again", "--formats", "stl,dwg", "--json")
    assert result.code == 2
    assert "dwg" in result.document["error"]["message"]
    known = {*(file_format.name for file_format in FORMATS), *ON_DESIGN}
    assert all(name in result.document["error"]["hint"] for name in known)
