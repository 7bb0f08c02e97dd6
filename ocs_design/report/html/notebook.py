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


def as_html(result: OcsDesign | Front | Validated, folder: Path | None = None) -> str:
    """Result as HTML without style sheets, scripts or external resources.

    A design with its folder shows a picture of the robot, else wheel axes and inertia.
    """
    if isinstance(result, OcsDesign):
        verdicts = verdict_table(result)
        mass = f"{grams(result.ocs.mass_total)}, {share_of_robot(result)}"
        title = f"{device_title(result)} for {result.robot.name}, {mass}"
        glb = None if folder is None else folder / f"robot/{safe_name(result.robot.name)}_ocs.glb"
        if glb is None or not glb.is_file():
            picture = _image("svg+xml", svg_file(ellipsoid_chart(result)), "wheel axes and inertia")
        else:
            png = png_bytes(still_picture(read_bodies(glb.read_bytes())))
            picture = _image("png", png, f"{result.robot.name} with its device")
        return element(
            "div",
            _title_paragraph(title, headline(result)),
            element(
                "div",
                picture,
                table("Device", CellTable(columns("<", "<"), first_facts(result))),
                style="display: flex; gap: 1em; align-items: center",
            ),
            table(f"Flights: {flights_title(result.validation)}", verdicts)
            if verdicts.rows
            else "",
        )
    if isinstance(result, Front):
        chart = front_chart(result)
        rows = []
        for point in result.points:
            mass, drive, device = "-", point.reason, point.device
            if device is not None:
                mass = grams(device.mass)
                drive = f"{device.motor}, {device.gear}, {device.material}"
            rows.append((format_quantity(point.value, result.unit), mass, drive))
        devices = CellTable(columns(result.label, "mass", "<drive"), tuple(rows))
        picture = _image("svg+xml", svg_file(chart), chart.title)
        return element("div", picture, table("Lightest devices", devices))
    parts, campaign = [_title_paragraph(result.robot, headline(result))], result.monte_carlo
    if campaign is not None:
        parts.append(table(campaign_title(campaign), success_table(campaign)))
        if campaign.certificate is not None:
            parts.append(element("p", certificate_line(campaign.certificate)))
    reasons = (f"{run.scenario}: {run.reason}" for run in result.validation if run.ocs)
    return element("div", *parts, items(reasons))


def _image(kind: str, content: bytes, name: str) -> Markup:
    source = f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"
    return void("img", src=source, alt=name, width=_WIDTH, style="background: white")


def _title_paragraph(title: str, line: Headline) -> Markup:
    main_finding = (void("br"), line.main_finding) if line.main_finding else ()
    return element("p", element("strong", title), void("br"), line.text, *main_finding)
