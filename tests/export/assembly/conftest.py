"""Equal parts are meshed once, since meshing takes most of the time of a booklet."""

import pickle

import pytest

from ocs_design.export.assembly import placed
from ocs_design.export.meshes import part_mesh


@pytest.fixture(scope="package", autouse=True)
def meshed_once():
    meshes = {}

    def meshed(part, sections):
        key = pickle.dumps((part, sections))
        if key not in meshes:
            meshes[key] = part_mesh(part, sections)
        return meshes[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(placed, "part_mesh", meshed)
        yield
