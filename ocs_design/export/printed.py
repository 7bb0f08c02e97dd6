"""Printed parts, housing, foot and cage of one module and pedestals: STL files and one 3MF."""

from pathlib import Path

from ocs_design.export.device_parts import pedestal_kinds, printed_parts, ring_fixture
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import part_mesh
from ocs_design.export.stl import stl_bytes
from ocs_design.export.threemf import threemf_bytes


def write(subject: Subject, folder: Path) -> Notes:
    """Write `housing_<part>.stl`, `pedestal*.stl` for leaning feet, and `housing.3mf`.

    Wheels alone get a housing but no cage; a bonded ring also gets `ring_fixture.stl`.
    """
    device = subject.device
    meshes = {part.name: part_mesh(part) for part in printed_parts(device)}
    pedestals = {kind.name: part_mesh(kind.part) for kind in pedestal_kinds(device)}
    named = {f"housing_{name}": mesh for name, mesh in meshes.items()} | pedestals
    fixture = ring_fixture(device)
    if fixture is not None:
        named[fixture.name] = part_mesh(fixture)
    for name, mesh in named.items():
        content = stl_bytes(mesh, name.removeprefix("housing_"))
        (folder / f"{name}.stl").write_bytes(content)
    (folder / "housing.3mf").write_bytes(threemf_bytes({**meshes, **pedestals}))
    return ()
