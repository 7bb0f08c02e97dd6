"""DXF of the wheel's pieces in the plane, in millimetres, by ezdxf: for lathes, lasers and CAD.

Each file has two views side by side: from the front, seen along the axis, and half the section as
it is turned, the axis along x. Layers tell them apart.
"""

from io import StringIO
from pathlib import Path

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace

from ocs_design.common.arrays import FloatArray
from ocs_design.export.device_parts import plate_pieces, wheel_pieces
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.part import Part
from ocs_design.parts.solids import Prism, Revolution

MILLIMETRES = 1000.0

OUTLINE, HOLES, AXES, SECTION = "OUTLINE", "HOLES", "AXES", "SECTION"
"""Layers: the largest and the smallest circle from the front; holes; centre lines; half section."""

_COLORS = {OUTLINE: 7, HOLES: 1, AXES: 8, SECTION: 5}
"""Colours of the layers by their numbers in AutoCAD: black or white, red, grey, blue."""

GAP = 20.0
"""Distance between front view and section, and of centre lines beyond both [mm]."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `flywheel.dxf`, or one for each of the wheel's pieces, and `plate.dxf`."""
    pieces = {**wheel_pieces(subject.device.flywheel), **plate_pieces(subject.device)}
    for name, piece in pieces.items():
        (folder / f"{name}.dxf").write_text(dxf_text(piece), encoding="utf-8", newline="\n")
    return ()


def dxf_text(piece: Part) -> str:
    """DXF of a piece of the wheel, the axis of its front view at the origin, or of the plate.

    Args:
        piece: a body of revolution about z, or a plate in the xy plane, with holes along z.
    """
    # Without clocks and counters the same piece has the same bytes.
    ezdxf.options.write_fixed_meta_data_for_testing = True  # type: ignore[attr-defined]  # documented
    document = new("R2010", units=units.MM)
    document.linetypes.add("CENTER", [20.0, 12.5, -2.5, 2.5, -2.5])
    for name, color in _COLORS.items():
        document.layers.add(name, color=color, linetype="CENTER" if name == AXES else "CONTINUOUS")
    space = document.modelspace()
    (turned,) = piece.joined
    # Blind holes in both faces lie behind each other, and are drawn once.
    cuts = (cut.outline for cut in piece.cut if isinstance(cut, Prism))
    for outline in {outline.points.tobytes(): outline for outline in cuts}.values():
        _add_outline(space, MILLIMETRES * outline.points, outline.bulges, HOLES)
    if isinstance(turned, Prism):
        edge = turned.outline
        _add_outline(space, MILLIMETRES * edge.points, edge.bulges, OUTLINE)
        across, along = MILLIMETRES * np.abs(edge.points).max(axis=0) + GAP / 4.0
        _add_axes(space, float(across), float(along) + float(across))
    else:
        _add_turned(space, turned)
    # Else ezdxf adds them in the order of a set.
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    stream = StringIO()
    document.write(stream)
    return stream.getvalue()


def _add_axes(space: Modelspace, across: float, along: float) -> None:
    """Add centre lines through the origin, so far to both sides [mm]."""
    for x, y in ((across, 0.0), (0.0, along)):
        space.add_line((-x, -y), (x, y), dxfattribs={"layer": AXES})


def _add_turned(space: Modelspace, turned: Revolution) -> None:
    """Add circles and half the section of a body of revolution, with its centre lines."""
    radii, heights = MILLIMETRES * turned.profile.T
    inner, outer = float(radii.min()), float(radii.max())
    for radius in (outer, inner) if inner > 0.0 else (outer,):
        space.add_circle((0.0, 0.0), radius, dxfattribs={"layer": OUTLINE})
    start, beyond = outer + GAP - float(heights.min()), GAP / 4.0
    section = np.column_stack([start + heights, radii])
    _add_outline(space, section, np.zeros(len(section)), SECTION)
    left, right = section[:, 0].min() - beyond, section[:, 0].max() + beyond
    _add_axes(space, outer + beyond, outer + beyond)
    space.add_line((float(left), 0.0), (float(right), 0.0), dxfattribs={"layer": AXES})


def _add_outline(space: Modelspace, points: FloatArray, bulges: FloatArray, layer: str) -> None:
    """Add a closed polyline whose edges are lines and, where they bulge, arcs."""
    corners = [(*point, bulge) for point, bulge in zip(points.tolist(), bulges, strict=True)]
    space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs={"layer": layer})
