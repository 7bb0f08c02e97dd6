"""Housing, foot and motor in every robot file, read back by MuJoCo, Pinocchio and trimesh."""

from dataclasses import replace
from xml.etree import ElementTree as ET

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import trimesh
from built_devices import FLAT
from robots import ROBOTS, SOLO12
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from seats import TRUNK, TrunkOnly, expand_macro
from wheels import EC45, driven_device, geared, paper_device

from ocs_design.export.device_parts import printed_parts
from ocs_design.export.glb import robot_glb
from ocs_design.export.meshes import part_mesh
from ocs_design.export.mjcf import export_robot_mjcf
from ocs_design.export.robot_model import robot_model
from ocs_design.export.snippets import snippet_mjcf, snippet_sdf, snippet_urdf, snippet_xacro
from ocs_design.export.urdf import robot_urdf, write_meshes
from ocs_design.export.visuals import plain_visuals, still_visuals
from ocs_design.robot.reader import read_robot

ALPHA, LENGTH = np.radians(25.0), 0.021
DRIVE = replace(EC45, diameter=0.043, length=LENGTH, mounting=FLAT)
DEVICE = driven_device(ALPHA, DRIVE)
FOOT = DEVICE.foot
LEFT = DEVICE.modules[0]
MIRROR = np.array([1.0, -1.0, 1.0])


@pytest.fixture(scope="module")
def robot():
    return read_robot(SOLO12)


@pytest.fixture(scope="module")
def folder(robot, tmp_path_factory):
    """A folder with all files of the robot with its device."""
    folder = tmp_path_factory.mktemp("robot")
    model = robot_model(robot, DEVICE)
    export_robot_mjcf(model, folder / "robot.xml")
    (folder / "robot.urdf").write_bytes(robot_urdf(robot, DEVICE))
    write_meshes(DEVICE, folder)
    (folder / "robot.glb").write_bytes(robot_glb(model.compiled, robot.posture))
    return folder


@pytest.fixture(scope="module")
def clouds(folder):
    """Vertices of each visual in the base frame [m] by MuJoCo, by side and name of the part."""
    model = mujoco.MjModel.from_xml_path(str(folder / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    base, vertices = data.site("ocs_imu"), {}
    for side in ("left", "right"):
        body = model.body(f"ocs_{side}_motor")
        for geom in range(int(body.geomadr[0]), int(body.geomadr[0] + body.geomnum[0])):
            assert (model.geom_contype[geom], model.geom_conaffinity[geom]) == (0, 0)
            corners = vertices_of(model, geom) @ data.geom_xmat[geom].reshape(3, 3).T
            placed = corners + data.geom_xpos[geom] - base.xpos
            vertices[side, part_name(model, geom)] = placed @ base.xmat.reshape(3, 3)
    return vertices


def part_name(model, geom):
    mesh = model.geom_dataid[geom]
    return model.mesh(mesh).name if mesh >= 0 else "motor"


def vertices_of(model, geom):
    mesh = model.geom_dataid[geom]
    if mesh < 0:
        radius, half, _ = model.geom_size[geom]
        return np.array(
            [[x, y, z] for x in (0, radius) for y in (0, radius) for z in (-half, half)]
        )
    first = model.mesh_vertadr[mesh]
    return model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(float)


def test_parts_of_the_left_module_stand_as_their_frames_say(clouds):
    """Drum and lid stand in the wheel's frame, z along its axis and y down; the foot's z is up."""
    level = np.cross(LEFT.axis, [0.0, 0.0, 1.0])
    forward = level if level[0] > 0.0 else -level
    wheel = np.column_stack([forward, np.cross(LEFT.axis, forward), LEFT.axis])
    assert np.linalg.det(wheel) == pytest.approx(1.0)
    drum, lid, foot = (part_mesh(part, 64).vertices for part in printed_parts(DEVICE))
    shell = np.concatenate([drum, lid]) @ wheel.T + LEFT.position
    check_same_points(clouds["left", "ocs_housing"], shell)
    upright = np.column_stack([forward, LEFT.axis, [0.0, 0.0, 1.0]])
    underside = LEFT.position - [0.0, 0.0, FOOT.wheel_height]
    check_same_points(clouds["left", "ocs_foot"], foot @ upright.T + underside)


def check_same_points(ours, theirs):
    """Each of our points is one of theirs within single precision."""
    distance, _ = cKDTree(theirs).query(ours)
    assert distance.max() < 1e-8
    np.testing.assert_allclose(np.ptp(ours, axis=0), np.ptp(theirs, axis=0), atol=1e-8)


def test_the_right_housing_is_the_mirror_image_of_the_left(folder):
    """Compared by centre and inertia in the base frame: the triangles are others."""
    solids = {}
    for module in DEVICE.modules:
        mesh = trimesh.load_mesh(folder / "meshes" / "ocs_housing.stl")
        places = {visual.name: visual.place for visual in still_visuals(DEVICE, module)}
        mesh.apply_transform(wheel_of(module) @ homogeneous(places["housing"]))
        solids[module.name] = mesh
    left, right = solids["left"], solids["right"]
    np.testing.assert_allclose(right.center_mass, left.center_mass * MIRROR, atol=1e-6)
    mirrored = left.moment_inertia * np.outer(MIRROR, MIRROR)
    np.testing.assert_allclose(
        right.moment_inertia, mirrored, atol=1e-4 * np.trace(left.moment_inertia)
    )


def homogeneous(place):
    return np.vstack([np.column_stack([place.rotation, place.position]), [0, 0, 0, 1]])


def test_both_motors_stand_on_the_plates_towards_each_other(clouds):
    for module in DEVICE.modules:
        inwards = -module.axis * np.sign(module.axis[1] * module.position[1])
        along = (clouds[module.name, "motor"] - module.position) @ inwards
        np.testing.assert_allclose([along.min(), along.max()], [FOOT.back, FOOT.back + LENGTH])


def test_pinocchio_has_the_same_places(folder):
    model = pin.buildModelFromUrdf(str(folder / "robot.urdf"), pin.JointModelFreeFlyer())
    geometry = pin.buildGeomFromUrdf(
        model,
        str(folder / "robot.urdf"),
        pin.GeometryType.VISUAL,
        package_dirs=[str(folder), str(ROBOTS.parents[1])],
    )
    data, frames = model.createData(), geometry.createData()
    pin.updateGeometryPlacements(model, data, geometry, frames, pin.neutral(model))
    pin.updateFramePlacements(model, data)
    trunk = data.oMf[model.getFrameId(TRUNK, pin.FrameType.BODY)]
    for module in DEVICE.modules:
        visuals = still_visuals(DEVICE, module)
        for index, visual in enumerate(visuals):
            number = geometry.getGeometryId(f"ocs_{module.name}_motor_{index}")
            place = trunk.actInv(frames.oMg[number])
            expected = wheel_of(module) @ homogeneous(visual.place)
            np.testing.assert_allclose(place.homogeneous, expected, rtol=0.0, atol=1e-12)
            color = geometry.geometryObjects[number].meshColor
            np.testing.assert_allclose(color, visual.color)
        names = [shape.name for shape in geometry.geometryObjects]
        assert sum(name.startswith(f"ocs_{module.name}_motor_") for name in names) == len(visuals)


def wheel_of(module):
    """Frame of a wheel in B, whose y is down, as a homogeneous matrix."""
    down = np.array([0.0, 0.0, -1.0])
    place = np.eye(4)
    place[:3, :3] = np.column_stack([np.cross(down, module.axis), down, module.axis])
    place[:3, 3] = module.position
    return place


def test_the_glb_has_the_parts_below_the_motor_links(folder):
    scene = trimesh.load_scene(folder / "robot.glb")
    children = scene.graph.transforms.children
    for side in ("left", "right"):
        assert len(children[f"ocs_{side}_motor"]) == len(still_visuals(DEVICE, LEFT)) == 3


def placed_by_urdf(text, side):
    """Shape, sizes, rotation and position of each visual of a motor link."""
    link = ET.fromstring(text).find(f"link[@name='ocs_{side}_motor']")
    for visual in link.findall("visual"):
        origin, shape = visual.find("origin"), visual.find("geometry")[0]
        rpy = [float(word) for word in origin.get("rpy").split()]
        rotation = Rotation.from_euler("xyz", rpy).as_matrix()
        numbers = [float(word) for word in " ".join(shape.attrib.values()).split()]
        position = [float(word) for word in origin.get("xyz").split()]
        yield shape.tag, sorted(numbers), rotation, position


def placed_by_sdf(text, side):
    link = ET.fromstring(text.encode()).find(f"model/link[@name='ocs_{side}_motor']")
    for visual in link.findall("visual"):
        pose = [float(word) for word in visual.findtext("pose").split()]
        rotation = Rotation.from_euler("xyz", pose[3:]).as_matrix()
        shape = visual.find("geometry")[0]
        numbers = [float(word) for child in shape for word in child.text.split()]
        yield shape.tag, sorted(numbers), rotation, pose[:3]


def placed_as_designed(module):
    for visual in plain_visuals(DEVICE, module):
        size = [2.0 * half for half in visual.size]
        if visual.kind == "cylinder":
            size = [visual.size[0], 2.0 * visual.size[1]]
        yield visual.kind.value, sorted(size), visual.place.rotation, visual.place.position


def check_equal(ours, theirs):
    ours, theirs = list(ours), list(theirs)
    assert len(ours) == 5
    for (kind, *numbers), (other, *others) in zip(ours, theirs, strict=True):
        assert kind == other
        for our, their in zip(numbers, others, strict=True):
            np.testing.assert_allclose(our, their, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("module", DEVICE.modules, ids=("left", "right"))
def test_snippets_have_boxes_and_cylinders_in_their_places(module, tmp_path):
    seat, expected = TrunkOnly(), list(placed_as_designed(module))
    text = snippet_urdf(DEVICE, seat)
    check_equal(placed_by_urdf(text, module.name), expected)
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(DEVICE, seat))
    text = expand_macro(tmp_path, f'<xacro:ocs parent="{TRUNK}"/>')
    check_equal(placed_by_urdf(text, module.name), expected)
    check_equal(placed_by_sdf(snippet_sdf(DEVICE, seat), module.name), expected)
    model = mujoco.MjModel.from_xml_string(snippet_mjcf(DEVICE, seat))
    body = model.body(f"{module.name}_motor")
    geoms = range(int(body.geomadr[0]), int(body.geomadr[0] + body.geomnum[0]))
    for geom, (_, _, rotation, position) in zip(geoms, expected, strict=True):
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, model.geom_quat[geom])
        np.testing.assert_allclose(matrix.reshape(3, 3), rotation, atol=1e-14)
        np.testing.assert_allclose(model.geom_pos[geom], position, atol=1e-14)
        assert (model.geom_contype[geom], model.geom_conaffinity[geom]) == (0, 0)


def test_boxes_and_cylinders_are_as_large_as_the_meshes():
    *_, foot = printed_parts(DEVICE)
    mesh, boxes = part_mesh(foot).vertices, []
    for visual in plain_visuals(DEVICE, LEFT):
        if visual.name == "foot":
            place = FOOT.placement.inverse() @ visual.place
            half = visual.size
            if visual.kind == "cylinder":
                half = (visual.size[0], visual.size[0], visual.size[1])
            extent = np.abs(place.rotation) @ half
            boxes += [place.position - extent, place.position + extent]
    np.testing.assert_allclose(np.min(boxes, axis=0), mesh.min(axis=0), atol=2e-5)
    np.testing.assert_allclose(np.max(boxes, axis=0), mesh.max(axis=0), atol=2e-5)


@pytest.mark.parametrize(
    "drive", [replace(DRIVE, length=None), replace(geared(1.5), diameter=0.043, length=LENGTH)]
)
def test_a_motor_of_unknown_size_or_place_is_left_out(drive):
    names = [visual.name for visual in still_visuals(driven_device(ALPHA, drive), LEFT)]
    assert names == ["housing", "foot"]


def test_massless_carriers_are_not_shown(robot, tmp_path):
    assert still_visuals(paper_device(), LEFT) == ()
    text = robot_urdf(robot, paper_device()).decode()
    write_meshes(paper_device(), tmp_path)
    assert "ocs_housing" not in text
    assert "_motor" not in text
    assert [path.name for path in (tmp_path / "meshes").iterdir()] == ["ocs_flywheel.stl"]
