"""The report page: one self-contained file that a browser shows and prints offline."""

import base64
import hashlib
from collections.abc import Iterator
from pathlib import Path

from ocs_design.actuation.motor import DIRECT
from ocs_design.common.files import to_json
from ocs_design.common.units import rpm
from ocs_design.common.wording import degrees, grams, inertia, tenths
from ocs_design.device.layout import PAIR
from ocs_design.device.records.design import OcsDesign
from ocs_design.export.folder import REPORT_FILE
from ocs_design.export.templates import template_text
from ocs_design.report.charts.figures import scenario_charts
from ocs_design.report.device import has_motor, layout_text, share_of_robot
from ocs_design.report.flights import hand_turn_remarks
from ocs_design.report.html import sections
from ocs_design.report.html.decimation import decimated
from ocs_design.report.html.elements import Markup, element, joined, json_element
from ocs_design.report.html.view import view, view_data
from ocs_design.report.story import Story
from ocs_design.report.verdict import headline
from ocs_design.sizing.margins import HOOP_STRESS

MOST_TRIANGLES = 30_000
"""Triangles of the robot: a few hundred kilobytes, and smooth without a graphics card."""


def write_report(story: Story, folder: Path) -> Path:
    """Write `report.html`."""
    path = folder / REPORT_FILE
    path.write_text(report_page(story), encoding="utf-8")
    return path


def report_page(story: Story) -> str:
    """Text of the whole page."""
    style = template_text("report/report.css")
    script = "\n".join(template_text(f"report/{name}.js") for name in ("viewer", "report"))
    # Nothing is fetched, and only the scripts and styles with these hashes are allowed.
    policy = ["default-src 'none'", "img-src data:"]
    for kind, text in (("style-src", style), ("script-src", script)):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
        policy.append(f"{kind} 'sha256-{digest}'")
    content = "; ".join(policy)
    head = (
        Markup('<meta charset="utf-8">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<meta name="color-scheme" content="light dark">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{content}">'),
        element("title", title_of(story.design)),
        element("style", Markup(style)),
    )
    body = joined((*_body(story), element("script", Markup(script))))
    page = element("html", element("head", *head), element("body", body), lang="en")
    return f"<!DOCTYPE html>\n{page}\n"


def title_of(design: OcsDesign) -> str:
    """Title of the page."""
    return f"Orientation control system for {design.robot.name}"


def _body(story: Story) -> Iterator[Markup]:
    design = story.design
    scenarios = tuple(
        dict.fromkeys(flight.record.scenario for flight in story.flights if flight.poses)
    )
    bodies = decimated(story.bodies, MOST_TRIANGLES)
    shown = view(story, bodies, scenarios)
    # Short name and content of each section, by its anchor.
    contents = {
        "robot": ("Robot and device", sections.robot_section(story, shown)),
        "sizes": ("Sizes and margins", sections.sizes_section(design)),
        "limits": ("Active limits", sections.limits_section(story)),
        "bound": ("Lower bound", sections.bound_section(story)),
        "angles": ("Incidence", sections.angles_section(story)),
        "drive": ("Drive", sections.drive_section(story)),
        "maneuvers": (
            "Maneuvers",
            sections.maneuvers_section(story, dict(scenario_charts(story)), scenarios),
        ),
        "samples": ("Monte Carlo", sections.monte_carlo_section(story)),
        "assembly": ("Assembly", sections.assembly_section(story)),
        "record": ("Provenance", sections.record_section(story)),
    }
    links = (
        element("a", name, href=f"#{anchor}")
        for anchor, (name, content) in contents.items()
        if content
    )
    line = headline(design)
    parts = (element("strong", part.text, class_=part.tone) for part in line.parts)
    findings = (line.main_finding, *hand_turn_remarks(design))
    yield element("a", "Skip to the content", href="#robot", class_="skip")
    yield element(
        "header",
        element("p", f"{design.tool.name} {design.tool.version}", class_="eyebrow"),
        element("h1", title_of(design)),
        element(
            "p",
            element("span", *parts, class_="line"),
            *(element("span", text) for text in dict.fromkeys(findings) if text),
            class_=f"verdict {line.tone}",
        ),
        _tiles(design),
    )
    yield element("nav", *links, aria_label="Contents")
    yield element("main", *(content for _, content in contents.values()))
    yield json_element("design", to_json(design).decode())
    yield view_data(story, bodies, scenarios)


def _tiles(design: OcsDesign) -> Markup:
    """Key figures, each with a name, a value and a note."""
    ocs, wheel = design.ocs, design.ocs.flywheel
    lengths = " / ".join(map(tenths, (wheel.outer_radius, wheel.inner_radius, wheel.height)))
    drive = f"at {ocs.motor.bus_voltage:g} V" if has_motor(design) else "no motor chosen"
    if ocs.motor.gear != DIRECT.name:
        drive += f", {ocs.motor.gear}"
    # As in the table of margins if present, else at the design's speed.
    stress = next((margin for margin in design.margins if margin.name == HOOP_STRESS), None)
    if stress is not None and stress.margin is not None:
        stress_note = f"stress margin {stress.margin:.2f} {stress.note}"
    else:
        margin = wheel.stress_margin
        stress_note = "stress not checked" if margin is None else f"stress margin {margin:.2f}"
    tiles = (
        ("Total mass", grams(ocs.mass_total), share_of_robot(design)),
        ("Incidence α*", degrees(ocs.incidence), ocs.incidence_criterion)
        if ocs.axes == PAIR
        else ("Layout", layout_text(ocs), f"{len(ocs.modules)} wheels"),
        ("Motor", ocs.motor.full_name, drive),
        ("Rim R / r / h", f"{lengths} mm", wheel.material),
        ("Spin inertia", inertia(ocs.spin_inertia), "of each wheel"),
        ("Wheel speed, by design", rpm(design.requirement.wheel_speed_max), stress_note),
    )
    entries = (
        element(
            "li",
            element("span", name, class_="name"),
            element("strong", value, class_="value"),
            element("span", remark, class_="note"),
        )
        for name, value, remark in tiles
    )
    return element("ul", *entries, class_="tiles")
