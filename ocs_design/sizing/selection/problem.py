"""What the selection chooses from, and for what."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ocs_design.actuation.motor import DIRECT, Gear, Motor
from ocs_design.catalogue.materials import Material
from ocs_design.common.errors import SpecificationError, UsageError
from ocs_design.common.units import format_quantity
from ocs_design.device.layout import Criterion
from ocs_design.parts.rim import NO_CUTS, Hub, RimCuts, hub_of
from ocs_design.requirement.froude import Envelope
from ocs_design.requirement.maneuver import Requirement
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
from ocs_design.requirement.sweep import slower
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.sizing.bound.rim_problem import check_limits
from ocs_design.sizing.limits import BUS_VOLTAGE, RIM_LIMITS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.placement import Place, specified_place


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Find the lightest device that does everything that is required.

    Attributes:
        robot: without the device, in B.
        requirement: what the device must do; its `wheel_speed_max` is not looked at here. A stated
            spin inertia is kept, and the motors must do with it what is required.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        bus_voltage: of the motors' supply [V].
        incidence: of the wheel axes [rad]; None: the best.
        wheel_speed_max: stated highest speed of a wheel [rad/s]; None: what the drive can do.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    place: Place
    motors: Sequence[Motor]
    gears: Sequence[Gear]
    materials: Sequence[Material]
    bus_voltage: float
    incidence: float | None = None
    wheel_speed_max: float | None = None
    web: bool = True
    cuts: RimCuts = NO_CUTS

    def hub(self, motor: Motor, gear: Gear) -> Hub | None:
        """Hub of a wheel on this motor behind this gear; None: massless spokes."""
        if not self.web:
            return None
        return hub_of(motor, direct=gear == DIRECT, chamfer=self.cuts.chamfer)

    def check(self) -> None:
        """Refuse a problem that is no question.

        Raises:
            UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
        """
        for name in ("motors", "gears", "materials"):
            if not getattr(self, name):
                raise UsageError(f"there are no {name} to choose from")
        asked = self.requirement
        if not any((asked.maneuvers, asked.rate_change, asked.spin_inertia)):
            raise UsageError(
                "nothing is asked of the wheels",
                hint="Ask for a rate change, for a maneuver, or for a spin inertia.",
            )
        speed = 1.0 if self.wheel_speed_max is None else self.wheel_speed_max
        for material in self.materials:
            check_limits(self.envelope, material, speed)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Every limit that may be in the way, as it is [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.bus_voltage,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The problem with one of its limits changed [SI]."""
    if limit is BUS_VOLTAGE:
        return replace(problem, bus_voltage=value)
    if limit is WHEEL_SPEED:
        return replace(problem, wheel_speed_max=value)
    if limit is TIME:
        names = {maneuver.name for maneuver in problem.requirement.maneuvers}
        return with_time(problem, value, names)
    return replace(problem, envelope=limit.replaced(problem.envelope, value))


def with_time(problem: SelectionProblem, factor: float, names: set[str]) -> SelectionProblem:
    """The problem with `factor` times the time for the maneuvers of these names."""
    requirement = problem.requirement
    maneuvers = tuple(
        slower(maneuver, factor, requirement.standing_height)
        if maneuver.name in names
        else maneuver
        for maneuver in requirement.maneuvers
    )
    return replace(problem, requirement=replace(requirement, maneuvers=maneuvers))


def selection_problem(
    specification: Specification, robot: Robot, resolved: Resolved
) -> SelectionProblem | None:
    """The problem that a specification poses; None where it wants no motor."""
    choice = resolved.choice
    if choice is None:
        return None
    stated = specification.ocs
    return SelectionProblem(
        robot=robot.mass_properties,
        requirement=resolved.requirement,
        envelope=resolved.envelope,
        place=specified_place(stated.position, robot, resolved.envelope),
        motors=choice.motors,
        gears=choice.gears,
        materials=choice.materials,
        bus_voltage=choice.bus_voltage,
        incidence=stated.alpha,
        wheel_speed_max=choice.wheel_speed_max,
        web=specification.flywheel.web != NO_WEB,
        cuts=specified_cuts(specification.flywheel, resolved.envelope),
    )


def specified_cuts(stated: FlywheelSection, room: Envelope) -> RimCuts:
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
    name, faults = "balancing_holes" if cuts.holes else "chamfer", []
    bore = max(room.inner_radius_min, cuts.inner_radius_min)
    wall = room.outer_radius_max - bore
    if cuts.wall_min > wall:
        faults.append(
            f"flywheel.{name}: a wall of {format_quantity(cuts.wall_min, 'mm')} is the least, and "
            f"{format_quantity(max(wall, 0.0), 'mm')} is between r_max and the bore: allow a "
            "larger r_max, or fewer and smaller holes"
        )
    if cuts.height_min > room.height_max:
        faults.append(
            f"flywheel.{name}: a height of {format_quantity(cuts.height_min, 'mm')} is the least, "
            f"and h_max is {format_quantity(room.height_max, 'mm')}: allow a larger h_max, or "
            "less depth"
        )
    if faults:
        raise SpecificationError("the rim has no room for what is cut off it:", problems=faults)
    return cuts


def specified_criterion(specification: Specification) -> Criterion | None:
    """Criterion for the incidence; None: whatever makes the device lightest."""
    stated = specification.ocs.alpha_criterion
    return None if stated in {None, LIGHTEST} else Criterion(stated)
