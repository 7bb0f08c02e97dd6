"""Results in notebooks: a few lines of HTML with a picture, without external resources."""

import base64
from pathlib import Path

from ocs_design.common.files import safe_name
from ocs_design.common.units import format_quantity
from ocs_design.common.wording import grams
from ocs_design.device.answers import Front, Validated
from ocs_design.device.records.design import OcsDesign
from ocs_design.export.raster import png_bytes
from ocs_design.report.bodies import read_bodies, still_picture
from ocs_design.report.charts.front import front_chart
from ocs_design.report.charts.momentum import ellipsoid_chart
from ocs_design.report.charts.svg import svg_file
from ocs_design.report.device import device_title, first_facts, share_of_robot
from ocs_design.report.flights import flights_title, verdict_table
from ocs_design.report.html.elements import Markup, element, items, table, void
from ocs_design.report.monte_carlo import campaign_title, certificate_line, success_table
from ocs_design.report.table import CellTable, columns
from ocs_design.report.verdict import Headline, headline

_WIDTH = "420"
"""Width of a picture [px]."""


def as_html(found: OcsDesign | Front | Validated, folder: Path | None = None) -> str:
    """Result as HTML without style sheets, scripts or external resources.

    A design with its folder shows a picture of the robot, else wheel axes and inertia.
    """
    if isinstance(found, OcsDesign):
        runs = verdict_table(found)
        mass = f"{grams(found.ocs.mass_total)}, {share_of_robot(found)}"
        title = f"{device_title(found)} for {found.robot.name}, {mass}"
        glb = None if folder is None else folder / f"robot/{safe_name(found.robot.name)}_ocs.glb"
        if glb is None or not glb.is_file():
            shown = _image("svg+xml", svg_file(ellipsoid_chart(found)), "wheel axes and inertia")
        else:
            picture = png_bytes(still_picture(read_bodies(glb.read_bytes())))
            shown = _image("png", picture, f"{found.robot.name} with its device")
        return element(
            "div",
            _head(title, headline(found)),
            element(
                "div",
                shown,
                table("Device", CellTable(columns("<", "<"), first_facts(found))),
                style="display: flex; gap: 1em; align-items: center",
            ),
            table(f"Flights: {flights_title(found.validation)}", runs) if runs.rows else Markup(""),
        )
    if isinstance(found, Front):
        chart = front_chart(found)
        rows = tuple(
            (format_quantity(point.value, found.unit), "-", point.reason)
            if point.device is None
            else (
                format_quantity(point.value, found.unit),
                grams(point.device.mass),
                f"{point.device.motor}, {point.device.gear}, {point.device.material}",
            )
            for point in found.points
        )
        return element(
            "div",
            _image("svg+xml", svg_file(chart), chart.title),
            table("Lightest devices", CellTable(columns(found.label, "mass", "<drive"), rows)),
        )
    parts, flown = [_head(found.robot, headline(found))], found.monte_carlo
    if flown is not None:
        parts.append(table(campaign_title(flown), success_table(flown)))
        if flown.certificate is not None:
            parts.append(element("p", certificate_line(flown.certificate)))
    reasons = (f"{run.scenario}: {run.reason}" for run in found.validation if run.ocs)
    return element("div", *parts, items(reasons))


def _image(kind: str, content: bytes, name: str) -> Markup:
    source = f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"
    return void("img", src=source, alt=name, width=_WIDTH, style="background: white")


def _head(title: str, line: Headline) -> Markup:
    main_finding = (void("br"), line.main_finding) if line.main_finding else ()
    return element("p", element("strong", title), void("br"), line.text, *main_finding)
