"""Size, export and prove a flywheel orientation control system for a legged robot.

The public names load their modules on first use: importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ocs_design.common.errors import Infeasible, OcsError
    from ocs_design.device.device import Device
    from ocs_design.device.records import OcsDesign, read_design
    from ocs_design.requirement.reading import read_specification
    from ocs_design.requirement.specification import Specification
    from ocs_design.robot.manual import robot_by_hand
    from ocs_design.robot.reader import read_robot
    from ocs_design.robot.robot import Robot
    from ocs_design.workflows.size import Outcome, design_ocs

__version__ = "0.1.0"

__all__ = [
    "Device",
    "Infeasible",
    "OcsDesign",
    "OcsError",
    "Outcome",
    "Robot",
    "Specification",
    "design_ocs",
    "read_design",
    "read_robot",
    "read_specification",
    "robot_by_hand",
]

_MODULES = {
    "Device": "device.device",
    "Infeasible": "common.errors",
    "OcsDesign": "device.records",
    "OcsError": "common.errors",
    "Outcome": "workflows.size",
    "Robot": "robot.robot",
    "Specification": "requirement.specification",
    "design_ocs": "workflows.size",
    "read_design": "device.records",
    "read_robot": "robot.reader",
    "read_specification": "requirement.reading",
    "robot_by_hand": "robot.manual",
}


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
