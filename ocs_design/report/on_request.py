"""What `export` writes of a design and its flights, when it is asked for."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from ocs_design.exceptions import MissingToolError
from ocs_design.export.folder import recorded_hashes
from ocs_design.export.formats import ALL
from ocs_design.exporting import Finish, Order
from ocs_design.report.charts.png import png_chart
from ocs_design.report.figures.figures import FOLDER, all_charts, write_figures
from ocs_design.report.html.page import write_report
from ocs_design.report.story import Story, story_in

FIGURES, REPORT = "figures", "report"

ON_DESIGN = (FIGURES, REPORT)
"""Names beside those of the formats of a device."""


def finishing(names: Collection[str], command: str) -> Finish | None:
    """What writes them; None where none of them is among the names.

    Args:
        names: as users say them.
        command: that was typed.
    """
    wanted = [name for name in ON_DESIGN if name in names or ALL in names]

    def finish(order: Order, folder: Path) -> tuple[str, ...]:
        """See `Finish`."""
        story = story_in([folder, order.path.parent], order.design, command=command)
        remarks = _write_figures(story, folder) if FIGURES in wanted else ()
        if REPORT in wanted:
            whole = replace(order.design, files=recorded_hashes(folder))
            write_report(replace(story, design=whole), folder)
        return remarks

    return finish if wanted else None


def _write_figures(story: Story, folder: Path) -> tuple[str, ...]:
    """As SVG, and as PNG where matplotlib is installed."""
    charts = tuple(all_charts(story))
    write_figures(charts, folder / FOLDER)
    try:
        for chart in charts:
            (folder / FOLDER / f"{chart.name}.png").write_bytes(png_chart(chart))
    except MissingToolError as error:
        return (f"{error.message}: {error.hint}",)
    return ()
