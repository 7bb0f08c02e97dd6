"""What the report rests on: assumptions, warnings, sources, versions, and the data itself."""

import platform
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version

from ocs_design.catalogue.gears import known_gears
from ocs_design.catalogue.materials import materials
from ocs_design.design_file import OcsDesign
from ocs_design.drive.gear import DIRECT
from ocs_design.report.html.elements import (
    Markup,
    details,
    element,
    facts,
    items,
    section,
    table,
)
from ocs_design.report.story import Story

PAPER = (
    "F. Roscia, A. Cumerlotti, A. Del Prete, C. Semini, M. Focchi, “Orientation Control System: "
    "Enhancing Aerial Maneuvers for Quadruped Robots”, Sensors 23(3):1234, 2023"
)

_LIBRARIES = ("numpy", "scipy", "cvxpy", "clarabel", "casadi", "mujoco", "trimesh")


def record_section(story: Story) -> Markup:
    """Everything that a reviewer asks for before signing."""
    design = story.design
    assumed = items(design.requirement.assumptions)
    return section(
        "record",
        "Assumptions, sources and provenance",
        element("h3", "Assumed, because nothing else was stated"),
        assumed or element("p", "Nothing: all of it was stated."),
        *_warnings(design),
        element("h3", "Sources"),
        facts(_sources(design)),
        element("h3", "Provenance"),
        facts(_provenance(story)),
        details("Files of this design, SHA-256", _files(design)),
        element("p", *_data_note(), class_="note"),
        _signature(),
    )


def _warnings(design: OcsDesign) -> Iterator[Markup]:
    if design.robot.warnings:
        yield element("h3", "Warnings about the robot's file")
        yield items(design.robot.warnings, look="warnings")


def _sources(design: OcsDesign) -> Iterator[tuple[str, str]]:
    yield "method", PAPER
    motor, wheel = design.ocs.motor, design.ocs.flywheel
    yield "motor", f"{motor.name}: {motor.source}"
    gear = known_gears(None).get(motor.gear) if motor.gear != DIRECT.name else None
    if gear is not None:
        yield "gear", f"{gear.name}: {gear.source}"
    used = [wheel.material] + ([] if wheel.web is None else [wheel.web.material])
    for name in dict.fromkeys(used):
        material = materials().get(name)
        if material is not None:
            yield "material", f"{name}: {material.source}"


def _provenance(story: Story) -> Iterator[tuple[str, str]]:
    design = story.design
    yield "robot", f"{design.robot.source}, SHA-256 {design.robot.sha256 or 'none: by hand'}"
    if story.command:
        yield "made by", story.command
    yield "program", f"{design.tool.name} {design.tool.version}"
    yield "seed", str(design.seed)
    yield "report with", f"Python {platform.python_version()}, " + ", ".join(_versions())
    yield "machine", f"{platform.system()} {platform.machine()}"


def _versions() -> Iterator[str]:
    for name in _LIBRARIES:
        try:
            yield f"{name} {version(name)}"
        except PackageNotFoundError:
            continue


def _files(design: OcsDesign) -> Markup:
    rows = ((name, element("code", digest)) for name, digest in design.files.items())
    return element("div", table("Files", ("file", "SHA-256"), rows, words=(0, 1)), class_="sums")


def _data_note() -> Iterator[str]:
    yield "All numbers are in this file too: the element "
    yield element("code", 'script#design[type="application/json"]')
    yield " holds the design.json that it was made from, SI units, full precision."


def _signature() -> Markup:
    lines = (element("span", name) for name in ("Designed by", "Reviewed by", "Date"))
    return element("div", *lines, class_="signature")
