"""Devices for Solo12's figures, designed with one motor or with none.

Of any material and at the lightest incidence, whatever is the default.
"""

from functools import cache

from fronts import by_hand

from ocs_design.requirement.device_sections import FlywheelSection, MotorSection, OcsSection
from ocs_design.requirement.specification import Specification
from ocs_design.sizing.design import design_device

MOTOR = "EC 45 flat 70 W 411812"


@cache
def designed(motor=MOTOR, alpha=None, criterion="lightest", mass_max=None, guard=None, layout=None):
    """The task and what came of it; without a motor no incidence is the lightest."""
    task = by_hand()
    if motor == "none" and criterion == "lightest":
        criterion = None
    given = Specification(
        robot=task.specification.robot,
        motor=MotorSection(name=motor, gear=None if motor == "none" else "direct"),
        flywheel=FlywheelSection(material="auto"),
        ocs=OcsSection(
            alpha=alpha,
            alpha_criterion=criterion if layout is None else None,
            mass_max=mass_max,
            guard=guard,
            layout=layout,
        ),
    )
    task = task.with_specification(given)
    return task, design_device(given, task.robot, task.resolved)
