"""Size, export and prove a flywheel orientation control system for a legged robot.

The public names load their modules on first use: importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ocs_design.design import Device
    from ocs_design.design_file import OcsDesign, read_design
    from ocs_design.exceptions import Infeasible, OcsError
    from ocs_design.pipeline import Outcome, design_ocs
    from ocs_design.requirement.reading import read_specification
    from ocs_design.requirement.specification import Specification
    from ocs_design.robot.manual import robot_by_hand
    from ocs_design.robot.reader import read_robot
    from ocs_design.robot.robot import Robot

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
    "Device": "design",
    "Infeasible": "exceptions",
    "OcsDesign": "design_file",
    "OcsError": "exceptions",
    "Outcome": "pipeline",
    "Robot": "robot.robot",
    "Specification": "requirement.specification",
    "design_ocs": "pipeline",
    "read_design": "design_file",
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
