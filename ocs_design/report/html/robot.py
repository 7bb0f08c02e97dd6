"""The robot with its device: what was read and what was made."""

from ocs_design.report.device import cautions, device_facts
from ocs_design.report.html.elements import Markup, element, facts, items, section
from ocs_design.report.motor_notes import motor_notes
from ocs_design.report.story import Story
from ocs_design.report.terminal import robot_facts


def robot_section(story: Story, view: Markup) -> Markup:
    """Its view, the facts, and what is to be minded."""
    design = story.design
    warnings = (*design.ocs.warnings, *cautions(design.ocs), *motor_notes(design))
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
        items(warnings, look="warnings"),
    )
