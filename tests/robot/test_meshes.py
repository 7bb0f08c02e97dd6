"""Meshes: where they are found, their bounds, and which are not opened."""

from pathlib import Path
from unittest import mock
from zipfile import ZipFile

import numpy as np
import pytest
import trimesh
from robots import ROBOTS

from ocs_design.common.errors import RobotError
from ocs_design.robot.meshes import check_mesh_file, mesh_bounds
from ocs_design.robot.packages import MOST_FOLDERS, MeshFinder, is_below, package_roots, roots_of
from ocs_design.robot.reader import load


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.delenv("CMAKE_PREFIX_PATH", raising=False)


def touch(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return path


def test_the_given_package_path_goes_first(tmp_path: Path, monkeypatch):
    given = touch(tmp_path / "given" / "m.stl")
    touch(tmp_path / "ros" / "bot" / "m.stl")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ros"))
    finder = MeshFinder(tmp_path, {"bot": tmp_path / "given"})
    assert finder("package://bot/m.stl") == given
    assert not finder.missing


@pytest.mark.parametrize(
    ("variable", "entry", "package"),
    [
        ("ROS_PACKAGE_PATH", "src", "src/bot"),
        ("ROS_PACKAGE_PATH", "src/bot", "src/bot"),
        ("AMENT_PREFIX_PATH", "install", "install/share/bot"),
        ("CMAKE_PREFIX_PATH", "install", "install/share/bot"),
    ],
)
def test_ros_environment_is_searched(tmp_path: Path, monkeypatch, variable, entry, package):
    mesh = touch(tmp_path / package / "meshes" / "m.stl")
    monkeypatch.setenv(variable, f"/nowhere:{tmp_path / entry}")
    assert MeshFinder(Path("/elsewhere"), {})("package://bot/meshes/m.stl") == mesh


@pytest.mark.parametrize("scheme", ["package", "model"])
@pytest.mark.parametrize("start", ["ws/bot/urdf", "ws/other/urdf/deep", "ws/bot"])
def test_folders_above_the_robot_are_searched(tmp_path: Path, scheme, start):
    mesh = touch(tmp_path / "ws" / "bot" / "meshes" / "m.stl")
    (tmp_path / start).mkdir(parents=True, exist_ok=True)
    assert MeshFinder(tmp_path / start, {})(f"{scheme}://bot/meshes/m.stl") == mesh


def test_plain_and_file_addresses(tmp_path: Path):
    mesh = touch(tmp_path / "a b" / "m.stl")
    finder = MeshFinder(tmp_path, {})
    for name in ("a b/m.stl", str(mesh), f"file://{tmp_path}/a%20b/m.stl", "file://a b/m.stl"):
        assert finder(name) == mesh
        assert finder(name.replace("/", "\\")) == mesh


@pytest.mark.parametrize(
    "name", ["gone.stl", "package://bot/m.stl", "package://", "http://x/m.stl", "", "a\0b"]
)
def test_a_missing_mesh_is_noted_once(tmp_path: Path, name):
    finder = MeshFinder(tmp_path, {})
    assert finder(name) is None
    assert finder(name) is None
    assert list(finder.missing) == [name]


@pytest.mark.parametrize(
    ("name", "place", "cure"),
    [
        ("package://bot/m/a.stl", "ws/src/other/m/a.stl", "--package-path bot={}/ws/src/other"),
        ("package://bot/m/a.stl", "ws/it's/m/a.stl", "bot='{}/ws/it'\"'\"'s'"),
        ("package://bot/m/a.stl", "lib/share/bot/m/a.stl", "--package-path bot={}/lib/share/bot"),
        ("package://bot/m/a.stl", "ws/m/.hidden/a.stl", "--package-path bot=DIR"),
        ("m/a.stl", "ws/bot/m/a.stl", "put the robot's file into {}/ws/bot"),
        (r"package://bot\m\a.stl", "ws/m/.hidden/a.stl", "--package-path bot=DIR"),
        ("m/a.stl", "a.stl", "put them where the file names them, below {}/ws/bot/urdf"),
    ],
)
def test_missing_meshes_are_found_near_the_file(tmp_path, monkeypatch, name, place, cure):
    monkeypatch.setenv("CMAKE_PREFIX_PATH", str(tmp_path / "lib"))
    touch(tmp_path / place)
    finder = MeshFinder(tmp_path / "ws" / "bot" / "urdf", {"bot": tmp_path / "empty"})
    finder.missing[name] = None
    assert cure.format(tmp_path) in finder.cure()


def test_the_search_for_missing_meshes_ends(tmp_path):
    for name in range(40):
        (tmp_path / "ws" / f"{name}" / "deep").mkdir(parents=True)
    finder = MeshFinder(tmp_path / "ws", {})
    finder("package://bot/a.stl")
    with mock.patch.object(Path, "is_file", return_value=False) as is_file:
        assert "bot=DIR" in finder.cure()
    assert is_file.call_count < 2 * MOST_FOLDERS + 1


BOX = trimesh.creation.box(
    extents=(1.0, 2.0, 3.0), transform=trimesh.transformations.translation_matrix((5, 0, 0))
)
EXPECTED = np.array([[4.5, -1.0, -1.5], [5.5, 1.0, 1.5]])


@pytest.mark.parametrize("file_type", ["stl", "stl_ascii", "obj", "dae", "ply"])
def test_bounds_of_every_format_scaled_and_mirrored_too(tmp_path: Path, file_type):
    path = tmp_path / f"box.{file_type.removesuffix('_ascii')}"
    BOX.export(path, file_type=file_type)
    np.testing.assert_allclose(mesh_bounds(path, (1.0, 1.0, 1.0)), EXPECTED, atol=1e-6)
    mirrored = [[-0.011, -0.02, -0.03], [-0.009, 0.02, 0.03]]
    np.testing.assert_allclose(mesh_bounds(path, (-0.002, 0.02, 0.02)), mirrored, atol=1e-9)


def test_a_collada_file_in_inches_is_in_metres(tmp_path: Path):
    path = tmp_path / "box.dae"
    BOX.export(path)
    unit = '<unit name="inch" meter="0.0254"/></asset>'
    path.write_text(path.read_text().replace("</asset>", unit))
    np.testing.assert_allclose(mesh_bounds(path, (1.0, 1.0, 1.0)), EXPECTED * 0.0254, atol=1e-6)


def test_vertices_without_face_do_not_count(tmp_path: Path):
    path = tmp_path / "m.obj"
    path.write_text("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2/1/1 3//2 -1\n")
    np.testing.assert_array_equal(mesh_bounds(path, (1, 1, 1)), [[0, 0, 0], [1, 1, 0]])


@pytest.mark.parametrize(
    ("name", "content"),
    [
        *[(f"m.{kind}", b"\x00garbage\xff") for kind in ("stl", "obj", "dae", "unknown")],
        ("m.obj", b"v 0.0 0.0\nf 1 1 1\n"),
        ("m.obj", b"v\nf 1 1 1\n"),
    ],
)
def test_unreadable_meshes_have_no_bounds(tmp_path: Path, name, content):
    assert mesh_bounds(tmp_path / name, (1, 1, 1)) is None
    (tmp_path / name).write_bytes(content)
    assert mesh_bounds(tmp_path / name, (1, 1, 1)) is None


def test_meshes_that_are_too_large_or_in_archives_are_not_opened(tmp_path: Path, monkeypatch):
    monkeypatch.setattr("ocs_design.robot.meshes.LARGEST_MESH", 1000)
    box = trimesh.creation.box()
    box.export(tmp_path / "binary.stl")
    box.export(tmp_path / "text.stl", file_type="stl_ascii")
    with ZipFile(tmp_path / "box.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", "<model/>")
    np.testing.assert_allclose(mesh_bounds(tmp_path / "binary.stl", (1.0, 1.0, 1.0)), box.bounds)
    assert mesh_bounds(tmp_path / "text.stl", (1.0, 1.0, 1.0)) is None
    with pytest.raises(RobotError, match="larger than"):
        check_mesh_file(tmp_path / "text.stl")
    with pytest.raises(RobotError, match="not a mesh that can be read"):
        check_mesh_file(tmp_path / "box.3mf")


def test_collada_with_y_up_is_rotated_where_the_links_then_fit():
    """iCub is symmetric in y: so are the boxes around its left and right links at zero.

    Not rotated, its head would lie beside the neck and its pelvis at the right hip.
    """
    tree = load(ROBOTS / "icub_description" / "robots" / "icub.urdf").tree
    assert any("56 .dae meshes declare y as up" in warning for warning in tree.warnings)
    boxes = {}
    for body, place in zip(tree.bodies, tree.placements_from("base_link", {}), strict=True):
        points = [
            trimesh.bounds.corners(trimesh.load_scene(shape.mesh).bounds)
            * shape.size
            @ shape.rotation.T
            + shape.position
            for shape in body.shapes
            if shape.collides
        ]
        if points:
            world = np.concatenate(points) @ place.rotation.T + place.position
            boxes[body.name] = world.min(axis=0), world.max(axis=0)
    low, high = boxes["head"]
    assert low[2] > boxes["chest"][1][2]
    assert (low[1] + high[1]) / 2.0 == pytest.approx(0.0, abs=0.01)
    for name in ("upper_leg", "lower_leg", "ankle_2"):
        left, right = boxes[f"l_{name}"], boxes[f"r_{name}"]
        mirrored = np.array([right[0] * [1, -1, 1], right[1] * [1, -1, 1]])
        np.testing.assert_allclose(np.sort(mirrored, axis=0), left, atol=0.01)


@pytest.mark.parametrize(
    "robot",
    [
        pytest.param("tiago_description/robots/tiago", marks=pytest.mark.slow),
        "hextilt_description/urdf/hextilt_flying_arm_5",
        "borinot_description/urdf/borinot_flying_arm_2",
        pytest.param("go1_description/urdf/go1", marks=pytest.mark.slow),
    ],
)
def test_collada_with_y_up_that_fits_is_not_rotated(robot):
    """These files declare y as up too, but their meshes fit the links as they are."""
    tree = load(ROBOTS / f"{robot}.urdf").tree
    shapes = [shape for body in tree.bodies for shape in body.shapes if shape.mesh is not None]
    assert any(b"<up_axis>Y_UP" in shape.mesh.read_bytes()[:4096] for shape in shapes)
    assert not any("declare y as up" in warning for warning in tree.warnings)


def test_roots_are_the_folder_and_the_package_around_it(tmp_path):
    folder = tmp_path / "package" / "urdf"
    folder.mkdir(parents=True)
    assert roots_of(folder / "robot.urdf") == (folder,)
    (tmp_path / "package" / "package.xml").touch()
    assert set(roots_of(folder / "robot.urdf")) == {folder, tmp_path / "package"}
    assert is_below(folder / "../meshes/a.stl", roots_of(folder / "robot.urdf"))
    assert not is_below(folder / "../../a.stl", roots_of(folder / "robot.urdf"))


def test_a_workspace_that_is_installed_by_links(tmp_path):
    source, installed = tmp_path / "src", tmp_path / "install"
    source.mkdir()
    installed.mkdir()
    for name in ("package.xml", "robot.xacro", "leg.xacro"):
        (source / name).touch()
        (installed / name).symlink_to(source / name)
    assert is_below(installed / "leg.xacro", roots_of(installed / "robot.xacro"))
    assert package_roots(installed) == (installed, source)
    assert package_roots(tmp_path) == ()


def test_a_symbolic_link_out_of_the_folder_is_not_below_it(tmp_path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "secret").touch()
    (tmp_path / "robot" / "a").symlink_to(tmp_path / "secret")
    assert not is_below(tmp_path / "robot" / "a", roots_of(tmp_path / "robot" / "robot.xml"))
