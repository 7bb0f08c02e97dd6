"""DXF of wheel, plate and drilling template in millimetres, for lathes, lasers and CAD.

A wheel's file has two views side by side: the front view along the axis, and half the section as
it is turned, with the axis along x. They are on different layers.
"""

from io import StringIO
from pathlib import Path

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.document import Drawing
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace

from ocs_design.common.arrays import FloatArray
from ocs_design.common.units import MILLIMETRES
from ocs_design.export.device_parts import BLOCK, plate_pieces, wheel_pieces
from ocs_design.export.drawing import sheet
from ocs_design.export.drawing.sheet import Area, Circle, Lettering, Line, Polyline
from ocs_design.export.drilling import CHECK, Drilling, bounds, drilling_of
from ocs_design.export.formats import Notes, Subject
from ocs_design.parts.solids import Part, Prism, Revolution

OUTLINE, HOLES, AXES, SECTION = "OUTLINE", "HOLES", "AXES", "SECTION"
"""Layers: largest and smallest circle of the front view; holes; centre lines; half section."""

FEET, TEXT = "FEET", "TEXT"
"""Further layers of the drilling template: parts on the trunk; words and the check length."""

_COLORS = {OUTLINE: 7, HOLES: 1, AXES: 8, SECTION: 5, FEET: 3, TEXT: 7}
"""Colours of the layers by AutoCAD number: black or white, red, grey, blue, green."""

GAP = 20.0
"""Distance between front view and section, and length of centre lines beyond both [mm]."""


def write(subject: Subject, folder: Path) -> Notes:
    """Write `flywheel.dxf`, or one for each of the wheel's pieces, `plate.dxf`, `drilling.dxf`."""
    pieces = {**wheel_pieces(subject.device.flywheel), **plate_pieces(subject.device)}
    for name, piece in pieces.items():
        if name in ("mast", BLOCK):
            continue
        (folder / f"{name}.dxf").write_text(dxf_text(piece), encoding="utf-8", newline="\n")
    if drilling := drilling_of(subject):
        text = drilling_text(drilling)
        (folder / "drilling.dxf").write_text(text, encoding="utf-8", newline="\n")
    return ()


def dxf_text(piece: Part) -> str:
    """DXF of a piece of the wheel, with the axis of its front view at the origin, or of the plate.

    The piece is a body of revolution about z, or plates in the xy plane, with holes along z.
    """
    document = _new_document()
    space = document.modelspace()
    # Blind holes in both faces coincide in this view, and are drawn once.
    cuts = (cut.outline for cut in piece.cut if isinstance(cut, Prism))
    for outline in {outline.points.tobytes(): outline for outline in cuts}.values():
        _add_outline(space, MILLIMETRES * outline.points, outline.bulges, HOLES)
    edges = []
    for body in piece.joined:
        if isinstance(body, Prism):
            edges.append(body.outline.points)
            _add_outline(space, MILLIMETRES * edges[-1], body.outline.bulges, OUTLINE)
        elif isinstance(body, Revolution):
            # Its circles and, beside them, half its section, with centre lines.
            radii, heights = MILLIMETRES * body.profile.T
            inner, outer = float(radii.min()), float(radii.max())
            for radius in (outer, inner) if inner > 0.0 else (outer,):
                space.add_circle((0.0, 0.0), radius, dxfattribs={"layer": OUTLINE})
            start, beyond = outer + GAP - float(heights.min()), GAP / 4.0
            section = np.column_stack([start + heights, radii])
            _add_outline(space, section, np.zeros(len(section)), SECTION)
            left, right = section[:, 0].min() - beyond, section[:, 0].max() + beyond
            _add_axes(space, outer + beyond, outer + beyond)
            space.add_line((float(left), 0.0), (float(right), 0.0), dxfattribs={"layer": AXES})
    if edges:
        across, along = MILLIMETRES * np.abs(np.concatenate(edges)).max(axis=0) + GAP / 4.0
        _add_axes(space, float(across), float(along) + float(across))
    return _text_of(document)


def drilling_text(drilling: Drilling) -> str:
    """DXF of the trunk's drilling template, in the frame of the trunk."""
    document = _new_document()
    space = document.modelspace()
    for item in drilling.items:
        match item:
            case Circle(center, radius, pen):
                layer = HOLES if pen is sheet.OUTLINE else FEET
                space.add_circle(center, radius, dxfattribs={"layer": layer})
            case Line(start, end):
                space.add_line(start, end, dxfattribs={"layer": AXES})
            case Polyline(points) | Area(points):
                space.add_lwpolyline(points, close=True, dxfattribs={"layer": FEET})
            case Lettering(place, text, height):
                _add_text(space, text, place, height)
    (_, low, _, high), half = bounds(drilling.items), CHECK / 2.0
    if drilling.refused:
        _add_text(space, drilling.refused, (-half, high + GAP / 2.0), 2.5)
    for line, words in enumerate(drilling.words, start=1):
        _add_text(space, words, (-half, low - line * GAP / 2.0), 2.5)
    y = low - 3.0 * GAP
    ends = ((x, y - 2.0, x, y + 2.0) for x in (-half, half))
    for left, bottom, right, top in ((-half, y, half, y), *ends):
        space.add_line((left, bottom), (right, top), dxfattribs={"layer": TEXT})
    _add_text(space, f"{CHECK:.0f} mm", (-4.0, y + 1.0), 2.5)
    return _text_of(document)


def _new_document() -> Drawing:
    """Empty drawing in millimetres, with the layers."""
    # Without time stamps and counters, so that equal pieces give equal bytes.
    ezdxf.options.write_fixed_meta_data_for_testing = True  # type: ignore[attr-defined]  # documented
    document = new("R2010", units=units.MM)
    document.linetypes.add("CENTER", [20.0, 12.5, -2.5, 2.5, -2.5])
    for name, color in _COLORS.items():
        document.layers.add(name, color=color, linetype="CENTER" if name == AXES else "CONTINUOUS")
    return document


def _text_of(document: Drawing) -> str:
    """Text of the DXF file."""
    # Sorted, because ezdxf would add them in the order of a set.
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    stream = StringIO()
    document.write(stream)
    return stream.getvalue()


def _add_text(space: Modelspace, text: str, place: tuple[float, float], height: float) -> None:
    """Add a line of lettering that starts at `place` [mm]."""
    space.add_text(text, dxfattribs={"layer": TEXT, "insert": place, "height": height})


def _add_axes(space: Modelspace, across: float, along: float) -> None:
    """Add centre lines through the origin with these half lengths [mm]."""
    for x, y in ((across, 0.0), (0.0, along)):
        space.add_line((-x, -y), (x, y), dxfattribs={"layer": AXES})


def _add_outline(space: Modelspace, points: FloatArray, bulges: FloatArray, layer: str) -> None:
    """Add a closed polyline whose edges are lines or, with a bulge, arcs."""
    corners = [(*point, bulge) for point, bulge in zip(points.tolist(), bulges, strict=True)]
    space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs={"layer": layer})
