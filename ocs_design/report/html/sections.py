"""Sections of the page: the facts of the report with its charts."""

import platform
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version

from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.gears import gears
from ocs_design.catalogue.materials import recorded_material
from ocs_design.common.wording import counted, grams
from ocs_design.device.device import Device
from ocs_design.device.records.design import OcsDesign
from ocs_design.export.assembly.booklet import chapters, pictures, piece_rows, screw_rows
from ocs_design.export.assembly.content import Assembly
from ocs_design.export.drawing.wheel import (
    WEB_GRADE,
    bore_diameter_label,
    fitted_bore_label,
    in_mm,
    inertia_error,
    rim_diameter_label,
    toleranced,
)
from ocs_design.parts.joints import Grade
from ocs_design.report import flights, limits, monte_carlo, selection, warnings
from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.flights import distribution_charts, drive_charts
from ocs_design.report.charts.front import reserve_charts
from ocs_design.report.charts.momentum import bound_charts, incidence_charts
from ocs_design.report.device import device_facts, distribution_facts, robot_facts
from ocs_design.report.html.elements import (
    Markup,
    details,
    element,
    facts,
    figures,
    items,
    note,
    section,
    table,
)
from ocs_design.report.story import Story
from ocs_design.report.table import CellTable, columns

PAPER = (
    "F. Roscia, A. Cumerlotti, A. Del Prete, C. Semini, M. Focchi, “Orientation Control System: "
    "Enhancing Aerial Maneuvers for Quadruped Robots”, Sensors 23(3):1234, 2023"
)

_SCREWS = (
    *("No.", "quantity", "<screw", "<what it holds", "<thread engaged"),
    *("<torque", "<set by"),
)
"""Columns of `ScrewRow`."""

_LIBRARIES = ("numpy", "scipy", "cvxpy", "clarabel", "casadi", "mujoco", "trimesh")


def robot_section(story: Story, view: Markup) -> Markup:
    """View, facts and warnings of the robot with its device."""
    design = story.design
    points = design.buildable.open
    # Warnings about the robot's file are in the section on provenance.
    of_robot = design.robot.warnings
    device_warnings = [text for text in warnings.all_warnings(design) if text not in of_robot]
    return section(
        "robot",
        "Robot and device",
        view,
        element(
            "div",
            element("div", element("h3", "Robot"), facts(robot_facts(design.robot))),
            element("div", element("h3", "Device"), facts(device_facts(design))),
            class_="halves",
        ),
        table("What keeps it from being built", limits.open_points(design)) if points else "",
        items((*device_warnings, *warnings.reach_notes(design.ocs)), css_class="warnings"),
    )


def sizes_section(design: OcsDesign) -> Markup:
    """Sizes of the wheel with their tolerances, and the margins."""
    wheel, margins = design.ocs.flywheel.shape, design.margins
    rows = [("outer diameter, 2 R", rim_diameter_label(wheel))]
    if wheel.rim.inner_radius > 0.0:
        rows.append(("bore of the rim, 2 r", bore_diameter_label(wheel)))
    rows.append(("height of the rim, h", toleranced(wheel.rim.height, Grade.IT11)))
    if wheel.web is not None:
        hub = wheel.web.hub
        rows.append(("hub, diameter", f"Ø{in_mm(2.0 * hub.radius)}"))
        rows.append(("hub, height", in_mm(hub.height)))
        if hub.bore_radius > 0.0:
            rows.append(("hub, bore", fitted_bore_label(hub.bore_radius)))
        rows.append(("web, thickness", toleranced(wheel.web.thickness, WEB_GRADE)))
    inertia_note = (
        "Within all tolerances together, ISO 2768-m where none is given, the wheel's spin inertia "
        f"stays within ±{inertia_error(wheel):.1%} (to first order, without the rotor's)."
    )
    return section(
        "sizes",
        "Sizes, tolerances and margins",
        table("Wheel, as on its drawing", CellTable(columns("<size", "mm"), tuple(rows))),
        note(inertia_note),
        table("Margins", limits.margin_table(margins)),
        note(limits.MARGIN_NOTE),
        items(limits.margin_notes(margins), css_class="note"),
    )


def limits_section(story: Story) -> Markup:
    """Active limits, and the mass that moving each of them saves."""
    design = story.design
    names, meaning = limits.active_limits(design)
    driving = limits.driving_maneuver_text(design)
    alternatives = limits.alternatives_table(design)
    drive, command = [], "ocs-design pareto --against radius|height|voltage|time|angle"
    if design.selection is not None:
        hint = "To plot the mass of the whole device against room, voltage or time, run "
        drive.append(note(hint, element("code", command), "."))
        reserve = design.selection.kept
        if reserve is not None:
            drive += [
                table("What is uncertain, and what it costs", limits.reserve_table(reserve)),
                figures(reserve_charts(design.selection)),
                note(limits.reserve_note(reserve, design.ocs.mass_total)),
            ]
    return section(
        "limits",
        "Active limits, and what moving them saves",
        element("p", "The mass is set by: ", element("strong", names), ". ", meaning),
        element("p", f"Driven by {driving}.") if driving else "",
        table("Each limit moved alone", limits.saving_table(design)),
        note(limits.saving_notes(design)),
        *drive,
        table("Lighter alternatives", alternatives) if alternatives.rows else "",
        note(limits.useless_changes_note(design)),
        table(f"Trade-offs to save {grams(design.lighter.by)}", limits.lighter_table(design))
        if design.lighter is not None
        else "",
    )


def bound_section(story: Story) -> Markup:
    """The paper's lower bound and the design's position."""
    return section(
        "bound",
        "The lower bound, and where the design lies",
        figures(bound_charts(story)),
        note(limits.BOUND_NOTE),
    )


def angles_section(story: Story) -> Markup:
    """Inertia and momenta in the plane of the axes, and incidence by criterion and posture."""
    return section(
        "angles",
        "Incidence of the wheel axes",
        figures(incidence_charts(story)),
        items(warnings.coupling_notes(story.design)),
    )


def drive_section(story: Story) -> Markup:
    """Torque and speed of the wheels, and how the drive was chosen."""
    choice, maneuvers = story.design.selection, story.design.requirement.maneuvers
    parts = [figures(drive_charts(story.design.ocs.motor, story.flights))]
    if choice is None:
        return section("drive", "Drive", *parts)
    drives = selection.best_drives(choice.ranking)
    parts += [
        element("p", f"Chosen from {selection.choice_title(choice)}."),
        table("Requirements on the drive", selection.task_table(choice)),
        note(selection.task_note(choice, maneuvers)),
        table("The lightest drives", selection.drive_table(drives)),
    ]
    co_design = selection.co_design_facts(choice)
    if co_design:
        parts.append(element("h3", "Co-design: all dimensions together with the maneuvers, in 3-D"))
        parts.append(facts(co_design))
    reasons = selection.rejection_details(choice)
    if reasons:
        ruled_out = f"{counted(len(reasons), 'motor')} ruled out, and why"
        parts.append(details(ruled_out, items(reasons)))
    return section("drive", "Drive", *parts)


def maneuvers_section(
    story: Story, charts: dict[str, Sequence[Chart]], scenarios: Sequence[str]
) -> Markup:
    """Article for each maneuver, flown with the device and without, with its charts.

    `scenarios` are those that can be replayed, in the order of the viewer.
    """
    names = dict.fromkeys(run.scenario for run in story.design.validation)
    if not names:
        return section("maneuvers", "Maneuvers", element("p", "No flight was simulated."))
    parts = []
    for name in names:
        runs = [run for run in story.design.validation if run.scenario == name]
        number = str(scenarios.index(name)) if name in scenarios else ""
        button = element("button", "Show in the 3-D view", type="button", data_replay=number)
        parts.append(
            element(
                "article",
                element("h3", name, " ", button if number else ""),
                table(f"{name}: outcome", flights.flight_table(runs, one_scenario=True)),
                *(note(flights.run_sentence(run)) for run in runs),
                figures(charts[name], flight=number) if charts.get(name) else "",
            )
        )
    survival = story.design.survival
    if survival is not None:
        parts.append(
            element(
                "article",
                element("h3", "Failure of a drive in flight"),
                table(flights.SURVIVAL_TITLE, flights.survival_table(survival)),
                *map(note, flights.survival_sentences(story.design)),
            )
        )
    return section("maneuvers", "Maneuvers, with the device and without", *parts)


def monte_carlo_section(story: Story) -> Markup:
    """Pass rates and spread of the Monte Carlo flights; empty if there are none."""
    record, verdict = story.monte_carlo, []
    if record is None:
        return Markup("")
    if record.certificate is not None:
        line = element("strong", monte_carlo.certificate_line(record.certificate))
        notes = [f"{text}." for text in monte_carlo.certificate_notes(record.certificate)]
        verdict = [element("p", line), items(notes)]
    return section(
        "samples",
        "Monte Carlo",
        *verdict,
        element("p", f"{monte_carlo.campaign_title(record)}."),
        table("How often they pass", monte_carlo.success_table(record)),
        *(element("p", f"{s.scenario}: {s.advice}.") for s in record.scenarios if s.advice),
        figures(distribution_charts(record, story.pivots)),
        details("Distributions sampled", facts(distribution_facts(record.reality))),
    )


def assembly_section(story: Story) -> Markup:
    """Pictures, pieces, screws and all instructions."""
    design, ocs = story.design, story.design.ocs
    # The exploded view takes a second to draw, so the drawing for the PDF is reused.
    assembly = story.assembly
    if assembly is None:
        device = Device.of_record(ocs, design.supply)
        assembly = Assembly(design.robot.name, device).recorded(design)
    pieces, screws = (
        tuple(tuple(map(str, row)) for row in rows)
        for rows in (piece_rows(assembly), screw_rows(assembly))
    )
    exploded, *cut = (element("figure", Markup(svg), class_="sheet") for svg in pictures(assembly))
    instructions = []
    for chapter in chapters(assembly):
        entries = (element("li", text) for text in chapter.texts)
        numbered = element("ol", *entries, start=str(chapter.first))
        instructions.append(element("h3", chapter.title))
        instructions.append(numbered if chapter.numbered else items(chapter.texts))
    return section(
        "assembly",
        "Assembly: how to build, balance, test and wire it",
        exploded,
        table(
            "Pieces of the whole device, by their numbers",
            CellTable(columns("No.", "quantity", "<piece", "<made", "<file in cad/"), pieces),
        ),
        *cut,
        table("Screws", CellTable(columns(*_SCREWS), screws)) if screws else "",
        *instructions,
        element("p", "To print this, use ", element("code", "cad/assembly.pdf"), "."),
    )


def record_section(story: Story) -> Markup:
    """Assumptions, warnings, sources, versions and hashes: what a reviewer asks for."""
    design = story.design
    assumptions = items(design.requirement.assumptions)
    robot_warnings = items(design.robot.warnings, css_class="warnings")
    hashes = CellTable(columns("<file", "<SHA-256"), tuple(design.files.items()))
    lines = (element("span", name) for name in ("Designed by", "Reviewed by", "Date"))
    motor, wheel = design.ocs.motor, design.ocs.flywheel
    sources = [("method", PAPER), ("motor", f"{motor.full_name}: {motor.source}")]
    gear = gears().get(motor.gear) if motor.gear != DIRECT.name else None
    if gear is not None:
        sources.append(("gear", f"{gear.name}: {gear.source}"))
    material_names = [wheel.material] + ([] if wheel.web is None else [wheel.web.material])
    for name in dict.fromkeys(material_names):
        material = recorded_material(name)
        if material is not None:
            sources.append(("material", f"{name}: {material.source}"))
    libraries = []
    for name in _LIBRARIES:
        with suppress(PackageNotFoundError):
            libraries.append(f"{name} {version(name)}")
    provenance = [
        ("robot", f"{design.robot.source}, SHA-256 {design.robot.sha256 or 'none: by hand'}"),
        *([("made by", story.command)] if story.command else []),
        ("program", f"{design.tool.name} {design.tool.version}"),
        ("seed", str(design.seed)),
        ("report with", f"Python {platform.python_version()}, {', '.join(libraries)}"),
        ("machine", f"{platform.system()} {platform.machine()}"),
    ]
    return section(
        "record",
        "Assumptions, sources and provenance",
        element("h3", "Assumed, because nothing else was specified"),
        assumptions or element("p", "Nothing: everything was specified."),
        details(
            "Distributions that samples are drawn from", facts(distribution_facts(design.reality))
        ),
        element("h3", "Warnings about the robot's file") if robot_warnings else "",
        robot_warnings,
        element("h3", "Sources"),
        facts(sources),
        element("h3", "Provenance"),
        facts(provenance),
        details(
            "Files of this design, SHA-256", element("div", table("Files", hashes), class_="sums")
        ),
        note(
            "All numbers are in this file too: the element ",
            element("code", 'script#design[type="application/json"]'),
            " holds the design.json that it was made from, in SI units and full precision.",
        ),
        element("div", *lines, class_="signature"),
    )
