"""Figures and report of a design again, from its files."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from ocs_design.export.folder import recorded_hashes
from ocs_design.exporting import Order
from ocs_design.report.charts.files import write_charts
from ocs_design.report.figures.figures import FOLDER, all_charts
from ocs_design.report.html.page import write_report
from ocs_design.report.on_request import FIGURES, REPORT
from ocs_design.report.story import story_in


def write_wanted(
    wanted: Collection[str], order: Order, folder: Path, command: str
) -> tuple[str, ...]:
    """Write figures, report or both of an order; gives what is to be told of them.

    Args:
        wanted: names of `on_request`.
        order: that was read.
        folder: to write into; where it lacks a file, the design's own folder is asked for it.
        command: that was typed.
    """
    story = story_in([folder, order.path.parent], order.design, command=command)
    remarks: tuple[str, ...] = ()
    if FIGURES in wanted:
        remarks = write_charts(tuple(all_charts(story)), folder / FOLDER)
    if REPORT in wanted:
        whole = replace(order.design, files=recorded_hashes(folder))
        write_report(replace(story, design=whole), folder)
    return remarks
