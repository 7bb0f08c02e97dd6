"""The flywheel in binary STL: whole for robot files, piece by piece for the workshop."""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from ocs_design.design import Flywheel
from ocs_design.export.made_wheel import made_wheel
from ocs_design.parts.mesh import Mesh, part_mesh, together
from ocs_design.parts.stl import METRES, MILLIMETRES, mesh_stl
from ocs_design.parts.wheel_parts import wheel_parts

__all__ = ["METRES", "MILLIMETRES", "export_stl", "stl_bytes", "wheel_meshes"]


def export_stl(flywheel: Flywheel, path: Path, *, units_per_metre: float) -> Path:
    """Write the whole wheel; see `stl_bytes`."""
    path.write_bytes(stl_bytes(flywheel, units_per_metre=units_per_metre))
    return path


def stl_bytes(flywheel: Flywheel, *, units_per_metre: float) -> bytes:
    """The whole wheel, its centre at the origin and its spin axis along z.

    Args:
        flywheel: a bore of zero makes its rim a disc.
        units_per_metre: STL has no unit; `MILLIMETRES` for printing, `METRES` for robot files.
    """
    whole = together(list(wheel_meshes(flywheel).values()))
    return mesh_stl(whole, "flywheel", units_per_metre=units_per_metre)


@lru_cache(maxsize=1)
def wheel_meshes(flywheel: Flywheel) -> Mapping[str, Mesh]:
    """Each piece as it is made, by its name; several formats ask for them."""
    return {part.name: part_mesh(part) for part in wheel_parts(made_wheel(flywheel))}
