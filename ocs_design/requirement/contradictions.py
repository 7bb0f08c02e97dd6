"""Keys of a specification that do not go together."""

from collections.abc import Iterable, Iterator

from ocs_design.requirement.maneuver import Disturbance, Flip, Maneuver
from ocs_design.requirement.specification import (
    LIGHTEST,
    NO_MOTOR,
    NO_WEB,
    FlywheelSection,
    RobotSection,
    Specification,
)

OF_WEBS = ("chamfer", "balancing_holes", "balancing_hole_diameter", "balancing_hole_depth")
"""Keys of `[flywheel]` that plain rims on massless spokes have nothing of."""

FEWEST_HOLES, MOST_HOLES = 3, 100
"""In a face: fewer leave a rim with two inertias across its axis."""


def contradictions(specification: Specification) -> tuple[str, ...]:
    """What no single key shows: keys that do not go together, one line each."""
    return (
        *_room(specification.flywheel),
        *_robot(specification.robot),
        *without_motor(specification),
        *_without_web(specification.flywheel),
        *_maneuvers(specification),
        *_flights(specification.maneuvers),
    )


def _room(flywheel: FlywheelSection) -> Iterator[str]:
    bore, radius = flywheel.r_min, flywheel.r_max
    if bore is not None and radius is not None and bore >= radius:
        yield f"flywheel.r_min: {bore:g} m must be below r_max, {radius:g} m"
    low, high = flywheel.h_min, flywheel.h_max
    if low is not None and high is not None and low > high:
        yield f"flywheel.h_min: {low:g} m must not be above h_max, {high:g} m"


def _robot(robot: RobotSection) -> Iterator[str]:
    if (robot.mass is None) != (robot.inertia is None):
        yield "robot: mass and inertia come together"
    if robot.file is not None and robot.mass is not None:
        yield "robot: state either a file or mass and inertia, not both"


def without_motor(specification: Specification) -> Iterator[str]:
    """What only a motor gives a meaning to, where none is wanted, one line each."""
    if specification.motor.name != NO_MOTOR:
        return
    for key in ("bus_voltage", "gear", "motors", "gears"):
        if getattr(specification.motor, key) is not None:
            yield f"motor.{key}: says nothing where motor.name is {NO_MOTOR!r}"
    for key in OF_WEBS:
        if getattr(specification.flywheel, key) is not None:
            yield f"flywheel.{key}: says nothing where motor.name is {NO_MOTOR!r}"
    if specification.ocs.alpha_criterion == LIGHTEST:
        yield f"ocs.alpha_criterion: {LIGHTEST!r} needs a motor: motor.name is {NO_MOTOR!r}"
    if specification.ocs.co_design:
        yield f"ocs.co_design: needs a motor: motor.name is {NO_MOTOR!r}"


def _without_web(flywheel: FlywheelSection) -> Iterator[str]:
    holes = flywheel.balancing_holes
    if holes is not None and holes != 0 and not FEWEST_HOLES <= holes <= MOST_HOLES:
        yield f"flywheel.balancing_holes: {holes} is not {FEWEST_HOLES} to {MOST_HOLES}, or 0"
    if flywheel.web != NO_WEB:
        return
    for key in OF_WEBS:
        if getattr(flywheel, key) is not None:
            yield f"flywheel.{key}: says nothing where flywheel.web is {NO_WEB!r}"


def _maneuvers(specification: Specification) -> Iterator[str]:
    if specification.maneuvers and specification.requirement.maneuvers is not None:
        yield "requirement.maneuvers: contradicts the [[maneuver]] tables"


def _flights(maneuvers: Iterable[Maneuver]) -> Iterator[str]:
    """Jumps that end before what they are for."""
    for maneuver in maneuvers:
        match maneuver:
            case Disturbance(onset=needed):
                what = "its torque starts"
            case Flip(duration=needed):
                what = "its turn ends"
            case _:
                continue
        if needed >= maneuver.flight_time:
            flight = max(maneuver.flight_time, 0.0)
            yield (
                f"maneuver.{maneuver.name}: {what} {needed:.3g} s after lift-off, "
                f"but the flight lasts {flight:.3g} s"
            )
