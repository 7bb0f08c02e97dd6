"""A drawing as SVG."""

from collections.abc import Iterable
from xml.sax.saxutils import escape

from ocs_design.drawing.sheet import HEIGHT, WIDTH, Area, Circle, Item, Line, Pen, Text

FONTS = "Helvetica, Arial, 'Liberation Sans', sans-serif"
"""The first that there is; all have Helvetica's widths but the last."""


def svg_bytes(items: Iterable[Item], title: str) -> bytes:
    """The sheet at its size, A4."""
    body = "\n".join(_element(item) for item in items)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}mm" height="{HEIGHT:g}mm" '
        f'viewBox="0 0 {WIDTH:g} {HEIGHT:g}" font-family="{FONTS}" fill="none" stroke="#000">\n'
        f"<title>{escape(title)}</title>\n"
        f'<rect width="{WIDTH:g}" height="{HEIGHT:g}" fill="#fff" stroke="none"/>\n'
        f"{body}\n</svg>\n"
    ).encode()


def _element(item: Item) -> str:
    match item:
        case Line((x1, y1), (x2, y2), pen):
            place = f'x1="{_num(x1)}" y1="{_num(y1)}" x2="{_num(x2)}" y2="{_num(y2)}"'
            return f"<line {place}{_stroke(pen)}/>"
        case Circle((x, y), radius, pen):
            return f'<circle cx="{_num(x)}" cy="{_num(y)}" r="{_num(radius)}"{_stroke(pen)}/>'
        case Area(corners):
            points = " ".join(f"{_num(x)},{_num(y)}" for x, y in corners)
            return f'<polygon points="{points}" fill="#000" stroke="none"/>'
        case Text():
            return _text(item)


def _text(item: Text) -> str:
    """With its width, so that it is as long in any font as it was measured."""
    x, y = item.start
    turn = f' transform="rotate(-90 {_num(x)} {_num(y)})"' if item.upright else ""
    width = f' textLength="{_num(item.width)}" lengthAdjust="spacingAndGlyphs"' if item.text else ""
    return (
        f'<text x="{_num(x)}" y="{_num(y)}" font-size="{_num(item.size)}" fill="#000" stroke="none"'
        f'{width}{turn} xml:space="preserve">{escape(item.text)}</text>'
    )


def _stroke(pen: Pen) -> str:
    dashes = " ".join(map(_num, pen.dashes))
    return f' stroke-width="{_num(pen.width)}"' + (
        f' stroke-dasharray="{dashes}"' if dashes else ""
    )


def _num(value: float) -> str:
    """A coordinate to the tenth of a micrometre."""
    return f"{round(value, 4) + 0.0:.10g}"
