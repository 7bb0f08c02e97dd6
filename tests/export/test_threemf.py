"""3MF files, read back by the consortium's own library."""

import lib3mf
import numpy as np
import pytest
import trimesh
from sample_parts import PARTS, SLOTTED, TUBE

from ocs_design.export.meshes import Mesh, part_mesh
from ocs_design.export.threemf import threemf_bytes

MICROMETRE_ON_BOX = 1e-6
"""Coordinates are written to 1e-6 mm."""


def read(content: bytes, path) -> lib3mf.Model:
    path.write_bytes(content)
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    return model


def objects(model: lib3mf.Model) -> list[lib3mf.MeshObject]:
    meshes, iterator = [], model.GetMeshObjects()
    while iterator.MoveNext():
        meshes.append(iterator.GetCurrentMeshObject())
    return meshes


def mesh_of(item: lib3mf.MeshObject) -> Mesh:
    """The object's mesh in metres."""
    vertices = np.array([list(vertex.Coordinates) for vertex in item.GetVertices()])
    triangles = np.array([list(triangle.Indices) for triangle in item.GetTriangleIndices()])
    return Mesh(vertices * 1e-3, triangles.astype(np.int64))


@pytest.mark.parametrize("part", PARTS.values(), ids=PARTS)
def test_a_part_is_read_back_with_its_volume(part, tmp_path):
    model = read(threemf_bytes({part.name: part_mesh(part)}), tmp_path / "part.3mf")
    assert model.GetUnit() == lib3mf.ModelUnit.MilliMeter
    (item,) = objects(model)
    assert item.GetName() == part.name
    assert item.IsManifoldAndOriented()
    volume = part.mass_properties().mass / part.density
    mesh = mesh_of(item)
    read_volume = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).volume
    assert read_volume == pytest.approx(volume, rel=MICROMETRE_ON_BOX)


def test_parts_stand_side_by_side_on_the_bed(tmp_path):
    meshes = {part.name: part_mesh(part, 32) for part in (SLOTTED, TUBE)}
    model = read(threemf_bytes(meshes), tmp_path / "parts.3mf")
    boxes, iterator = [], model.GetBuildItems()
    while iterator.MoveNext():
        item = iterator.GetCurrent()
        transform = np.array([list(row) for row in item.GetObjectTransform().Fields])
        (mesh,) = [
            mesh_of(mesh_object)
            for mesh_object in objects(model)
            if mesh_object.GetResourceID() == item.GetObjectResourceID()
        ]
        corners = 1e3 * mesh.vertices @ transform[:3] + transform[3]
        boxes.append((corners.min(axis=0), corners.max(axis=0)))
    (first_low, first_high), (second_low, _) = boxes
    np.testing.assert_allclose(first_low, 0.0, atol=1e-5)
    np.testing.assert_allclose(second_low[1:], 0.0, atol=1e-5)
    assert second_low[0] - first_high[0] == pytest.approx(10.0, abs=1e-4)


def test_a_name_with_markup_is_kept(tmp_path):
    name = "rim <\"&'> of Ö"
    model = read(threemf_bytes({name: part_mesh(TUBE, 8)}), tmp_path / "part.3mf")
    assert objects(model)[0].GetName() == name
