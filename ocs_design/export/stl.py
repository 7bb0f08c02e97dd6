"""Binary STL, which has neither units nor colours: meshes of robot files, and parts to make.

Written directly, because importing trimesh takes 0.3 s, longer than writing a device's usual files.
"""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from ocs_design.common.units import MILLIMETRES
from ocs_design.device.device import Device
from ocs_design.export.device_parts import metal_pieces, wheel_pieces
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Mesh, merged, part_mesh
from ocs_design.export.visuals import WHEEL_MESH, still_meshes
from ocs_design.parts.wheel import Flywheel

METRES = 1.0
"""Units per metre in the meshes of robot files."""

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write(subject: Subject, folder: Path) -> Notes:
    """Write the wheel, or each of its pieces, plate, mast, block and guard ring, in mm."""
    others = {name: part_mesh(part) for name, part in metal_pieces(subject.device).items()}
    for name, mesh in {**wheel_meshes(subject.device.flywheel), **others}.items():
        (folder / f"{name}.stl").write_bytes(stl_bytes(mesh, name))
    return ()


@lru_cache(maxsize=1)
def wheel_meshes(flywheel: Flywheel) -> Mapping[str, Mesh]:
    """Meshes of the wheel's pieces by file name, cached because several formats use them."""
    return {name: part_mesh(piece) for name, piece in wheel_pieces(flywheel).items()}


def device_meshes(device: Device) -> Mapping[Path, bytes]:
    """STL files of wheel and fixed parts in metres, by their paths beside the robot file."""
    wheel = merged(list(wheel_meshes(device.flywheel).values()))
    files = {Path(WHEEL_MESH): stl_bytes(wheel, "flywheel", METRES)}
    for path, mesh in still_meshes(device).items():
        files[path] = stl_bytes(mesh, path.stem, METRES)
    return files


def stl_bytes(mesh: Mesh, name: str, units_per_metre: float = MILLIMETRES) -> bytes:
    """STL of a closed mesh, reproducible; its name in the header is truncated to 69 bytes."""
    corners = units_per_metre * mesh.corners
    edges = corners[:, 1:] - corners[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    facets = np.zeros(len(corners), _FACET)
    facets["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    facets["corners"] = corners
    # A header that starts with "solid" would be read as ASCII STL.
    header = f"ocs-design {name}".encode("ascii", "replace")[:80].ljust(80)
    return header + len(facets).to_bytes(4, "little") + facets.tobytes()
