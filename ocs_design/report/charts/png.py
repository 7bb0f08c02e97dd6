"""Charts as PNG, for slides and documents that take no SVG: drawn by matplotlib, an extra."""

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.exceptions import MissingToolError
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.marks import Area, Line, Mark, Points, Rule
from ocs_design.report.charts.style import COLORS
from ocs_design.report.charts.svg import WIDTH

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PIXELS_PER_INCH = 72.0
_DPI = 144.0
"""Two pixels for each of the SVG's."""

_STYLE = {
    "font.size": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e3e6ea",
    # A dollar in a robot's name is a dollar.
    "text.parse_math": False,
}


def png_chart(chart: Chart) -> bytes:
    """The same marks on the same axes as in the SVG.

    Raises:
        MissingToolError: matplotlib is not installed.
    """
    with _sheet(chart.height) as figure:
        axes = figure.subplots()
        _prepare(axes, chart)
        for mark in chart.marks:
            _draw(axes, mark)
        if axes.get_legend_handles_labels()[1]:
            axes.legend(fontsize=7.0, frameon=False, loc="best")
        buffer = BytesIO()
        figure.savefig(buffer, format="png")
    return buffer.getvalue()


@contextmanager
def _sheet(height: float) -> Iterator["Figure"]:
    """That high [px], in a style of our own while it is drawn and saved."""
    try:
        # It takes a second to import.
        from matplotlib import style as styles  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise MissingToolError(
            "figures are not drawn as PNG, for matplotlib is not installed",
            hint="pip install 'ocs-design[plot]'",
        ) from error
    size = WIDTH / _PIXELS_PER_INCH, height / _PIXELS_PER_INCH
    # Not from a file that the user may have.
    with styles.context(["default", _STYLE]):
        yield Figure(figsize=size, dpi=_DPI, layout="constrained")


def _prepare(axes: "Axes", chart: Chart) -> None:
    axes.set_title(chart.title, loc="left", fontsize=9.0, fontweight="bold")
    axes.set_xlabel(chart.x.title)
    if chart.x.log:
        axes.set_xscale("log")
    if chart.y.log:
        axes.set_yscale("log")
    axes.set_xlim(chart.x.low, chart.x.high)
    axes.set_ylim(chart.y.low, chart.y.high)
    if chart.equal:
        axes.set_aspect("equal", adjustable="box")
    if chart.rows:
        axes.set_yticks(np.arange(len(chart.rows)), chart.rows)
    else:
        axes.set_ylabel(chart.y.title)


def _draw(axes: "Axes", mark: Mark) -> None:
    color = COLORS[mark.ink]
    match mark:
        case Line():
            look = "--" if mark.dashed else "-"
            axes.plot(
                mark.x, mark.y, look, color=color, linewidth=0.9 if mark.thin else 1.3,
                label=mark.name or None,
            )  # fmt: skip
        case Area():
            axes.fill(
                mark.x, mark.y, color=color, alpha=0.14, linewidth=0.0, label=mark.name or None
            )
        case Points():
            face = "white" if mark.hollow else color
            # Over the lines, which matplotlib else draws last.
            axes.scatter(
                mark.x, mark.y, 16.0, face, edgecolors=color, label=mark.name or None, zorder=3.0
            )
            for x, y, text in zip(mark.x, mark.y, mark.labels, strict=False):
                axes.annotate(text, (x, y), (5.0, -2.0), textcoords="offset points", fontsize=7.0)
        case Rule():
            _draw_rule(axes, mark)


def _draw_rule(axes: "Axes", rule: Rule) -> None:
    across = axes.axvline if rule.upright else axes.axhline
    across(
        rule.value, color=COLORS[rule.ink], linewidth=0.8, linestyle="--", zorder=0,
        label=rule.name or None,
    )  # fmt: skip
    if rule.label and rule.upright:
        axes.annotate(
            rule.label, (rule.value, 0.02), (3.0, 0.0), xycoords=axes.get_xaxis_transform(),
            textcoords="offset points", fontsize=7.0,
        )  # fmt: skip
