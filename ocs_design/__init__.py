"""Size, export and prove a flywheel orientation control system for a legged robot.

The public names load their modules on first use: importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ocs_design.common.errors import Infeasible, OcsError
    from ocs_design.device.answers import Exported, Front
    from ocs_design.device.device import Device
    from ocs_design.device.records.design import OcsDesign, read_design
    from ocs_design.report.html.notebook import as_html as as_html
    from ocs_design.requirement.reading import read_specification, specify
    from ocs_design.requirement.specification import Specification
    from ocs_design.robot.manual import robot_by_hand
    from ocs_design.robot.reader import read_robot
    from ocs_design.robot.robot import Robot
    from ocs_design.simulation.run import Run
    from ocs_design.workflows.export import export_design
    from ocs_design.workflows.pareto import pareto_front
    from ocs_design.workflows.size import Outcome, design_ocs
    from ocs_design.workflows.validate import Validation, validate_design

__version__ = "0.1.0"

__all__ = [
    "Device",
    "Exported",
    "Front",
    "Infeasible",
    "OcsDesign",
    "OcsError",
    "Outcome",
    "Robot",
    "Run",
    "Specification",
    "Validation",
    "design_ocs",
    "export_design",
    "pareto_front",
    "read_design",
    "read_robot",
    "read_specification",
    "robot_by_hand",
    "specify",
    "validate_design",
]

_MODULES = {
    "Device": "device.device",
    "Exported": "device.answers",
    "Front": "device.answers",
    "Infeasible": "common.errors",
    "OcsDesign": "device.records.design",
    "OcsError": "common.errors",
    "Outcome": "workflows.size",
    "Robot": "robot.robot",
    "Run": "simulation.run",
    "Specification": "requirement.specification",
    "Validation": "workflows.validate",
    # What values below the report show themselves by in a notebook.
    "as_html": "report.html.notebook",
    "design_ocs": "workflows.size",
    "export_design": "workflows.export",
    "pareto_front": "workflows.pareto",
    "read_design": "device.records.design",
    "read_robot": "robot.reader",
    "read_specification": "requirement.reading",
    "robot_by_hand": "robot.manual",
    "specify": "requirement.reading",
    "validate_design": "workflows.validate",
}


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
