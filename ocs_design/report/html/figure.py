"""Charts and pictures on the page."""

import base64
from collections.abc import Iterable

from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.svg import inline_svg
from ocs_design.report.html.elements import Markup, element, void


def figures(charts: Iterable[Chart], *, flight: str = "") -> Markup:
    """Beside each other where there is room.

    Args:
        charts: to show.
        flight: number of the maneuver that they are of; empty: of none.
    """
    shown = (element("figure", Markup(inline_svg(chart))) for chart in charts)
    return element("div", *shown, class_="charts", data_flight=flight)


def picture(png: bytes, alternative: str, *, width: int, height: int) -> Markup:
    """An image inside the page."""
    source = f"data:image/png;base64,{base64.b64encode(png).decode('ascii')}"
    return void("img", src=source, alt=alternative, width=str(width), height=str(height))
