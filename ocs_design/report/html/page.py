"""The whole page: one file without network, which a browser shows and prints."""

import base64
import hashlib
from collections.abc import Iterator
from pathlib import Path

from ocs_design.design_file import design_to_json
from ocs_design.export.folder import REPORT_FILE
from ocs_design.export.templates import template_text
from ocs_design.report.html.angles import angles_section, bound_section, drive_section
from ocs_design.report.html.elements import Markup, data, element, joined
from ocs_design.report.html.head import page_head, title_of
from ocs_design.report.html.maneuvers import maneuvers_section
from ocs_design.report.html.monte_carlo import monte_carlo_section
from ocs_design.report.html.record import record_section
from ocs_design.report.html.robot import robot_section
from ocs_design.report.html.sizes import limits_section, sizes_section
from ocs_design.report.html.view import view, view_data
from ocs_design.report.story import Story
from ocs_design.report.viewer.decimation import decimated

MOST_TRIANGLES = 30_000
"""Of the robot in the page: a few hundred kilobytes, and fluent without a graphics card."""

_PARTS = {
    "robot": "Robot and device",
    "sizes": "Sizes and margins",
    "limits": "What binds",
    "bound": "Lower bound",
    "angles": "Incidence",
    "drive": "Drive",
    "maneuvers": "Maneuvers",
    "samples": "Monte Carlo",
    "record": "Provenance",
}
"""The contents: sections and their short names."""


def write_report(story: Story, folder: Path) -> Path:
    """Write `report.html`."""
    path = folder / REPORT_FILE
    path.write_text(report_page(story), encoding="utf-8")
    return path


def report_page(story: Story) -> str:
    """The page as text."""
    style = template_text("report/report.css")
    script = "\n".join(template_text(f"report/{name}.js") for name in ("viewer", "report"))
    head = (
        Markup('<meta charset="utf-8">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<meta name="color-scheme" content="light dark">'),
        _policy(style, script),
        element("title", title_of(story.design)),
        element("style", Markup(style)),
    )
    body = joined((*_body(story), element("script", Markup(script))))
    page = element("html", element("head", *head), element("body", body), lang="en")
    return f"<!DOCTYPE html>\n{page}\n"


def _body(story: Story) -> Iterator[Markup]:
    scenarios = tuple(dict.fromkeys(each.scenario for each in story.flights if each.poses))
    bodies = decimated(story.bodies, MOST_TRIANGLES)
    links = (
        element("a", name, href=f"#{part}")
        for part, name in _PARTS.items()
        if part != "samples" or story.monte_carlo is not None
    )
    yield element("a", "Skip to the content", href="#robot", class_="skip")
    yield page_head(story.design)
    yield element("nav", *links, aria_label="Contents")
    yield element(
        "main",
        robot_section(story, view(story, bodies, scenarios)),
        sizes_section(story.design),
        limits_section(story.design),
        bound_section(story),
        angles_section(story),
        drive_section(story),
        maneuvers_section(story, scenarios),
        monte_carlo_section(story.monte_carlo),
        record_section(story),
    )
    yield data("design", design_to_json(story.design).decode())
    yield view_data(story, bodies, scenarios)


def _policy(style: str, script: str) -> Markup:
    """Nothing is fetched, and nothing runs but what is here by its hash: no name of a robot can."""
    allowed = {"style-src": style, "script-src": script}
    rules = [f"{kind} 'sha256-{_digest(text)}'" for kind, text in allowed.items()]
    content = "; ".join(["default-src 'none'", "img-src data:", *rules])
    return Markup(f'<meta http-equiv="Content-Security-Policy" content="{content}">')


def _digest(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
