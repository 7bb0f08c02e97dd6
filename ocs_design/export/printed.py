"""Housing, foot and cage of one module for the printer: STL each, and all of them as 3MF."""

from pathlib import Path

from ocs_design.export.device_parts import printed_parts, ring_fixture
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import part_mesh
from ocs_design.export.stl import MILLIMETRES, stl_bytes
from ocs_design.export.threemf import threemf_bytes


def write(subject: Subject, folder: Path) -> Notes:
    """Write `housing_<part>.stl` and `housing.3mf`; wheels alone get a housing and no cage.

    A ring that is bonded on has `ring_fixture.stl` too.
    """
    parts = printed_parts(subject.device)
    meshes = {part.name: part_mesh(part) for part in parts}
    for name, mesh in meshes.items():
        content = stl_bytes(mesh, name, units_per_metre=MILLIMETRES)
        (folder / f"housing_{name}.stl").write_bytes(content)
    fixture = ring_fixture(subject.device)
    if fixture is not None:
        content = stl_bytes(part_mesh(fixture), fixture.name, units_per_metre=MILLIMETRES)
        (folder / f"{fixture.name}.stl").write_bytes(content)
    (folder / "housing.3mf").write_bytes(threemf_bytes(meshes))
    return ()
