"""Charts as files."""

from collections.abc import Sequence
from pathlib import Path

from ocs_design.exceptions import MissingToolError
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.png import png_chart
from ocs_design.report.charts.svg import svg_file


def write_svgs(charts: Sequence[Chart], folder: Path) -> None:
    """Each as `<name>.svg`."""
    folder.mkdir(exist_ok=True)
    for chart in charts:
        (folder / f"{chart.name}.svg").write_bytes(svg_file(chart))


def write_charts(charts: Sequence[Chart], folder: Path) -> tuple[str, ...]:
    """Each as SVG, and as PNG where matplotlib is installed; gives what is to be told."""
    write_svgs(charts, folder)
    try:
        for chart in charts:
            (folder / f"{chart.name}.png").write_bytes(png_chart(chart))
    except MissingToolError as error:
        return (f"{error.message}: {error.hint}",)
    return ()
