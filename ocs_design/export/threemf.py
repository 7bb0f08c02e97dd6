"""Meshes in 3MF, which tells slicers the unit and the parts' names, unlike STL.

3MF Consortium, 3D Manufacturing Format, Core Specification 1.3: a zip archive with the model in
XML, in millimetres. Written directly, because files by trimesh and lib3mf differ from run to run.
"""

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from ocs_design.common.units import MILLIMETRES
from ocs_design.export.device_parts import wheel_pieces
from ocs_design.export.formats import Notes, Subject
from ocs_design.export.meshes import Mesh
from ocs_design.export.stl import wheel_meshes
from ocs_design.export.templates import fill, template_text

GAP = 0.01
"""Distance between parts on the printer's bed [m]."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `flywheel.3mf` with all pieces of the wheel."""
    wheel = subject.device.flywheel
    names = (piece.name for piece in wheel_pieces(wheel).values())
    meshes = dict(zip(names, wheel_meshes(wheel).values(), strict=True))
    (folder / "flywheel.3mf").write_bytes(threemf_bytes(meshes))
    return ()


def threemf_bytes(meshes: Mapping[str, Mesh]) -> bytes:
    """3MF with each mesh as a named object, in a row on the bed, reproducible byte for byte."""
    objects, items, left = [], [], 0.0
    for number, (name, mesh) in enumerate(meshes.items(), start=1):
        points, faces = MILLIMETRES * mesh.vertices, mesh.triangles
        objects += [
            f'<object id="{number}" type="model" name={quoteattr(name)}><mesh>\n<vertices>',
            *(f'<vertex x="{x:.6f}" y="{y:.6f}" z="{z:.6f}"/>' for x, y, z in points),
            "</vertices>\n<triangles>",
            *(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces),
            "</triangles>\n</mesh></object>",
        ]
        # Side by side along x, none below the bed.
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        x, y, z = MILLIMETRES * (np.array([left, 0.0, 0.0]) - low)
        items.append(
            f'<item objectid="{number}" transform="1 0 0 0 1 0 0 0 1 {x:.6f} {y:.6f} {z:.6f}"/>'
        )
        left += float(high[0] - low[0]) + GAP
    model = fill("3mf/model.xml", {"objects": "\n".join(objects), "items": "\n".join(items)})
    texts = {
        "[Content_Types].xml": template_text("3mf/content_types.xml"),
        "_rels/.rels": template_text("3mf/relationships.xml"),
        "3D/3dmodel.model": model,
    }
    buffer = BytesIO()
    with ZipFile(buffer, "w") as archive:
        for name, text in texts.items():
            # Without traces of time and machine.
            entry = ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.create_system = 3
            archive.writestr(entry, text, ZIP_DEFLATED)
    return buffer.getvalue()
