"""Parts that are alike are meshed once: meshing is most of what a booklet takes."""

import pickle

import pytest

from ocs_design.export.assembly import placed
from ocs_design.export.meshes import part_mesh


@pytest.fixture(scope="package", autouse=True)
def meshed_once():
    made = {}

    def meshed(part, sections):
        key = pickle.dumps((part, sections))
        if key not in made:
            made[key] = part_mesh(part, sections)
        return made[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(placed, "part_mesh", meshed)
        yield
