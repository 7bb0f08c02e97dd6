"""Charts as files: SVG, and PNG for slides and documents that take no SVG."""

from collections.abc import Sequence
from pathlib import Path

from ocs_design.common.errors import MissingToolError, extra_command
from ocs_design.export.templates import template_file
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.svg import svg_file

_FONTS = tuple(f"report/fonts/Roboto-{weight}.ttf" for weight in ("Regular", "Bold"))
"""Our own fonts: a machine may have none, and pictures are the same everywhere."""

_FAMILY = "Roboto"

_ZOOM = 2
"""Pixels for each of the SVG's."""


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
            (folder / f"{chart.name}.png").write_bytes(png_file(chart))
    except MissingToolError as error:
        return (f"{error.message}: {error.hint}",)
    return ()


def png_file(chart: Chart) -> bytes:
    """The SVG file as a picture, twice as many pixels wide and high.

    Raises:
        MissingToolError: resvg is not installed.
    """
    try:
        # An extra.
        from resvg_py import svg_to_bytes  # noqa: PLC0415
    except ImportError as error:
        raise MissingToolError(
            "figures are not written as PNG, because resvg-py is not installed",
            hint=extra_command("plot"),
        ) from error
    return bytes(
        svg_to_bytes(
            svg_string=svg_file(chart).decode(),
            zoom=_ZOOM,
            font_files=[str(template_file(font)) for font in _FONTS],
            font_family=_FAMILY,
            sans_serif_family=_FAMILY,
            skip_system_fonts=True,
        )
    )
