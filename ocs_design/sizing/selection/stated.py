"""The selection that a specification asks for."""

from collections.abc import Iterator
from dataclasses import replace

from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import (
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    LIGHTEST,
    NO_WEB,
    FlywheelSection,
    Specification,
)
from ocs_design.robot.robot import Robot
from ocs_design.sizing.free_place import stated_place
from ocs_design.sizing.incidence import Criterion
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.units import format_quantity


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
        cuts=stated_cuts(specification.flywheel, resolved.envelope),
    )


def stated_cuts(stated: FlywheelSection, room: Envelope) -> RimCuts:
    """Chamfers and balancing holes of wheels with a web.

    Raises:
        SpecificationError: no rim in this room is large enough for them.
    """
    if stated.web == NO_WEB:
        return NO_CUTS
    cuts = RimCuts(CHAMFER if stated.chamfer is None else stated.chamfer)
    if stated.balancing_holes:
        cuts = replace(
            cuts,
            holes=stated.balancing_holes,
            hole_radius=(stated.balancing_hole_diameter or BALANCING_DIAMETER) / 2.0,
            hole_depth=stated.balancing_hole_depth or BALANCING_DEPTH,
        )
    faults = tuple(_without_room(cuts, room))
    if faults:
        raise SpecificationError("the rim has no room for what is cut off it:", problems=faults)
    return cuts


def _without_room(cuts: RimCuts, room: Envelope) -> Iterator[str]:
    name = "balancing_holes" if cuts.holes else "chamfer"
    bore = max(room.inner_radius_min, cuts.inner_radius_min)
    wall, height = room.outer_radius_max - bore, room.height_max
    if cuts.wall_min > wall:
        yield (
            f"flywheel.{name}: a wall of {format_quantity(cuts.wall_min, 'mm')} is the least, and "
            f"{format_quantity(max(wall, 0.0), 'mm')} is between r_max and the bore: allow a "
            "larger r_max, or fewer and smaller holes"
        )
    if cuts.height_min > height:
        yield (
            f"flywheel.{name}: a height of {format_quantity(cuts.height_min, 'mm')} is the least, "
            f"and h_max is {format_quantity(height, 'mm')}: allow a larger h_max, or less depth"
        )


def stated_criterion(specification: Specification) -> Criterion | None:
    """For the incidence; None: whatever makes the device lightest."""
    stated = specification.ocs.alpha_criterion
    return None if stated in {None, LIGHTEST} else Criterion(stated)
