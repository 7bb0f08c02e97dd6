"""Meshes in binary STL."""

import numpy as np

from ocs_design.parts.mesh import Mesh

METRES = 1.0
MILLIMETRES = 1000.0

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def mesh_stl(mesh: Mesh, name: str, *, units_per_metre: float) -> bytes:
    """A mesh in binary STL.

    Args:
        mesh: closed.
        name: stands in the header, cut to 69 bytes.
        units_per_metre: STL has no unit; `MILLIMETRES` for printing, `METRES` for robot files.
    """
    corners = units_per_metre * mesh.corners
    edges = corners[:, 1:] - corners[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    facets = np.zeros(len(corners), _FACET)
    facets["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    facets["corners"] = corners
    # A header that began with "solid" would be taken for text.
    header = f"ocs-design {name}".encode("ascii", "replace")[:80].ljust(80)
    return header + len(facets).to_bytes(4, "little") + facets.tobytes()
