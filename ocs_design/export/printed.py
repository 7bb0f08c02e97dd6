"""Printed parts, housing, foot and cage of one module and pedestals: STL files and one 3MF."""

from pathlib import Path

from ocs_design.export.device_parts import printed_pieces
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import part_mesh
from ocs_design.export.stl import stl_bytes
from ocs_design.export.threemf import threemf_bytes


def write(subject: Subject, folder: Path) -> Notes:
    """Write `housing_<part>.stl`, `pedestal*.stl` for leaning feet, and `housing.3mf`.

    A bonded ring also gets `ring_fixture.stl`.
    """
    on_bed = {}
    for file, part in printed_pieces(subject.device).items():
        name, mesh = file.removeprefix("housing_"), part_mesh(part)
        (folder / f"{file}.stl").write_bytes(stl_bytes(mesh, name))
        on_bed[name] = mesh
    # A fixture is no part of the device.
    on_bed.pop("ring_fixture", None)
    (folder / "housing.3mf").write_bytes(threemf_bytes(on_bed))
    return ()
