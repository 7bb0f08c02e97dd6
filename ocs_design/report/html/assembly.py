"""Section of the page that says how the device is built, as `assembly.pdf` does."""

from dataclasses import fields

import numpy as np

from ocs_design.device.device import Device, Module
from ocs_design.device.records import OcsDesign
from ocs_design.export.assembly.booklet import exploded_svg, section_svg
from ocs_design.export.assembly.content import Assembly, Chapter
from ocs_design.report.html.elements import Markup, element, items, joined, section, table
from ocs_design.report.story import Story
from ocs_design.report.table import Table, columns


def assembly_section(story: Story) -> Markup:
    """Pictures, pieces, screws and all instructions."""
    assembly = story.assembly or _recorded(story.design)
    rows = list(assembly.piece_rows())
    pieces = tuple(
        (str(row.number), str(row.quantity), row.name, row.made, row.file) for row in rows
    )
    screws = tuple(row.cells for row in assembly.screw_rows())
    held = (
        "No.",
        "quantity",
        "<screw",
        "<what it holds",
        "<thread that holds",
        "<torque",
        "<set by",
    )
    return section(
        "assembly",
        "Assembly: how to build, balance, test and wire it",
        element("figure", Markup(exploded_svg(assembly)), class_="sheet"),
        table(
            "Pieces of the whole device, by their numbers",
            Table(columns("No.", "quantity", "<piece", "<made", "<file in cad/"), pieces),
        ),
        element("figure", Markup(section_svg(assembly)), class_="sheet"),
        table("Screws", Table(columns(*held), screws)) if screws else "",
        joined(_chapter(chapter) for chapter in assembly.chapters()),
        element("p", "The same stands on paper in ", element("code", "cad/assembly.pdf"), "."),
    )


def _chapter(chapter: Chapter) -> Markup:
    head = element("h3", chapter.title)
    if not chapter.numbered:
        return joined((head, items(chapter.texts)))
    return joined((head, element("ol", *(element("li", text) for text in chapter.texts))))


def _recorded(design: OcsDesign) -> Assembly:
    """Assembly of the recorded device, whose record has the names of its own fields."""
    ocs = design.ocs
    modules = (
        Module(each.name, np.array(each.axis), np.array(each.position)) for each in ocs.modules
    )
    names = {each.name for each in fields(Device)} - {"modules", "supply", "layout"}
    same = {name: getattr(ocs, name) for name in names if hasattr(ocs, name)}
    device = Device(modules=tuple(modules), supply=design.supply, layout=ocs.axes, **same)
    return Assembly(design.robot.name, device, design.margins, ocs.fitting)
