"""Writers of a sheet as SVG and PDF, which look the same and are reproducible byte for byte."""

from collections.abc import Iterable, Sequence
from io import BytesIO
from xml.sax.saxutils import escape

from reportlab.pdfgen.canvas import Canvas
from reportlab.pdfgen.pathobject import PDFPathObject

from ocs_design.export.drawing.sheet import (
    FONT,
    HEIGHT,
    WIDTH,
    Area,
    Box,
    Circle,
    Item,
    Lettering,
    Line,
    Pen,
    Point,
    Polyline,
    printable,
)

FONTS = "Helvetica, Arial, 'Liberation Sans', sans-serif"
"""Typefaces of SVG in order of preference; all but the last have Helvetica's widths."""

POINTS_PER_MM = 72.0 / 25.4


def pdf_of_pages(pages: Iterable[Iterable[Item]], title: str, *, compressed: bool = False) -> bytes:
    """PDF of several sheets, each an A4 page; `compressed` is for more than a drawing."""
    buffer = BytesIO()
    size = (WIDTH * POINTS_PER_MM, HEIGHT * POINTS_PER_MM)
    # Invariant: without a time stamp. An uncompressed drawing is 17 kB and readable as text.
    canvas = Canvas(buffer, pagesize=size, invariant=1, pageCompression=int(compressed))
    canvas.setTitle(printable(title))
    canvas.setCreator("ocs-design")
    canvas.setAuthor("")
    canvas.setSubject("")
    for items in pages:
        canvas.scale(POINTS_PER_MM, POINTS_PER_MM)
        # PDF counts y upwards.
        for item in items:
            match item:
                case Line((x1, y1), (x2, y2), pen):
                    _set_pen(canvas, pen)
                    canvas.line(x1, HEIGHT - y1, x2, HEIGHT - y2)
                case Polyline(points, pen):
                    _set_pen(canvas, pen)
                    canvas.drawPath(_path(canvas, points))
                case Circle((x, y), radius, pen):
                    _set_pen(canvas, pen)
                    canvas.circle(x, HEIGHT - y, radius)
                case Area(corners, white):
                    canvas.setFillGray(1.0 if white else 0.0)
                    path = _path(canvas, corners)
                    path.close()
                    canvas.drawPath(path, stroke=0, fill=1)
                    canvas.setFillGray(0.0)
                case Lettering():
                    x, y = item.start
                    text = canvas.beginText()
                    text.setFont(FONT, item.size)
                    rotation = (0, 1, -1, 0) if item.upright else (1, 0, 0, 1)
                    text.setTextTransform(*rotation, x, HEIGHT - y)
                    text.textOut(item.text)
                    canvas.drawText(text)
        canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def both_formats(items: Sequence[Item], title: str) -> dict[str, bytes]:
    """Files of one sheet by their suffixes `svg` and `pdf`."""
    picture = svg_text(items, title, (0.0, 0.0, WIDTH, HEIGHT)) + "\n"
    return {"svg": picture.encode(), "pdf": pdf_of_pages([items], title)}


def _path(canvas: Canvas, points: Sequence[Point]) -> PDFPathObject:
    (x, y), *others = points
    path = canvas.beginPath()
    path.moveTo(x, HEIGHT - y)
    for x, y in others:
        path.lineTo(x, HEIGHT - y)
    return path


def _set_pen(canvas: Canvas, pen: Pen) -> None:
    canvas.setLineWidth(pen.width)
    canvas.setDash(list(pen.dashes))


def svg_text(items: Iterable[Item], title: str, box: Box) -> str:
    """SVG of a box of the sheet [mm] at actual size."""
    left, top, right, bottom = box
    width_mm, height_mm = _num(right - left), _num(bottom - top)
    elements = []
    for item in items:
        match item:
            case Line((x1, y1), (x2, y2), pen):
                attributes = f'x1="{_num(x1)}" y1="{_num(y1)}" x2="{_num(x2)}" y2="{_num(y2)}"'
                elements.append(f"<line {attributes}{_stroke(pen)}/>")
            case Polyline(corners, pen):
                points = " ".join(f"{_num(round(x, 2))},{_num(round(y, 2))}" for x, y in corners)
                elements.append(f'<polyline points="{points}"{_stroke(pen)}/>')
            case Circle((x, y), radius, pen):
                attributes = f'cx="{_num(x)}" cy="{_num(y)}" r="{_num(radius)}"'
                elements.append(f"<circle {attributes}{_stroke(pen)}/>")
            case Area(corners, white):
                points = " ".join(f"{_num(x)},{_num(y)}" for x, y in corners)
                fill = "#fff" if white else "#000"
                elements.append(f'<polygon points="{points}" fill="{fill}" stroke="none"/>')
            case Lettering():
                x, y = item.start
                rotation = f' transform="rotate(-90 {_num(x)} {_num(y)})"' if item.upright else ""
                # With its width given, it has the measured length in any font.
                width = f' textLength="{_num(item.width)}" lengthAdjust="spacingAndGlyphs"'
                elements.append(
                    f'<text x="{_num(x)}" y="{_num(y)}" font-size="{_num(item.size)}" fill="#000" '
                    f'stroke="none"{width if item.text else ""}{rotation} xml:space="preserve">'
                    f"{escape(item.text)}</text>"
                )
    body = "\n".join(elements)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width_mm}mm" height="{height_mm}mm" '
        f'viewBox="{_num(left)} {_num(top)} {width_mm} {height_mm}" font-family="{FONTS}" '
        'fill="none" stroke="#000">\n'
        f"<title>{escape(title)}</title>\n"
        f'<rect x="{_num(left)}" y="{_num(top)}" width="{width_mm}" height="{height_mm}" '
        'fill="#fff" stroke="none"/>\n'
        f"{body}\n</svg>"
    )


def _stroke(pen: Pen) -> str:
    dashes = " ".join(map(_num, pen.dashes))
    pattern = f' stroke-dasharray="{dashes}"' if dashes else ""
    return f' stroke-width="{_num(pen.width)}"{pattern}'


def _num(value: float) -> str:
    """Coordinate rounded to a tenth of a micrometre."""
    return f"{round(value, 4) + 0.0:.10g}"
