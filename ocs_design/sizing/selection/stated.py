"""The selection that a specification asks for."""

from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import LIGHTEST, NO_WEB, Specification
from ocs_design.robot.robot import Robot
from ocs_design.sizing.free_place import stated_place
from ocs_design.sizing.incidence import Criterion
from ocs_design.sizing.selection.problem import SelectionProblem


def selection_problem(
    specification: Specification, robot: Robot, resolved: Resolved
) -> SelectionProblem | None:
    """What to choose from, and for what; None where the specification wants no motor."""
    choice = resolved.choice
    if choice is None:
        return None
    stated = specification.ocs
    return SelectionProblem(
        robot=robot.mass_properties,
        requirement=resolved.requirement,
        envelope=resolved.envelope,
        place=stated_place(stated.position, robot, resolved.envelope),
        motors=choice.motors,
        gears=choice.gears,
        materials=choice.materials,
        bus_voltage=choice.bus_voltage,
        incidence=stated.alpha,
        wheel_speed_max=choice.wheel_speed_max,
        web=specification.flywheel.web != NO_WEB,
    )


def stated_criterion(specification: Specification) -> Criterion | None:
    """For the incidence; None: whatever makes the device lightest."""
    stated = specification.ocs.alpha_criterion
    return None if stated in {None, LIGHTEST} else Criterion(stated)
