"""What was assumed where a specification says nothing, in sentences for people."""

from collections.abc import Iterator

from ocs_design.catalogue.materials import Material
from ocs_design.drive.gear import DIRECT
from ocs_design.drive.line import RESERVE, missing_figures
from ocs_design.requirement.envelope import LIMIT_OF_KEY, Envelope
from ocs_design.requirement.froude import (
    BUS_VOLTAGES,
    LIGHT_ROBOT,
    RIM_MASS_SHARE,
    SOLO12,
    Scale,
)
from ocs_design.requirement.motor_choice import MotorChoice
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.specification import (
    AUTO,
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    NO_WEB,
    FlywheelSection,
    Specification,
)
from ocs_design.robot.robot import Robot
from ocs_design.units import format_quantity


def assumptions(
    specification: Specification,
    robot: Robot,
    requirement: Requirement,
    envelope: Envelope,
    *,
    chosen: Material,
    choice: MotorChoice | None,
) -> tuple[str, ...]:
    """One sentence for everything that was not stated; the rest has its defaults filled in."""
    scale = Scale.of(robot)
    return (
        *_assumed_task(specification, robot, requirement, scale),
        *_assumed_room(specification.flywheel, envelope, scale),
        *(
            _without_motor(specification, requirement, envelope, chosen)
            if choice is None
            else _choosing(specification, envelope, choice)
        ),
    )


def _assumed_task(
    specification: Specification, robot: Robot, requirement: Requirement, scale: Scale
) -> Iterator[str]:
    if robot.standing_height is None:
        height = format_quantity(requirement.standing_height, "mm", 3)
        yield f"No legs: the trunk stands {height} high, {SOLO12.name}'s scaled by gyration radius."
    if specification.takes_default_maneuvers:
        ratio = f"lengths x {scale.length:.3g}"
        yield f"Maneuvers: the paper's three, scaled from {SOLO12.name} ({ratio})."
        yield from (f"{item.name}: {item.summary}." for item in requirement.maneuvers)


def _assumed_room(flywheel: FlywheelSection, envelope: Envelope, scale: Scale) -> Iterator[str]:
    lengths = [
        f"{key} {format_quantity(getattr(envelope, LIMIT_OF_KEY[key]), 'mm', 3)}"
        for key in ("r_max", "r_min", "h_max", "h_min", "wall_min")
        if getattr(flywheel, key) is None
    ]
    if lengths:
        yield f"Rim: {', '.join(lengths)} ({SOLO12.name}'s x {scale.rim:.3g})."
    if flywheel.wheel_mass_max is None:
        mass = format_quantity(envelope.mass_max, "g", 3)
        yield f"Rim mass: at most {mass}, {RIM_MASS_SHARE:.0%} of the robot's."


def _without_motor(
    specification: Specification, requirement: Requirement, envelope: Envelope, chosen: Material
) -> Iterator[str]:
    if specification.flywheel.web is None:
        yield "Web: a thin disc of aluminium with a hub joins each rim to its motor."
    if specification.flywheel.material in {None, AUTO}:
        yield f"Material: {chosen.name}, {chosen.density:g} kg/m3."
    yield from _assumed_strength(specification.flywheel, envelope, chosen)
    if specification.requirement.wheel_speed_max is None:
        speed = format_quantity(requirement.wheel_speed_max, "rpm")
        yield f"Wheel speed: at most {speed}, that of {SOLO12.name}'s own motor at 24 V."
    if specification.motor.torque_max is None:
        yield "Motor torque: not limited."


def _choosing(
    specification: Specification, envelope: Envelope, choice: MotorChoice
) -> Iterator[str]:
    stated = specification.motor
    if stated.bus_voltage is None:
        which = "up to" if choice.bus_voltage == BUS_VOLTAGES[0] else "above"
        yield f"Bus: {choice.bus_voltage:g} V, as robots {which} {LIGHT_ROBOT:g} kg have."
    if stated.name in {None, AUTO}:
        # Those whose figures suffice; a gear asks for more of them, never for less.
        known = sum(not missing_figures(motor, DIRECT) for motor in choice.motors)
        yield f"Motor: the lightest device of {known} motors in the catalogue."
    if stated.gear in {None, AUTO}:
        yield f"Gear: none, or one of {len(choice.gears) - 1} stages in the catalogue."
    if specification.flywheel.web is None:
        yield "Web: a thin disc of aluminium with a hub joins each rim to its motor."
    yield from _assumed_cuts(specification.flywheel)
    if specification.flywheel.material in {None, AUTO}:
        yield f"Material: one of {len(choice.materials)} whose strength is known."
    yield from _assumed_strength(specification.flywheel, envelope, choice.materials[0])
    yield (
        f"Reserve: a design uses {RESERVE:.0%} of voltage and current; the rest is the feedback's."
    )


def _assumed_cuts(flywheel: FlywheelSection) -> Iterator[str]:
    """Of wheels with a web."""
    if flywheel.web == NO_WEB:
        return
    if flywheel.chamfer is None:
        yield f"Edges: broken by {format_quantity(CHAMFER, 'mm')}."
    if flywheel.balancing_holes:
        across = flywheel.balancing_hole_diameter or BALANCING_DIAMETER
        deep = flywheel.balancing_hole_depth or BALANCING_DEPTH
        size = f"{format_quantity(across, 'mm')} wide, {format_quantity(deep, 'mm')} deep"
        yield f"Balancing holes: {flywheel.balancing_holes} in each face, {size}."


def _assumed_strength(
    flywheel: FlywheelSection, envelope: Envelope, chosen: Material
) -> Iterator[str]:
    if chosen.yield_strength is None:
        yield f"Stress: not checked, for no strength of {chosen.name} is known."
    elif flywheel.stress_safety is None:
        yield f"Stress: yield strength over hoop stress at least {envelope.stress_safety:g}."
