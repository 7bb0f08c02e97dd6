"""Charts as SVG, inline in a page with its style sheet or as files, and as PNG files."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import escape
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.export.templates import template_file
from ocs_design.report.charts.chart import (
    Axis,
    Chart,
    Curve,
    FilledArea,
    Ink,
    Mark,
    Points,
    Rule,
    thinned,
    tick_text,
)

WIDTH = 440.0
"""Width of every chart [px]: legible without zooming on a telephone."""

_LEFT, _RIGHT, _BOTTOM, _TITLE = 62.0, 22.0, 40.0, 22.0
_LETTER_WIDTH = 6.8
"""Mean width of a letter [px], a high estimate for DejaVu Sans, the widest usual fallback font."""

_COLORS = {
    Ink.BLUE: "#0072b2",
    Ink.VERMILION: "#d55e00",
    Ink.GREEN: "#009e73",
    Ink.PURPLE: "#cc79a7",
    Ink.ORANGE: "#e69f00",
    Ink.SKY: "#56b4e9",
    Ink.PLAIN: "#30343a",
    Ink.FAINT: "#8a9099",
}

_SHAPE_STYLES = (
    ".chart{font-family:system-ui,'Helvetica Neue',Arial,sans-serif}"
    ".sheet{fill:#fff}.title{font-size:13px;font-weight:600;fill:#1a1d21}"
    ".tick,.note{font-size:11px;fill:#4a5058}.note{paint-order:stroke;stroke:#fff;stroke-width:3px}.axis{font-size:11.5px;fill:#30343a}"
    ".grid{stroke:#e3e6ea;fill:none}.line{fill:none;stroke-width:1.8;stroke-linejoin:round}"
    ".thin{stroke-width:1.1}.rule{fill:none;stroke-width:1.1}.dashed{stroke-dasharray:5 3}"
    ".area{fill-opacity:.14}.ring{fill:#fff;stroke-width:2}"
)

_STYLE_SHEET = _SHAPE_STYLES + "".join(
    f".{ink}{{stroke:{color}}}.fill-{ink}{{fill:{color}}}" for ink, color in _COLORS.items()
)
"""Style sheet of files, on white; pages have their own."""

_ROW_NAME_LENGTH = 26
"""Maximum number of letters of a row's name."""

_LEGEND_ROW, _SAMPLE_WIDTH, _ENTRY_GAP = 16.0, 20.0, 14.0
"""Height of a row of the legend, width of a sample, and gap between entries [px]."""

_LEGEND_LETTER_WIDTH = 6.0
"""Mean width of a letter of the legend [px]."""


_DISC_RADIUS, _LABEL_DISTANCE = 4.0, 7.0
"""Radius of a disc, and distance from its middle to its label [px]."""

_LABEL_SHIFTS = (0.0, -11.0, 11.0, -22.0, 22.0, -33.0, 33.0)
"""Vertical shifts by which a label avoids others, the smallest first [px]."""


class _Box(NamedTuple):
    """Bounding box of a label or a disc [px]."""

    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: "_Box") -> bool:
        """Whether they overlap."""
        overlap_in_x = self.left < other.right and other.left < self.right
        return overlap_in_x and self.top < other.bottom and other.top < self.bottom


def inline_svg(chart: Chart) -> str:
    """SVG element for a page; its colours are classes."""
    return _Drawing(chart).text("")


def svg_file(chart: Chart) -> bytes:
    """SVG file with its own style sheet, on white."""
    return _Drawing(chart).text(f"<style>{_STYLE_SHEET}</style>").encode()


class _Drawing:
    """Layout of one chart on its sheet, x to the right and y down."""

    def __init__(self, chart: Chart) -> None:
        self._named = _legend_marks(chart.marks)
        rows = {row for _, _, row in _legend_places(self._named, WIDTH - _RIGHT)}
        self._top = _TITLE + _LEGEND_ROW * len(rows) + 6.0
        longest = max(map(len, chart.rows), default=0)
        self._left = max(_LEFT, _LETTER_WIDTH * min(longest, _ROW_NAME_LENGTH) + 14.0)
        self._right, self._bottom = WIDTH - _RIGHT, chart.height - _BOTTOM
        if chart.equal:
            width, height = self._right - self._left, self._bottom - self._top
            spans = (chart.x.high - chart.x.low) / width, (chart.y.high - chart.y.low) / height
            scale = max(spans)
            chart = replace(
                chart, x=_with_span(chart.x, scale * width), y=_with_span(chart.y, scale * height)
            )
        self._chart = chart
        self._occupied = [
            _Box(x - _DISC_RADIUS, y - _DISC_RADIUS, x + _DISC_RADIUS, y + _DISC_RADIUS)
            for mark in chart.marks
            if isinstance(mark, Points)
            for x, y in self._pixels(mark.x, mark.y).tolist()
        ]
        self._curves: list[FloatArray] = []

    def text(self, style: str) -> str:
        """SVG text of the whole chart."""
        chart = self._chart
        legend = "".join(
            _legend_entry(mark, x, _TITLE + _LEGEND_ROW * row)
            for mark, x, row in _legend_places(self._named, self._right)
        )
        middle_x, middle_y = (self._left + self._right) / 2.0, (self._top + self._bottom) / 2.0
        titles = _text_element("axis", middle_x, chart.height - 8.0, chart.x.title, "middle")
        if not chart.rows:
            y_title = _text_element("axis", 0.0, 0.0, chart.y.title, "middle")
            titles += f'<g transform="translate(12 {middle_y:g}) rotate(-90)">{y_title}</g>'
        height = f"{chart.height:g}"
        frame = f'data-x="{chart.x.low:.6g} {chart.x.high:.6g} {self._left:g} {self._right:g}"'
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" class="chart" role="img" '
            f'viewBox="0 0 {WIDTH:g} {height}" '
            f'aria-labelledby="{chart.name}-t {chart.name}-d" {frame} '
            f'data-y="{self._top:g} {self._bottom:g}">'
            f'<title id="{chart.name}-t">{escape(chart.title)}</title>'
            f'<desc id="{chart.name}-d">{escape(chart.description)}</desc>{style}'
            f'<rect class="sheet" width="{WIDTH:g}" height="{height}"/>'
            f'<text class="title" x="4" y="14">{escape(chart.title)}</text>'
            f"{legend}{self._grid()}"
            f'<clipPath id="{chart.name}-c"><rect x="{self._left:g}" y="{self._top:g}" '
            f'width="{self._right - self._left:g}" '
            f'height="{self._bottom - self._top:g}"/></clipPath>'
            f'<g clip-path="url(#{chart.name}-c)">{"".join(map(self._shape_of, chart.marks))}</g>'
            # Labels lie on top of everything and may cross the frame.
            f"{''.join(map(self._label_of, chart.marks))}{titles}</svg>"
        )

    def _pixels(self, x: FloatArray | float, y: FloatArray | float) -> FloatArray:
        """Pixels of points, shape (n, 2), or of one."""
        x_fraction, y_fraction = self._chart.x.fractions(x), self._chart.y.fractions(y)
        pixels_x = self._left + x_fraction * (self._right - self._left)
        return np.stack([pixels_x, self._bottom - y_fraction * (self._bottom - self._top)], axis=-1)

    def _grid(self) -> str:
        chart, elements = self._chart, []
        for value in chart.x.ticks():
            x, _ = self._pixels(value, chart.y.low)
            elements.append(_line_element("grid", x, self._top, x, self._bottom))
            text = tick_text(value)
            elements.append(_text_element("tick", x, self._bottom + 14.0, text, "middle"))
        if chart.rows:
            most = _ROW_NAME_LENGTH
            names = (name if len(name) <= most else f"{name[: most - 1]}…" for name in chart.rows)
            ticks = [(float(row), name) for row, name in enumerate(names)]
        else:
            ticks = [(value, tick_text(value)) for value in chart.y.ticks(5)]
        for value, text in ticks:
            _, y = self._pixels(chart.x.low, value)
            elements.append(_line_element("grid", self._left, y, self._right, y))
            elements.append(_text_element("tick", self._left - 6.0, y + 3.5, text, "end"))
        return "".join(elements)

    def _shape_of(self, mark: Mark) -> str:
        classes = _css_classes(mark)
        match mark:
            case Curve():
                broken = np.isnan(mark.x) | np.isnan(mark.y)
                pieces = np.split(np.arange(len(mark.x)), np.flatnonzero(broken))
                unbroken = [piece[~broken[piece]] for piece in pieces]
                curves = [
                    self._pixels(*thinned(mark.x[piece], mark.y[piece]))
                    for piece in unbroken
                    if len(piece) > 1
                ]
                for curve in curves:
                    # Points along the curve at most a pixel apart in x and y, shape (n, 2).
                    steps = np.ceil(np.abs(np.diff(curve, axis=0)).max(axis=1)).astype(int).clip(1)
                    nodes = np.concatenate([[0], np.cumsum(steps)])
                    along = np.arange(nodes[-1] + 1)
                    trace = [np.interp(along, nodes, column) for column in curve.T]
                    self._curves.append(np.stack(trace, axis=-1))
                paths = "".join(map(_path_data, curves))
                return f'<path class="{classes}" d="{paths}"/>' if paths else ""
            case FilledArea():
                path = _path_data(self._pixels(mark.x, mark.y), closed=True)
                return f'<path class="{classes}" d="{path}"/>'
            case Points():
                return "".join(
                    _disc_element(classes, x, y) for x, y in self._pixels(mark.x, mark.y).tolist()
                )
            case Rule():
                return _line_element(classes, *self._rule(mark))

    def _label_of(self, mark: Mark) -> str:
        match mark:
            case Points(labels=labels) if labels:
                places = self._pixels(mark.x, mark.y)
                words = zip(places, labels, strict=True)
                return "".join(self._beside(x, y, text) for (x, y), text in words)
            case Rule(label=label, upright=True) if label:
                # At the bottom, top or in between, right or left of it, clear of curves.
                x, low, high = self._rule(mark)[0], self._bottom - 9.0, self._top + 9.0
                heights = [low, high, *np.arange(low, high, _LABEL_SHIFTS[1]).tolist()]
                free = (
                    (y, left)
                    for left, y in product((False, True), heights)
                    for box in [self._box(x, y, label, left=left)]
                    if self._is_free(box) and box.left >= self._left
                )
                y, left = next(free, (low, False))
                return self._beside(x, y, label, left=left)
        return ""

    def _beside(self, x: float, y: float, text: str, *, left: bool = False) -> str:
        """Label to the right of a point, or to the left if requested or if there is no room.

        It overlaps no other label, and no curve if possible.
        """
        boxes = [self._box(x, y + shift, text, left=left) for shift in _LABEL_SHIFTS]
        # The axis labels are below.
        inside = [box for box in boxes if box.bottom <= self._bottom] or boxes
        clear = [box for box in inside if not any(map(box.overlaps, self._occupied))]
        box = next(filter(self._is_free, clear), (clear or inside)[0])
        self._occupied.append(box)
        side, anchor = (-1.0, "end") if box.left < x else (1.0, "start")
        return _text_element("note", x + side * _LABEL_DISTANCE, box.top + 9.5, text, anchor)

    def _is_free(self, box: _Box) -> bool:
        """Whether a box is clear of labels, discs and curves, all of which are already drawn."""
        if any(map(box.overlaps, self._occupied)):
            return False
        corner, opposite = box[:2], box[2:]
        inside = (((curve >= corner) & (curve <= opposite)).all(axis=1) for curve in self._curves)
        return not any(map(np.any, inside))

    def _box(self, x: float, y: float, text: str, *, left: bool = False) -> _Box:
        """Box of a label beside a point; see `_beside`."""
        width, left_edge = _LETTER_WIDTH * len(text), x + _LABEL_DISTANCE
        if left or left_edge + width > WIDTH:
            left_edge = x - _LABEL_DISTANCE - width
        return _Box(left_edge, y - 6.0, left_edge + width, y + 5.0)

    def _rule(self, mark: Rule) -> tuple[float, float, float, float]:
        if mark.upright:
            x, _ = self._pixels(mark.value, self._chart.y.low)
            return x, self._top, x, self._bottom
        _, y = self._pixels(self._chart.x.low, mark.value)
        return self._left, y, self._right, y


def _legend_marks(marks: Sequence[Mark]) -> list[Mark]:
    """Marks for the legend: the first mark of each name."""
    first_by_name: dict[str, Mark] = {}
    for mark in marks:
        if mark.name:
            first_by_name.setdefault(mark.name, mark)
    return list(first_by_name.values())


def _legend_places(marks: Sequence[Mark], right: float) -> Iterator[tuple[Mark, float, int]]:
    """Each mark of the legend with its x [px] and its row."""
    x, row = 4.0, 0
    for mark in marks:
        width = _SAMPLE_WIDTH + 6.0 + _LEGEND_LETTER_WIDTH * len(mark.name) + _ENTRY_GAP
        if x > 4.0 and x + width > right:
            x, row = 4.0, row + 1
        yield mark, x, row
        x += width


def _legend_entry(mark: Mark, x: float, top: float) -> str:
    """Sample of a mark and its name."""
    name = f'x="{x + _SAMPLE_WIDTH + 5.0:.1f}" y="{top + 10.0:.1f}">{escape(mark.name)}'
    return f'{_sample(mark, x, top + 6.0)}<text class="note" {name}</text>'


def _sample(mark: Mark, x: float, y: float) -> str:
    """Sample of a mark for the legend."""
    classes = _css_classes(mark)
    if isinstance(mark, Points):
        return _disc_element(classes, x + _SAMPLE_WIDTH / 2.0, y)
    if isinstance(mark, FilledArea):
        box = f'x="{x:.1f}" y="{y - 5.0:.1f}" width="{_SAMPLE_WIDTH:g}" height="10"'
        return f'<rect class="{classes}" {box}/>'
    return f'<path class="{classes}" d="M{x:.1f} {y:.1f}h{_SAMPLE_WIDTH:g}"/>'


def _css_classes(mark: Mark) -> str:
    """Classes of a mark in the style sheet."""
    match mark:
        case Curve():
            return f"line {mark.ink}{' dashed' * mark.dashed}{' thin' * mark.thin}"
        case FilledArea():
            return f"area fill-{mark.ink}"
        case Points():
            return f"ring {mark.ink}" if mark.hollow else f"disc fill-{mark.ink}"
        case Rule():
            return f"rule dashed {mark.ink}"


def _with_span(axis: Axis, span: float) -> Axis:
    center = (axis.low + axis.high) / 2.0
    return replace(axis, low=center - span / 2.0, high=center + span / 2.0)


def _path_data(pixels: FloatArray, *, closed: bool = False) -> str:
    rounded = pixels.round(1)
    steps = np.diff(rounded, axis=0)
    # Points inside a horizontal section are dropped.
    same_direction = steps[1:, 0] * steps[:-1, 0] >= 0.0
    is_level = (steps[1:, 1] == 0.0) & (steps[:-1, 1] == 0.0)
    corners = rounded[np.concatenate([[True], ~(is_level & same_direction), [True]])]
    points = "L".join(f"{x:.1f} {y:.1f}" for x, y in corners.tolist())
    return f"M{points}{'Z' if closed else ''}"


def _line_element(classes: str, x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<path class="{classes}" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"/>'


def _disc_element(classes: str, x: float, y: float) -> str:
    return f'<circle class="{classes}" cx="{x:.1f}" cy="{y:.1f}" r="{_DISC_RADIUS:g}"/>'


def _text_element(classes: str, x: float, y: float, text: str, anchor: str) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text class="{classes}" {place}>{escape(text)}</text>'


_FONTS = tuple(f"report/fonts/Roboto-{weight}.ttf" for weight in ("Regular", "Bold"))
"""Bundled fonts: a machine may have none, and the pictures shall be the same everywhere."""

_FAMILY = "Roboto"

_ZOOM = 2
"""Pixels of the picture per pixel of the SVG."""


def write_svgs(charts: Sequence[Chart], folder: Path) -> None:
    """Write each chart as `<name>.svg`."""
    folder.mkdir(exist_ok=True)
    for chart in charts:
        (folder / f"{chart.name}.svg").write_bytes(svg_file(chart))


def write_charts(charts: Sequence[Chart], folder: Path) -> tuple[str, ...]:
    """Write each chart as SVG, and as PNG where resvg is installed; gives remarks."""
    write_svgs(charts, folder)
    try:
        for chart in charts:
            png = png_of(svg_file(chart).decode())
            (folder / f"{chart.name}.png").write_bytes(png)
    except MissingToolError as error:
        return (f"{error.message}: {error.hint}",)
    return ()


def png_of(svg: str) -> bytes:
    """PNG of an SVG, with twice as many pixels in width and height.

    Raises:
        MissingToolError: resvg is not installed.
    """
    try:
        # An optional dependency.
        from resvg_py import svg_to_bytes  # noqa: PLC0415
    except ImportError as error:
        raise MissingToolError(
            "figures are not written as PNG, because resvg-py is not installed",
            hint=extra_command("plot"),
        ) from error
    return bytes(
        svg_to_bytes(
            svg_string=svg,
            zoom=_ZOOM,
            font_files=[str(template_file(font)) for font in _FONTS],
            font_family=_FAMILY,
            sans_serif_family=_FAMILY,
            skip_system_fonts=True,
        )
    )
