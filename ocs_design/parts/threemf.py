"""Meshes in 3MF, for printing.

3MF Consortium, 3D Manufacturing Format, Core Specification 1.3: a zip archive with the model in
XML, in millimetres. Slicers know from it the unit and the parts' names, which STL has not.
"""

from collections.abc import Mapping
from io import BytesIO
from xml.sax.saxutils import quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from ocs_design.parts.mesh import Mesh

GAP = 0.01
"""Between parts on the printer's bed [m]."""

_MILLIMETRES = 1000.0

_CONTENT_TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" \
ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""

_RELATIONSHIPS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="model" Target="/3D/3dmodel.model" \
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""

_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" \
xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<metadata name="Application">ocs-design</metadata>
<resources>
{objects}
</resources>
<build>
{items}
</build>
</model>
"""


def threemf_bytes(meshes: Mapping[str, Mesh]) -> bytes:
    """Each mesh as an object of that name, in a row on the bed; the same bytes every time."""
    numbered = list(enumerate(meshes.items(), start=1))
    model = _MODEL.format(
        objects="\n".join(_object(number, name, mesh) for number, (name, mesh) in numbered),
        items="\n".join(_items(list(meshes.values()))),
    )
    buffer = BytesIO()
    with ZipFile(buffer, "w") as archive:
        _add(archive, "[Content_Types].xml", _CONTENT_TYPES)
        _add(archive, "_rels/.rels", _RELATIONSHIPS)
        _add(archive, "3D/3dmodel.model", model)
    return buffer.getvalue()


def _object(number: int, name: str, mesh: Mesh) -> str:
    vertices = "\n".join(
        f'<vertex x="{x:.6f}" y="{y:.6f}" z="{z:.6f}"/>' for x, y, z in _MILLIMETRES * mesh.vertices
    )
    triangles = "\n".join(
        f'<triangle v1="{first}" v2="{second}" v3="{third}"/>'
        for first, second, third in mesh.triangles
    )
    return (
        f'<object id="{number}" type="model" name={quoteattr(name)}><mesh>\n'
        f"<vertices>\n{vertices}\n</vertices>\n"
        f"<triangles>\n{triangles}\n</triangles>\n"
        "</mesh></object>"
    )


def _items(meshes: list[Mesh]) -> list[str]:
    """Where the objects stand: side by side along x, none below the bed."""
    items, left = [], 0.0
    for number, mesh in enumerate(meshes, start=1):
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        x, y, z = _MILLIMETRES * (np.array([left, 0.0, 0.0]) - low)
        items.append(
            f'<item objectid="{number}" transform="1 0 0 0 1 0 0 0 1 {x:.6f} {y:.6f} {z:.6f}"/>'
        )
        left += float(high[0] - low[0]) + GAP
    return items


def _add(archive: ZipFile, name: str, text: str) -> None:
    # Without the clock and the machine that the archive is made on.
    entry = ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    entry.create_system = 3
    entry.compress_type = ZIP_DEFLATED
    archive.writestr(entry, text)
