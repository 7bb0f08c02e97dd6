"""What the colours of a chart mean, in rows above it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from ocs_design.report.charts.marks import Area, Line, Mark, Points, Rule

ROW = 16.0
_SAMPLE, _GAP, _LETTER = 20.0, 14.0, 6.0
"""Widths [px]: of a sample, from one entry to the next, and of a letter in the mean."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A name, and the mark that it stands for."""

    name: str
    mark: Mark

    @property
    def width(self) -> float:
        """With its sample [px]."""
        return _SAMPLE + 6.0 + _LETTER * len(self.name) + _GAP


def legend_height(entries: Sequence[Entry], right: float) -> float:
    """Of all rows [px]."""
    rows = {row for _, _, row in _places(entries, right)}
    return ROW * len(rows) + 6.0


def legend(entries: Sequence[Entry], right: float, top: float) -> str:
    """Samples and names as SVG, from `top` down, as far as `right`."""
    return "".join(
        f"{_sample(entry.mark, x, top + ROW * row + 6.0)}"
        f'<text class="note" x="{x + _SAMPLE + 5.0:.1f}" y="{top + ROW * row + 10.0:.1f}">'
        f"{escape(entry.name)}</text>"
        for entry, x, row in _places(entries, right)
    )


def _places(entries: Sequence[Entry], right: float) -> Iterator[tuple[Entry, float, int]]:
    x, row = 4.0, 0
    for entry in entries:
        if x > 4.0 and x + entry.width > right:
            x, row = 4.0, row + 1
        yield entry, x, row
        x += entry.width


def _sample(mark: Mark, x: float, y: float) -> str:
    match mark:
        case Line():
            dashes = " dashed" if mark.dashed else ""
            return f'<path class="line {mark.ink}{dashes}" d="M{x:.1f} {y:.1f}h{_SAMPLE:g}"/>'
        case Points():
            look = f"ring {mark.ink}" if mark.hollow else f"disc fill-{mark.ink}"
            return f'<circle class="{look}" cx="{x + _SAMPLE / 2.0:.1f}" cy="{y:.1f}" r="4"/>'
        case Area():
            box = f'x="{x:.1f}" y="{y - 5.0:.1f}" width="{_SAMPLE:g}" height="10"'
            return f'<rect class="area fill-{mark.ink}" {box}/>'
        case Rule():
            return f'<path class="rule dashed {mark.ink}" d="M{x:.1f} {y:.1f}h{_SAMPLE:g}"/>'
