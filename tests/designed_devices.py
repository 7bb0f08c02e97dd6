"""Devices for Solo12's mass and inertia, designed with one motor or none, of any material.

Each is designed once per process.
"""

from dataclasses import replace
from functools import cache

from commands import SOLO12
from fronts import task_by_hand

from ocs_design.requirement.device_sections import FlywheelSection, MotorSection, OcsSection
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification, specification_from_options
from ocs_design.simulation.margins import record_margins
from ocs_design.sizing.buildable import buildable_of
from ocs_design.sizing.design import design_device
from ocs_design.workflows.pareto import read_task
from ocs_design.workflows.recording import record_design

MOTOR = "EC 45 flat 70 W 411812"


def design_with_motor(motor=MOTOR, **ocs):
    """Task and design; the incidence is that of equal rates, the default."""
    return design_of(
        Specification(
            motor=MotorSection(name=motor, gear=None if motor == "none" else "direct"),
            flywheel=FlywheelSection(material="auto"),
            ocs=OcsSection(**ocs),
        )
    )


@cache
def design_of(specification):
    """Task and design for a specification; its robot is replaced by Solo12's figures."""
    task = task_by_hand()
    task = task.with_specification(replace(specification, robot=task.specification.robot))
    return task, design_device(task)


@cache
def solo12():
    """Default task for Solo12's own file, which is read once."""
    return read_task(Specification(robot=RobotSection(file=SOLO12)))


def solo12_specification(**options):
    """Specification for Solo12 from options of the command; `motor__name` is `motor.name`."""
    keys = {name.replace("__", "."): value for name, value in options.items()}
    return specification_from_options({"robot.file": SOLO12, **keys})


def solo12_task(**options):
    """Task of that specification."""
    return solo12().with_specification(solo12_specification(**options))


def record_of(task, design, *, seed=0, files=None):
    """Record of a design without flights and mounting."""
    margins = record_margins(task.resolved, design, (), {})
    built = buildable_of(task.robot, design, margins, None)
    record = record_design(
        task.robot,
        task.resolved,
        design,
        margins=margins,
        buildable=built,
        mounting=None,
        seed=seed,
    )
    return replace(record, files=files or {})
