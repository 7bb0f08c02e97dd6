"""A drawing as PDF: one page, uncompressed, no fonts of its own, the same bytes every time."""

import hashlib
from collections.abc import Iterable, Sequence

from ocs_design.drawing.helvetica import ENCODING, printable
from ocs_design.drawing.sheet import HEIGHT, WIDTH, Area, Circle, Item, Line, Pen, Point, Text

POINTS_PER_MM = 72.0 / 25.4

_QUARTER = 0.5522847498
"""Handles of a Bezier curve that is a quarter of the unit circle to 3e-4: 4 (sqrt 2 - 1) / 3."""


def pdf_bytes(items: Iterable[Item], title: str) -> bytes:
    """The sheet at its size, A4 (ISO 32000-1)."""
    content = "\n".join(
        [f"{_num(POINTS_PER_MM)} 0 0 {_num(POINTS_PER_MM)} 0 0 cm", *map(_draw, items)]
    )
    page = f"/MediaBox [0 0 {_num(WIDTH * POINTS_PER_MM)} {_num(HEIGHT * POINTS_PER_MM)}]"
    objects = [
        "<< /Type /Catalog /Pages 2 0 R >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R {page} /Contents 4 0 R "
        "/Resources << /Font << /F 5 0 R >> >> >>",
        f"<< /Length {len(content)} >>\nstream\n{content}\nendstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        f"<< /Title {_string(printable(title))} /Producer (ocs-design) >>",
    ]
    return _file([each.encode("ascii") for each in objects])


def _file(objects: Sequence[bytes]) -> bytes:
    """Objects with the table of where each begins."""
    # Four bytes beyond ASCII tell transfer programs that the file is binary.
    written, starts = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", []
    for number, each in enumerate(objects, start=1):
        starts.append(len(written))
        written += b"%d 0 obj\n%b\nendobj\n" % (number, each)
    rows = b"".join(b"%010d 00000 n \n" % start for start in starts)
    identity = hashlib.sha256(written).hexdigest()[:32].encode()
    trailer = b"<< /Size %d /Root 1 0 R /Info %d 0 R /ID [<%b> <%b>] >>"
    return b"%bxref\n0 %d\n0000000000 65535 f \n%btrailer\n%b\nstartxref\n%d\n%%%%EOF\n" % (
        written,
        len(objects) + 1,
        rows,
        trailer % (len(objects) + 1, len(objects), identity, identity),
        len(written),
    )


def _draw(item: Item) -> str:
    match item:
        case Line(start, end, pen):
            return f"{_pen(pen)} {_at(start)} m {_at(end)} l S"
        case Circle(center, radius, pen):
            return f"{_pen(pen)} {_circle(center, radius)} s"
        case Area(corners):
            return f"{_at(corners[0])} m {' '.join(f'{_at(each)} l' for each in corners[1:])} f"
        case Text():
            turn = "0 1 -1 0" if item.upright else "1 0 0 1"
            font = f"/F {_num(item.size)} Tf"
            return f"BT {font} {turn} {_at(item.start)} Tm {_string(item.text)} Tj ET"


def _circle(center: Point, radius: float) -> str:
    """Four curves, from the right counter-clockwise."""
    (x, y), k = center, _QUARTER
    quarters = [
        ((1, k), (k, 1), (0, 1)),
        ((-k, 1), (-1, k), (-1, 0)),
        ((-1, -k), (-k, -1), (0, -1)),
        ((k, -1), (1, -k), (1, 0)),
    ]
    curves = [
        " ".join(_at((x + radius * u, y - radius * v)) for u, v in quarter) for quarter in quarters
    ]
    return f"{_at((x + radius, y))} m {' '.join(f'{curve} c' for curve in curves)}"


def _pen(pen: Pen) -> str:
    return f"{_num(pen.width)} w [{' '.join(map(_num, pen.dashes))}] 0 d"


def _string(text: str) -> str:
    """Bytes of the encoding; all that is not plainly a letter as an octal number."""
    encoded = text.encode(ENCODING)
    plain = [
        chr(code) if chr(code).isalnum() and code < 128 else f"\\{code:03o}" for code in encoded
    ]
    return f"({''.join(plain)})"


def _at(point: Point) -> str:
    """PDF counts y upwards."""
    return f"{_num(point[0])} {_num(HEIGHT - point[1])}"


def _num(value: float) -> str:
    """Never with an exponent, which PDF does not know."""
    return f"{round(value, 4) + 0.0:.4f}".rstrip("0").rstrip(".")
