"""From what was stated to what is designed for: fills defaults, says what it assumed."""

from dataclasses import dataclass

from ocs_design.catalogue.materials import DEFAULT_MATERIAL, Material, material
from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.assumptions import assumptions
from ocs_design.requirement.envelope import LIMIT_OF_KEY, Envelope
from ocs_design.requirement.froude import (
    WHEEL_SPEED_MAX,
    default_envelope,
    default_maneuvers,
    standing_height,
)
from ocs_design.requirement.maneuver import STANDARD_GRAVITY, Maneuver
from ocs_design.requirement.motor_choice import MotorChoice, motor_choice
from ocs_design.requirement.plausibility import implausible
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.specification import AUTO, FlywheelSection, Specification
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class Resolved:
    """A specification with nothing left open.

    Attributes:
        requirement: what the wheels must do.
        envelope: the room for a rim.
        material: of a rim.
        torque_max: of a wheel [N m]; None: not limited.
        choice: of motors, gears and materials; None: no motor is wanted, and `material` holds.
        assumptions: what was not stated and what holds in its place, one sentence each.
    """

    requirement: Requirement
    envelope: Envelope
    material: Material
    torque_max: float | None
    choice: MotorChoice | None
    assumptions: tuple[str, ...]


def resolve(specification: Specification, robot: Robot, robot_size: float) -> Resolved:
    """What to design for, with the defaults of `froude` where nothing is stated.

    Args:
        specification: file and options merged.
        robot: to scale defaults to.
        robot_size: largest extent of the robot [m]; nothing of the device may be larger.

    Raises:
        SpecificationError: keys that contradict each other or the robot; all are listed.
    """
    envelope = _envelope(specification.flywheel, robot)
    requirement = _requirement(specification, robot)
    faults = implausible(specification, robot, robot_size, requirement, envelope)
    if faults:
        raise SpecificationError(f"the specification does not fit {robot.name}:", problems=faults)
    choice = motor_choice(specification, robot)
    chosen = _material(specification.flywheel.material)
    return Resolved(
        requirement=requirement,
        envelope=envelope,
        material=chosen,
        torque_max=specification.motor.torque_max,
        choice=choice,
        assumptions=assumptions(
            specification, robot, requirement, envelope, chosen=chosen, choice=choice
        ),
    )


def _material(name: str | None) -> Material:
    """Where no motor is chosen nothing but the rim weighs anything, and the default will do."""
    return material(DEFAULT_MATERIAL if name in {None, AUTO} else name)


def _envelope(flywheel: FlywheelSection, robot: Robot) -> Envelope:
    default = default_envelope(robot)
    limits = {}
    for key, limit in LIMIT_OF_KEY.items():
        stated = getattr(flywheel, key)
        limits[limit] = getattr(default, limit) if stated is None else stated
    return Envelope(**limits)


def _requirement(specification: Specification, robot: Robot) -> Requirement:
    stated = specification.requirement
    return Requirement(
        maneuvers=_maneuvers(specification, robot),
        rate_change=stated.rate_change,
        wheel_speed_max=stated.wheel_speed_max or WHEEL_SPEED_MAX,
        spin_inertia=stated.spin_inertia,
        standing_height=standing_height(robot),
    )


def _maneuvers(specification: Specification, robot: Robot) -> tuple[Maneuver, ...]:
    if not specification.takes_default_maneuvers:
        return specification.maneuvers
    return default_maneuvers(robot, specification.requirement.gravity or STANDARD_GRAVITY)
