"""The bound, the angles and the drive: what the design rests on, in figures."""

from collections.abc import Iterator

from ocs_design.report.bound import NOTE
from ocs_design.report.coupling import coupling_notes
from ocs_design.report.doubts import doubts
from ocs_design.report.figures.bound import bound_charts
from ocs_design.report.figures.figures import drive_charts, incidence_charts, plane_charts
from ocs_design.report.html.elements import Markup, details, element, items, section, table
from ocs_design.report.html.figure import figures
from ocs_design.report.selection import (
    RANKED,
    TASKS,
    best_drives,
    ranked_cells,
    task_cells,
)
from ocs_design.report.story import Story
from ocs_design.selection_record import SelectionRecord


def bound_section(story: Story) -> Markup:
    """The paper's lower bound and where the design lies."""
    return section(
        "bound",
        "The lower bound, and where the design lies",
        figures(bound_charts(story)),
        element("p", NOTE, class_="note"),
    )


def angles_section(story: Story) -> Markup:
    """Incidence against criterion and posture, ellipsoid and momenta."""
    return section(
        "angles",
        "Incidence of the wheel axes",
        figures(plane_charts(story)),
        figures(incidence_charts(story)),
        items(doubts(story.design), look="warnings"),
        items(coupling_notes(story.design)),
    )


def drive_section(story: Story) -> Markup:
    """The torque-speed plane, and how the drive was chosen."""
    selection = story.design.selection
    chosen = () if selection is None else _choice(selection)
    return section("drive", "Drive", figures(drive_charts(story)), *chosen)


def _choice(selection: SelectionRecord) -> Iterator[Markup]:
    yield element(
        "p",
        f"Chosen from {selection.candidates:,} combinations of motor, gear, material and "
        f"incidence at {selection.bus_voltage:g} V; {selection.binding_maneuver} asks for most.",
    )
    needed = f"Asked for at the least, with {selection.reserve:.0%} of voltage and current"
    yield table(needed, _words(TASKS), map(task_cells, selection.tasks))
    drives = best_drives(selection.ranking)
    columns = ("motor, gear", *_words(RANKED)[1:])
    yield table("The lightest drives", columns, map(ranked_cells, drives), words=(0, 2))
    if selection.co_design is not None:
        yield element("p", selection.co_design.remark)
    reasons = (f"{each.motor}: {each.detail}" for each in selection.rejections)
    if selection.rejections:
        yield details(f"{len(selection.rejections)} motors that fell out, and why", items(reasons))


def _words(columns: tuple[str, ...]) -> tuple[str, ...]:
    """Headings of the terminal in one line: a unit in brackets."""
    parts = (name.partition("\n") for name in columns)
    return tuple(f"{name} [{unit}]" if unit else name for name, _, unit in parts)
