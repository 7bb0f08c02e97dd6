"""The whole robot as GLB, read back by trimesh; the Khronos validator reports nothing either."""

import json

import numpy as np
import pytest
import trimesh
from exported import LEGGED, LEGGED_PATHS, data_in_posture, robot_at
from robots import SOLO12
from wheels import driven_device

from ocs_design.export.glb import robot_glb
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.reader import read_robot

DEVICE = driven_device()
UPRIGHT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
SHAPES = """<mujoco><asset><material name="red" rgba="1 0 0 0.5"/></asset><worldbody>
  <body name="trunk"><freejoint/>
    <geom name="box" type="box" size="0.1 0.2 0.3" pos="1 0 0" rgba="0.5 0.25 0 1"/>
    <geom name="ball" size="0.2" pos="0 2 0" material="red"/>
    <geom name="egg" type="ellipsoid" size="0.1 0.2 0.3" pos="0 0 3"/>
    <geom name="can" type="cylinder" size="0.1 0.4" pos="-4 0 0" euler="90 0 0"/>
    <geom name="pill" type="capsule" size="0.1 0.4" pos="0 -5 0"/>
    <geom name="ghost" size="0.2" pos="9 0 0" rgba="1 1 1 0"/>
    <geom name="hidden" size="0.2" pos="9 0 0" group="3"/>
  </body></worldbody></mujoco>"""


def written(robot, folder):
    model = robot_model(robot, DEVICE).compiled
    path = folder / "robot.glb"
    path.write_bytes(robot_glb(model, robot.posture))
    return model, trimesh.load_scene(path)


def document(path):
    content = path.read_bytes()
    assert content[:4] == b"glTF"
    assert int.from_bytes(content[8:12], "little") == len(content)
    length = int.from_bytes(content[12:16], "little")
    return json.loads(content[20 : 20 + length])


def visible_in_mujoco(model, posture):
    """Vertices of all visible meshes in the trunk frame [m], by MuJoCo."""
    data = data_in_posture(model, posture)
    base, points = data.site("ocs_imu"), []
    for geom in np.flatnonzero((model.geom_group < 3) & (model.geom_type == 7)):
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        vertices = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
        points.append(vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    return (np.concatenate(points) - base.xpos) @ base.xmat.reshape(3, 3)


@pytest.mark.slow
@pytest.mark.parametrize("path", LEGGED_PATHS[1::2], ids=LEGGED[1::2])
def test_real_robots_stand_as_mujoco_has_them(path, tmp_path):
    robot = robot_at(path)
    model, scene = written(robot, tmp_path)
    points = visible_in_mujoco(model, robot.posture) @ UPRIGHT.T
    vertices = scene.to_geometry().vertices
    # Primitives may extend beyond the meshes.
    assert (vertices.min(axis=0) <= points.min(axis=0) + 1e-6).all()
    assert (vertices.max(axis=0) >= points.max(axis=0) - 1e-6).all()
    assert (tmp_path / "robot.glb").stat().st_size < 4 * 2**20


def test_each_body_has_a_node_in_its_place(tmp_path):
    robot = robot_at(SOLO12)
    model, scene = written(robot, tmp_path)
    data = data_in_posture(model, robot.posture)
    for index in range(1, model.nbody):
        body = data.body(index)
        place, _ = scene.graph.get(body.name)
        np.testing.assert_allclose(place[:3, :3], UPRIGHT @ body.xmat.reshape(3, 3), atol=1e-9)
        np.testing.assert_allclose(place[:3, 3], UPRIGHT @ body.xpos, atol=1e-9)


@pytest.fixture
def shapes(tmp_path):
    (tmp_path / "in.xml").write_text(SHAPES)
    robot = read_robot(tmp_path / "in.xml", trunk="trunk", posture="zero")
    return written(robot, tmp_path)[1]


@pytest.mark.parametrize(
    ("name", "centre", "half", "volume"),
    [
        ("box", (1, 0, 0), (0.1, 0.2, 0.3), 0.048),
        ("ball", (0, 2, 0), (0.2, 0.2, 0.2), 4.0 / 3.0 * np.pi * 0.008),
        ("egg", (0, 0, 3), (0.1, 0.2, 0.3), 4.0 / 3.0 * np.pi * 0.006),
        ("can", (-4, 0, 0), (0.1, 0.4, 0.1), np.pi * 0.01 * 0.8),
        ("pill", (0, -5, 0), (0.1, 0.1, 0.5), np.pi * (0.01 * 0.8 + 4.0 / 3.0 * 0.001)),
    ],
)
def test_primitives_are_closed_solids_of_their_size(shapes, name, centre, half, volume):
    place, geometry = shapes.graph.get(name)
    mesh = shapes.geometry[geometry].copy()
    mesh.apply_transform(place)
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(volume, rel=0.03)
    bounds = np.array(mesh.bounds) @ UPRIGHT
    np.testing.assert_allclose(bounds.mean(axis=0), centre, atol=1e-6)
    np.testing.assert_allclose((bounds[1] - bounds[0]) / 2.0, half, atol=1e-6)


def test_hidden_geoms_are_left_out(shapes):
    assert {"ghost", "hidden"}.isdisjoint(shapes.graph.nodes)


def test_colours_are_linear_and_opacity_is_kept(shapes, tmp_path):
    gltf = document(tmp_path / "robot.glb")
    material = {mesh["name"]: mesh["primitives"][0]["material"] for mesh in gltf["meshes"]}
    red = gltf["materials"][material["ball"]]
    assert red["pbrMetallicRoughness"]["baseColorFactor"] == [1.0, 0.0, 0.0, 0.5]
    assert red["alphaMode"] == "BLEND"
    box = gltf["materials"][material["box"]]["pbrMetallicRoughness"]["baseColorFactor"]
    # IEC 61966-2-1: codes 128 and 64 of 255 are 21.6 % and 5.1 % of the light.
    np.testing.assert_allclose(box, [0.2140, 0.0509, 0.0, 1.0], atol=2e-4)
