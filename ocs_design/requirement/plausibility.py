"""What a specification asks that cannot be meant, once the robot is known."""

from collections.abc import Iterator

from ocs_design.catalogue.materials import material
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.exceptions import OcsError, SpecificationError
from ocs_design.requirement.contradictions import without_motor
from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.maneuver import Drop, Flip, Maneuver, Unforeseen
from ocs_design.requirement.motor_choice import unknown_names
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.specification import AUTO, FlywheelSection, Specification
from ocs_design.robot.robot import Robot
from ocs_design.units import format_quantity


def implausible(
    specification: Specification,
    robot: Robot,
    robot_size: float,
    requirement: Requirement,
    envelope: Envelope,
) -> tuple[str, ...]:
    """Every fault, one line each; `requirement` and `envelope` have their defaults filled in."""
    return (
        *_oversized(specification, robot, robot_size),
        *_wrong_side(specification.ocs.position),
        *_empty_room(specification.flywheel, envelope),
        *_impossible(requirement, robot),
        *_unknown_material(specification.flywheel.material),
        *unknown_names(specification),
        *without_motor(specification),
    )


def _oversized(specification: Specification, robot: Robot, size: float) -> Iterator[str]:
    """Bare numbers that were meant in another unit: larger than the robot itself."""
    for key in ("r_max", "r_min", "h_max", "h_min", "wall_min"):
        length = getattr(specification.flywheel, key)
        if length is not None and length > size:
            yield (
                f"flywheel.{key}: {length:g} m is larger than the robot ({size:.2g} m): "
                f"did you mean {length:g}mm?"
            )
    for axis, coordinate in zip("xyz", specification.ocs.position or (), strict=False):
        if abs(coordinate) > size:
            yield (
                f"ocs.position: {axis} = {coordinate:g} m is off the robot ({size:.2g} m): "
                f"did you mean {coordinate:g}mm?"
            )
    mass = specification.flywheel.wheel_mass_max
    if mass is not None and mass > robot.mass:
        yield (
            f"flywheel.wheel_mass_max: {mass:g} kg is more than the robot ({robot.mass:.3g} kg): "
            f"did you mean {mass:g}g?"
        )


def _wrong_side(position: tuple[float, ...] | None) -> Iterator[str]:
    """The right wheel mirrors the left one in y."""
    if position is not None and position[1] <= 0.0:
        yield (
            f"ocs.position: y = {format_quantity(position[1], 'mm')} is not on the left side: "
            "the left wheel needs y > 0"
        )


def _empty_room(stated: FlywheelSection, envelope: Envelope) -> Iterator[str]:
    """Stated and assumed limits that leave no room between them."""
    radius, bore = envelope.outer_radius_max, envelope.inner_radius_min
    if bore >= radius:
        yield (
            f"flywheel: r_max, {format_quantity(radius, 'mm')}{_assumed(stated.r_max)}, leaves no "
            f"room over r_min, "
            f"{format_quantity(bore, 'mm')}{_assumed(stated.r_min)}"
        )
    if envelope.height_min > envelope.height_max:
        yield (
            f"flywheel: h_max, {format_quantity(envelope.height_max, 'mm')}"
            f"{_assumed(stated.h_max)}, is below h_min, "
            f"{format_quantity(envelope.height_min, 'mm')}{_assumed(stated.h_min)}"
        )


def _assumed(stated: float | None) -> str:
    """Behind the figure of a limit that the user may not know of."""
    return " (assumed: state it too)" if stated is None else ""


def _impossible(requirement: Requirement, robot: Robot) -> Iterator[str]:
    """Maneuvers that this robot cannot be asked for, or nothing asked at all."""
    for maneuver in requirement.maneuvers:
        try:
            maneuver.momentum(TiltInertia.of(robot.inertia), requirement.standing_height)
        except OcsError as error:
            yield error.message
    if requirement.rate_change is not None or requirement.spin_inertia is not None:
        return
    if not requirement.maneuvers:
        yield "requirement: nothing is asked for: state a maneuver, rate_change or spin_inertia"
    idle = {maneuver.name: _zeros(maneuver) for maneuver in requirement.maneuvers}
    if all(idle.values()):
        for name, zeros in idle.items():
            yield f"maneuver.{name}: {zeros}: this asks nothing of the device"


def _zeros(maneuver: Maneuver) -> str:
    """Which keys are zero, so that nothing is asked; empty: something is. Yaw never is."""
    match maneuver:
        case Drop(roll=0.0, pitch=0.0):
            return "roll and pitch are 0"
        case Flip(angle=0.0):
            return "angle is 0"
        case Unforeseen(torque=(0.0, 0.0, _)):
            return "torque about roll and pitch is 0"
        case _:
            return ""


def _unknown_material(name: str | None) -> Iterator[str]:
    try:
        if name not in {None, AUTO}:
            material(name)
    except SpecificationError as error:
        yield f"flywheel.material: {error.message}. {error.hint}"
