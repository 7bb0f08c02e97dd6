"""Charts as SVG: inside a page, where the page's style sheet colours them, or as files."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from html import escape
from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.report.charts.chart import Chart, thinned
from ocs_design.report.charts.legend import Entry, legend, legend_height
from ocs_design.report.charts.marks import Area, Line, Mark, Points, Rule
from ocs_design.report.charts.scales import Axis, tick_text
from ocs_design.report.charts.style import SHEET

WIDTH = 440.0
"""Of every chart [px]: legible without zooming on a telephone."""

_LEFT, _RIGHT, _BOTTOM, _TITLE = 62.0, 22.0, 40.0, 22.0
_LETTER = 6.2
"""Mean width of a letter [px], generously."""

_MOST_ROW = 26

_DOT, _GAP = 4.0, 7.0
"""Radius of a disc, and from its middle to its word [px]."""

_RISES = (0.0, -11.0, 11.0, -22.0, 22.0, -33.0, 33.0)
"""By which a word gives way to others, the least first [px]."""


class _Box(NamedTuple):
    """What a word or a disc takes of the sheet [px]."""

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: "_Box") -> bool:
        """Whether they overlap."""
        across = self.left < other.right and other.left < self.right
        return across and self.top < other.bottom and other.top < self.bottom


def inline_svg(chart: Chart) -> str:
    """An element for a page; its colours are classes."""
    return _element(chart, "")


def svg_file(chart: Chart) -> bytes:
    """A file of its own, on white."""
    return _element(chart, f"<style>{SHEET}</style>").encode()


def _element(chart: Chart, style: str) -> str:
    return _Drawing(chart).text(style)


class _Drawing:
    """Places of one chart on its sheet, x to the right and y down."""

    def __init__(self, chart: Chart) -> None:
        self._entries = _entries(chart.marks)
        self._top = _TITLE + legend_height(self._entries, WIDTH - _RIGHT)
        longest = max(map(len, chart.rows), default=0)
        self._left = max(_LEFT, _LETTER * min(longest, _MOST_ROW) + 14.0)
        self._right, self._bottom = WIDTH - _RIGHT, chart.height - _BOTTOM
        if chart.equal:
            chart = self._equal(chart)
        self._chart = chart
        self._taken = [
            _Box(x - _DOT, y - _DOT, x + _DOT, y + _DOT)
            for mark in chart.marks
            if isinstance(mark, Points)
            for x, y in self._at(mark.x, mark.y).tolist()
        ]
        self._curves: list[FloatArray] = []

    def text(self, style: str) -> str:
        """The whole element."""
        chart = self._chart
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
            f"{legend(self._entries, self._right, _TITLE)}{self._grid()}"
            f'<clipPath id="{chart.name}-c"><rect x="{self._left:g}" y="{self._top:g}" '
            f'width="{self._right - self._left:g}" '
            f'height="{self._bottom - self._top:g}"/></clipPath>'
            f'<g clip-path="url(#{chart.name}-c)">{self._marks(labels=False)}</g>'
            f"{self._marks(labels=True)}{self._titles()}</svg>"
        )

    def _equal(self, chart: Chart) -> Chart:
        """Stretch the axis that would be too long for its values."""
        wide, tall = self._right - self._left, self._bottom - self._top
        spans = (chart.x.high - chart.x.low) / wide, (chart.y.high - chart.y.low) / tall
        scale = max(spans)
        return replace(
            chart, x=_stretched(chart.x, scale * wide), y=_stretched(chart.y, scale * tall)
        )

    def _at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Pixels of points, shape (n, 2)."""
        right, up = self._chart.x.parts(x), self._chart.y.parts(y)
        across = self._left + right * (self._right - self._left)
        return np.stack([across, self._bottom - up * (self._bottom - self._top)], axis=-1)

    def _grid(self) -> str:
        chart, parts = self._chart, []
        for value in chart.x.ticks():
            x = self._at(np.array([value]), np.array([chart.y.low]))[0, 0]
            parts.append(_straight("grid", x, self._top, x, self._bottom))
            parts.append(_word("tick", x, self._bottom + 14.0, tick_text(value), "middle"))
        for value, text in self._rows():
            y = self._at(np.array([chart.x.low]), np.array([value]))[0, 1]
            parts.append(_straight("grid", self._left, y, self._right, y))
            parts.append(_word("tick", self._left - 6.0, y + 3.5, text, "end"))
        return "".join(parts)

    def _rows(self) -> Iterable[tuple[float, str]]:
        if self._chart.rows:
            return [(float(place), _short(name)) for place, name in enumerate(self._chart.rows)]
        return [(value, tick_text(value)) for value in self._chart.y.ticks(5)]

    def _titles(self) -> str:
        chart = self._chart
        middle = (self._left + self._right) / 2.0
        below = _word("axis", middle, chart.height - 8.0, chart.x.title, "middle")
        if chart.rows:
            return below
        upright = (self._top + self._bottom) / 2.0
        beside = _word("axis", 0.0, 0.0, chart.y.title, "middle")
        return f'{below}<g transform="translate(12 {upright:g}) rotate(-90)">{beside}</g>'

    def _marks(self, *, labels: bool) -> str:
        """Words lie over everything, and may reach over the frame."""
        draw = self._label_of if labels else self._shape_of
        return "".join(draw(mark) for mark in self._chart.marks)

    def _shape_of(self, mark: Mark) -> str:
        match mark:
            case Line():
                return self._line(mark)
            case Area():
                path = _path(self._at(mark.x, mark.y), closed=True)
                return f'<path class="area fill-{mark.ink}" d="{path}"/>'
            case Points():
                return self._points(mark)
            case Rule():
                x1, y1, x2, y2 = self._rule(mark)
                return _straight(f"rule dashed {mark.ink}", x1, y1, x2, y2)

    def _label_of(self, mark: Mark) -> str:
        match mark:
            case Points(labels=labels) if labels:
                places = self._at(mark.x, mark.y)
                words = zip(places, labels, strict=True)
                return "".join(self._beside(x, y, text) for (x, y), text in words)
            case Rule(label=label, upright=True) if label:
                return self._along(self._rule(mark)[0], label)
        return ""

    def _along(self, x: float, text: str) -> str:
        """Beside an upright rule: below, above or in between, where no curve is in the way."""
        low, high = self._bottom - 9.0, self._top + 9.0
        heights = [low, high, *np.arange(low, high, _RISES[1]).tolist()]
        places = ((y, self._box(x, y, text)) for y in heights)
        free = (y for y, box in places if not any(map(box.meets, self._taken + self._met(box))))
        return self._beside(x, next(free, low), text)

    def _met(self, box: _Box) -> list[_Box]:
        """What the curves, which are drawn by now, take between the ends of a box."""
        parts = [
            curve[(curve[:, 0] >= box.left) & (curve[:, 0] <= box.right), 1]
            for curve in self._curves
        ]
        return [
            _Box(box.left, float(part.min()), box.right, float(part.max()))
            for part in parts
            if part.size
        ]

    def _beside(self, x: float, y: float, text: str) -> str:
        """To the right of a place, or to its left where there is no room, clear of all others."""
        tried = [self._box(x, y + rise, text) for rise in _RISES]
        box = next((each for each in tried if not any(map(each.meets, self._taken))), tried[0])
        self._taken.append(box)
        far, anchor = (x - _GAP, "end") if box.left < x else (x + _GAP, "start")
        return _word("note", far, box.top + 9.5, text, anchor)

    def _box(self, x: float, y: float, text: str) -> _Box:
        """What a word beside a place takes."""
        reach = _LETTER * len(text)
        near = x - _GAP - reach if x + _GAP + reach > WIDTH else x + _GAP
        return _Box(near, y - 6.0, near + reach, y + 5.0)

    def _line(self, mark: Line) -> str:
        look = f"line {mark.ink}{_dashes(mark.dashed)}" + (" thin" if mark.thin else "")
        broken = np.isnan(mark.x) | np.isnan(mark.y)
        pieces = np.split(np.arange(len(mark.x)), np.flatnonzero(broken))
        wholes = (piece[~broken[piece]] for piece in pieces)
        curves = [
            self._at(*thinned(mark.x[whole], mark.y[whole])) for whole in wholes if len(whole) > 1
        ]
        self._curves += curves
        paths = "".join(map(_path, curves))
        return f'<path class="{look}" d="{paths}"/>' if paths else ""

    def _points(self, mark: Points) -> str:
        look = f"ring {mark.ink}" if mark.hollow else f"disc fill-{mark.ink}"
        discs = (
            f'<circle class="{look}" cx="{x:.1f}" cy="{y:.1f}" r="{_DOT:g}"/>'
            for x, y in self._at(mark.x, mark.y)
        )
        return "".join(discs)

    def _rule(self, mark: Rule) -> tuple[float, float, float, float]:
        value = np.array([mark.value])
        if mark.upright:
            x = self._at(value, np.array([self._chart.y.low]))[0, 0]
            return x, self._top, x, self._bottom
        y = self._at(np.array([self._chart.x.low]), value)[0, 1]
        return self._left, y, self._right, y


def _entries(marks: Sequence[Mark]) -> list[Entry]:
    """What has a name, once."""
    found: dict[str, Entry] = {}
    for mark in marks:
        name = getattr(mark, "name", "")
        if name and name not in found:
            found[name] = Entry(name, mark)
    return list(found.values())


def _stretched(axis: Axis, span: float) -> Axis:
    middle = (axis.low + axis.high) / 2.0
    return replace(axis, low=middle - span / 2.0, high=middle + span / 2.0)


def _path(places: FloatArray, *, closed: bool = False) -> str:
    steps = "L".join(f"{x:.1f} {y:.1f}" for x, y in _bent(places.round(1)).tolist())
    return f"M{steps}{'Z' if closed else ''}"


def _bent(places: FloatArray) -> FloatArray:
    """Without those in the middle of a level stretch, which say nothing."""
    steps = np.diff(places, axis=0)
    onwards = steps[1:, 0] * steps[:-1, 0] >= 0.0
    level = (steps[1:, 1] == 0.0) & (steps[:-1, 1] == 0.0)
    kept: FloatArray = places[np.concatenate([[True], ~(level & onwards), [True]])]
    return kept


def _straight(look: str, x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<path class="{look}" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"/>'


def _word(look: str, x: float, y: float, text: str, anchor: str) -> str:
    return (
        f'<text class="{look}" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'
    )


def _dashes(dashed: bool) -> str:
    return " dashed" if dashed else ""


def _short(name: str) -> str:
    return name if len(name) <= _MOST_ROW else name[: _MOST_ROW - 1] + "…"
