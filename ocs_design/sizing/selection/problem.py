"""What the selection chooses from, and for what."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np

from ocs_design.actuation.motor import DIRECT, Gear, Motor, Mounting
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material, material
from ocs_design.common.arrays import FloatArray, vector
from ocs_design.common.errors import SpecificationError, UsageError
from ocs_design.common.units import format_quantity
from ocs_design.device.layout import PAIR, Criterion, Layout, LayoutName
from ocs_design.parts.bell import bell_of
from ocs_design.parts.joints import SERVICE, hub_joint
from ocs_design.parts.motor_mount import is_held
from ocs_design.parts.printed import PLATE_THICKNESS
from ocs_design.parts.rim import (
    NO_CUTS,
    SHRUNK_WEB_THICKNESS,
    WEB_MATERIAL,
    WEB_THICKNESS,
    Hub,
    RimCuts,
    hub_height,
    hub_of,
)
from ocs_design.requirement.choices import MotorChoice
from ocs_design.requirement.device_sections import FlywheelSection
from ocs_design.requirement.froude import Envelope
from ocs_design.requirement.kinds import slower
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.turns import TurnTo
from ocs_design.requirement.vocabulary import (
    ALL_LAYOUTS,
    ALUMINIUM_WEB,
    AUTO,
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    EQUAL_RATE,
    LARGEST_CHAMFER,
    LIGHTENING,
    LIGHTEST,
    NO_WEB,
    RING,
)
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.sizing.bound.rim_problem import check_limits
from ocs_design.sizing.footing import footing_of
from ocs_design.sizing.limits import BUS_POWER, BUS_VOLTAGE, RIM_LIMITS, TIME, WHEEL_SPEED, Limit
from ocs_design.sizing.placement import Place


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """Find the lightest device that does everything that is required.

    Attributes:
        robot: without the modules, with the plate that they stand on, in B.
        requirement: what the device must do; its `wheel_speed_max` is not looked at here. A stated
            spin inertia is kept, and the motors must do with it what is required.
        envelope: room for one rim; its housing stands around it.
        place: of the modules, by outer radius and height of their housings.
        layout: of their axes.
        motors, gears, materials: to choose from; direct drive is the gear `DIRECT`.
        supply: of all motors; each of the wheels may take its share of the power.
        incidence: of a pair's wheel axes, or the angle of another layout [rad]; None: the best.
        wheel_speed_max: stated highest speed of a wheel [rad/s]; None: what the drive can do.
        web: whether wheels have a web and a hub; massless spokes otherwise.
        on_bell: whether they are rings around the bells of the motors, without web or gear.
        cuts: chamfers and balancing holes of wheels with a web; those without are plain rims.
        web_material: of web and hub; None: of one piece with the rim.
        lightenings: numbers of holes in a web to choose from, 0 a solid one.
        guard_wall: of the steel rings in the housings [m]; 0: none.
        foot_plate: thickness of the feet's plates [m].
    """

    robot: MassProperties
    requirement: Requirement
    envelope: Envelope
    place: Place
    motors: Sequence[Motor]
    gears: Sequence[Gear]
    materials: Sequence[Material]
    supply: Supply
    incidence: float | None = None
    wheel_speed_max: float | None = None
    web: bool = True
    on_bell: bool = False
    cuts: RimCuts = NO_CUTS
    web_material: Material | None = None
    lightenings: Sequence[int] = (0,)
    guard_wall: float = 0.0
    foot_plate: float = PLATE_THICKNESS
    layout: Layout = PAIR

    @property
    def web_densities(self) -> FloatArray:
        """Density of web and hub of a wheel of each material [kg/m^3]."""
        of_rims = np.array([material.density for material in self.materials])
        return (
            of_rims
            if self.web_material is None
            else np.full_like(of_rims, self.web_material.density)
        )

    @property
    def bus_voltage(self) -> float:
        """Voltage of the supply [V]."""
        return self.supply.voltage

    @property
    def web_thickness(self) -> float:
        """Thickness of their webs [m]."""
        return WEB_THICKNESS if self.web_material is None else SHRUNK_WEB_THICKNESS

    def hub(self, motor: Motor, gear: Gear, lightening: int) -> Hub | None:
        """Hub of a wheel on this motor behind this gear; None: massless spokes.

        Its web is solid where the largest rim leaves no room for so many holes.
        """
        if not self.web:
            return None
        hub = hub_of(
            motor,
            direct=gear.room is None,
            chamfer=self.cuts.chamfer,
            web_thickness=self.web_thickness,
            lightening=lightening,
        )
        wall = max(self.envelope.wall_min, self.cuts.wall_min)
        fits = hub.bore_min + wall <= self.envelope.outer_radius_max
        return hub if fits else replace(hub, lightening=0)

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
        for each in self.materials:
            check_limits(self.envelope, each, speed)


def limits_of(problem: SelectionProblem) -> dict[Limit, float]:
    """Every limit that may be in the way, as it is [SI]."""
    speed = {} if problem.wheel_speed_max is None else {WHEEL_SPEED: problem.wheel_speed_max}
    power = {BUS_POWER: problem.supply.power} if isfinite(problem.supply.power) else {}
    return {
        **{limit: limit.value(problem.envelope) for limit in RIM_LIMITS},
        **speed,
        BUS_VOLTAGE: problem.supply.voltage,
        **power,
        TIME: 1.0,
    }


def with_limit(problem: SelectionProblem, limit: Limit, value: float) -> SelectionProblem:
    """The problem with one of its limits changed [SI]."""
    if limit is BUS_VOLTAGE:
        return replace(problem, supply=replace(problem.supply, voltage=value))
    if limit is BUS_POWER:
        # The current gives way with it, where it is the smaller limit of the two.
        supply = problem.supply
        current = max(supply.current_max, value / supply.voltage)
        return replace(problem, supply=Supply(supply.voltage, current, value))
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
    stated, layout = specification.ocs, specified_layout(specification)
    footing = footing_of(robot, resolved.envelope, stated.position, layout)
    angle = layout.angle if stated.alpha is None else stated.alpha
    direct = angle is not None and bool(np.linalg.matrix_rank(layout.axes(angle), _SPANS) == 3)
    maneuvers = tuple(
        replace(each, direct=direct) if isinstance(each, TurnTo) else each
        for each in resolved.requirement.maneuvers
    )
    problem = SelectionProblem(
        robot=footing.carried(robot.mass_properties),
        requirement=replace(resolved.requirement, maneuvers=maneuvers),
        envelope=resolved.envelope,
        place=footing.place,
        motors=_held(specification, choice),
        gears=choice.gears,
        materials=choice.materials,
        supply=choice.supply,
        incidence=angle,
        layout=layout,
        wheel_speed_max=choice.wheel_speed_max,
        web=specification.flywheel.web != NO_WEB,
        cuts=specified_cuts(specification.flywheel, resolved.envelope),
        web_material=material(WEB_MATERIAL)
        if specification.flywheel.web == ALUMINIUM_WEB
        else None,
        lightenings=specified_lightenings(specification.flywheel),
    )
    return on_bells(problem, choice.motors) if stated.wheel == RING else problem


def on_bells(problem: SelectionProblem, motors: Sequence[Motor]) -> SelectionProblem:
    """The problem with rings around the bells of those of these motors that have one.

    Raises:
        UsageError: none has.
    """
    belled = tuple(motor for motor in motors if bell_of(motor) is not None)
    if not belled:
        some = ", ".join(motor.name for motor in motors[:_NAMED])
        raise UsageError(
            f"no ring fits around the bell of {some}{' ...' if len(motors) > _NAMED else ''}: it "
            "takes an outrunner that is screwed on by its back, of known diameter and length, with "
            "a bell longer than its shaft stands out",
            hint="Name another motor with --motor, or leave out --wheel ring.",
        )
    return replace(
        problem,
        motors=belled,
        gears=(DIRECT,),
        web=False,
        on_bell=True,
        web_material=None,
        lightenings=(0,),
    )


def other_construction(
    specification: Specification, resolved: Resolved, problem: SelectionProblem
) -> SelectionProblem | None:
    """A problem with rings in place of discs, or discs in place of rings; None: nothing to ask."""
    choice, flywheel = resolved.choice, specification.flywheel
    if choice is None or (flywheel.web == NO_WEB and not problem.on_bell):
        return None
    if problem.on_bell:
        return replace(
            problem,
            motors=_held(specification, choice),
            gears=choice.gears,
            web=True,
            on_bell=False,
            lightenings=specified_lightenings(flywheel),
        )
    try:
        return on_bells(problem, choice.motors)
    except UsageError:
        return None


_NAMED = 3
"""Motors that a message names."""

_SPANS = 1e-3
"""Least singular value of axes that reach roll, pitch and yaw."""


def _held(specification: Specification, choice: MotorChoice) -> tuple[Motor, ...]:
    """Motors to choose from: of those that nobody named, the ones that are held and hold a wheel.

    All of them where none is, whose open points then say why.
    """
    stated = specification.motor
    if stated.any or stated.name not in {None, AUTO} or any(gear.room for gear in choice.gears):
        return choice.motors
    held = (motor for motor in choice.motors if is_held(motor, None) and _holds_wheel(motor))
    return tuple(held) or choice.motors


def _holds_wheel(motor: Motor) -> bool:
    """True if the joint of hub and motor carries its peak torque with what is to spare."""
    mounting = motor.mounting or Mounting()
    carried = hub_joint(mounting, hub_height(mounting) - 2.0 * LARGEST_CHAMFER)
    return carried is not None and carried >= SERVICE * (motor.peak_torque or 0.0)


def specified_lightenings(stated: FlywheelSection) -> tuple[int, ...]:
    """Solid webs, and those with lightening holes; one that a rim is shrunk on is pressed, solid.

    A small wheel of a fast motor has no room for holes, and may yet be the lightest.
    """
    holes = LIGHTENING if stated.lightening is None else stated.lightening
    return (0, holes) if holes and stated.web not in {NO_WEB, ALUMINIUM_WEB} else (0,)


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


def specified_layout(specification: Specification) -> Layout:
    """Layout of the wheels' axes: a pair where none is stated."""
    stated = specification.ocs.layout
    if stated == ALL_LAYOUTS:
        raise UsageError(
            f"ocs.layout: {ALL_LAYOUTS!r} is no layout of one device",
            hint="`size --layout all` compares all layouts; state one of them here.",
        )
    if specification.ocs.axes is not None:
        axes = np.reshape(specification.ocs.axes, (-1, 3))
        axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
        return Layout(LayoutName.BY_HAND, tuple(vector(axis) for axis in axes))
    return PAIR if stated is None else Layout(LayoutName(stated))


def specified_criterion(specification: Specification) -> Criterion | None:
    """Criterion for a pair's incidence; None: whatever makes the device lightest."""
    stated = specification.ocs.alpha_criterion or EQUAL_RATE
    return None if stated == LIGHTEST else Criterion(stated)
