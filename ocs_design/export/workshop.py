"""What the workshop gets: the wheel's pieces, and what is printed around it."""

from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar

from ocs_design.design import Device
from ocs_design.drive_solids import motor_mount
from ocs_design.export.made_wheel import made_wheel
from ocs_design.export.stl import MILLIMETRES, wheel_meshes
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.mesh import part_mesh
from ocs_design.parts.mount import made_mount
from ocs_design.parts.part import Part
from ocs_design.parts.stl import mesh_stl
from ocs_design.parts.threemf import threemf_bytes
from ocs_design.parts.wheel_parts import wheel_parts
from ocs_design.sizing.housing import LID_SCREW

Piece = TypeVar("Piece")


def export_pieces_stl(device: Device, folder: Path) -> None:
    """`flywheel.stl`, or one file for each of its pieces, in millimetres."""
    for name, mesh in _by_file(wheel_meshes(device.flywheel)).items():
        (folder / f"{name}.stl").write_bytes(mesh_stl(mesh, name, units_per_metre=MILLIMETRES))


def export_pieces_3mf(device: Device, folder: Path) -> None:
    """`flywheel.3mf` with all pieces of the wheel."""
    (folder / "flywheel.3mf").write_bytes(threemf_bytes(wheel_meshes(device.flywheel)))


def export_step(device: Device, folder: Path) -> None:
    """`flywheel.step`, or one file for each of its pieces, and one for each printed part.

    Raises:
        MissingToolError: Open CASCADE is not installed.
    """
    # An extra, which takes seconds to import.
    from ocs_design.parts.step import step_bytes  # noqa: PLC0415

    parts = {part.name: part for part in wheel_parts(made_wheel(device.flywheel))}
    printed = {f"housing_{part.name}": part for part in printed_parts(device)}
    for name, part in (_by_file(parts) | printed).items():
        (folder / f"{name}.step").write_bytes(step_bytes(part))


def export_printed(device: Device, folder: Path) -> str:
    """What is printed of one module as STL, and all of them in `housing.3mf`.

    Returns:
        What they weigh, and whether the design counts it.
    """
    parts = printed_parts(device)
    meshes = {part.name: part_mesh(part) for part in parts}
    for name, mesh in meshes.items():
        path = folder / f"housing_{name}.stl"
        path.write_bytes(mesh_stl(mesh, name, units_per_metre=MILLIMETRES))
    (folder / "housing.3mf").write_bytes(threemf_bytes(meshes))
    return _weighed(parts, device)


def printed_parts(device: Device) -> tuple[Part, ...]:
    """Drum, lid and foot around one wheel, with the motor's holes where they are known and fit.

    And the cage of a motor that is held by its back.

    Raises:
        PartError: they cannot be made.
    """
    foot, cage = printed_foot(device), motor_mount(device).cage
    caged = () if cage is None else (cage_part(cage),)
    return (*housing_parts(foot.housing), foot_part(foot), *caged)


def printed_foot(device: Device) -> Foot:
    """Of one module, with the housing that it carries."""
    wheel, mount = device.flywheel, made_mount(motor_mount(device).holes)
    return Foot(Housing(wheel.outer_radius, wheel.height, mount, LID_SCREW))


def _weighed(parts: tuple[Part, ...], device: Device) -> str:
    masses = {part.name: 1e3 * part.mass_properties().mass for part in parts}
    shell, cage = masses["drum"] + masses["lid"], masses.get("cage")
    caged = "" if cage is None else f", the motor's cage {cage:.1f} g"
    counted = "" if device.carrier.mass > 0.0 else "; a device without motors counts none of it"
    return (
        f"printed parts of one module: drum and lid {shell:.1f} g, foot {masses['foot']:.1f} g"
        f"{caged}{counted}"
    )


def _by_file(pieces: Mapping[str, Piece]) -> dict[str, Piece]:
    """A wheel of one piece is the flywheel itself."""
    if len(pieces) == 1:
        return {"flywheel": next(iter(pieces.values()))}
    return {f"flywheel_{name}": piece for name, piece in pieces.items()}
