"""Checks for keys of a specification that contradict each other, or do not fit the robot."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import cycle
from math import inf

from ocs_design.actuation.motor import DIRECT
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.catalogue.materials import material
from ocs_design.common.errors import OcsError, SpecificationError
from ocs_design.common.units import format_quantity
from ocs_design.requirement.choices import highest_known_voltage, unknown_names
from ocs_design.requirement.device_sections import Envelope, FlywheelSection
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.sections import TURNS, WORDS
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import (
    ALL_LAYOUTS,
    ALUMINIUM_WEB,
    AUTO,
    LIGHTENINGS,
    LIGHTEST,
    MORE_PAIRS,
    NO_MOTOR,
    NO_WEB,
    PAIR,
    PYRAMID,
    RING,
    STEEL,
    WHEELS,
    is_whole_steps,
)
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import LANDING_TOLERANCE

WEB_KEYS = (
    "lightening",
    "chamfer",
    "balancing_holes",
    "balancing_hole_diameter",
    "balancing_hole_depth",
)
"""Keys of `[flywheel]` that do not apply to rims on massless spokes."""

FEWEST_HOLES, MOST_HOLES = 3, 100
"""Balancing holes in a face: fewer make the inertia across the axis depend on direction."""


def contradictions(specification: Specification) -> Iterator[str]:
    """Keys that contradict each other, one line each."""
    flywheel, robot = specification.flywheel, specification.robot
    yield from _contradictory_limits(flywheel, vars(flywheel))
    if (robot.mass is None) != (robot.inertia is None):
        yield "robot: give both mass and inertia, or neither"
    if robot.file is not None and robot.mass is not None:
        yield "robot: give either a file or mass and inertia, not both"
    if robot.human is not None and (robot.file is not None or robot.mass is not None):
        yield "robot: give either human, or a file, or mass and inertia"

    yield from _needing_motor(specification)
    yield from _layout_contradictions(specification)
    holes = flywheel.balancing_holes
    if holes is not None and holes != 0 and not FEWEST_HOLES <= holes <= MOST_HOLES:
        yield f"flywheel.balancing_holes: {holes} is not {FEWEST_HOLES} to {MOST_HOLES}, or 0"
    if flywheel.lightening is not None and flywheel.lightening not in LIGHTENINGS:
        some = ", ".join(map(str, LIGHTENINGS))
        yield f"flywheel.lightening: {flywheel.lightening} is not one of {some}"
    if flywheel.lightening and flywheel.web == ALUMINIUM_WEB:
        yield (
            f"flywheel.lightening: an {ALUMINIUM_WEB} web has no holes, because the shrunk-on rim "
            "compresses it"
        )
    if specification.ocs.wheel == RING:
        no_web = "a ring around the motor's bell has no web (ocs.wheel)"
        yield from _without_effect(specification, "flywheel", ("web", "lightening"), no_web)
        if specification.motor.gear not in {None, DIRECT.name}:
            yield "motor.gear: a ring turns with the motor's bell, without a gear (ocs.wheel)"
        if specification.ocs.co_design:
            yield "ocs.co_design: changes the bore, but the motor's bell sets it (ocs.wheel)"
    if flywheel.web == NO_WEB:
        spokes = f"has no effect where flywheel.web is {NO_WEB!r}"
        yield from _without_effect(specification, "flywheel", WEB_KEYS, spokes)

    if specification.maneuvers and specification.requirement.maneuvers is not None:
        yield "requirement.maneuvers: contradicts the [[maneuver]] tables"
    yield from _needing_gravity(specification)
    for maneuver in specification.maneuvers:
        yield from maneuver.contradictions()
    yield from _uneven_period(specification.validation.control_period)


def _uneven_period(period: float | None) -> Iterator[str]:
    """A control period that flights cannot keep, as one line."""
    if period is not None and not is_whole_steps(period):
        given = format_quantity(period, "ms", 12)
        yield f"validation.control_period: {given} is not a whole number of milliseconds"


def _without_effect(
    specification: Specification, table: str, keys: Iterable[str], why: str
) -> Iterator[str]:
    """Keys of a section that are specified but have no effect, one line each."""
    section = getattr(specification, table)
    return (f"{table}.{key}: {why}" for key in keys if getattr(section, key) is not None)


def _contradictory_limits(
    specified: FlywheelSection, limits: Mapping[str, float | None]
) -> Iterator[str]:
    """Limits of a rim, specified or default, that leave no space between them."""

    def limit(key: str) -> str:
        """Key and figure, with a note if it is a default."""
        note = " (default: set it too)" if getattr(specified, key) is None else ""
        return f"{key}, {format_quantity(limits[key] or 0.0, 'mm')}{note}"

    bore, radius = limits["r_min"], limits["r_max"]
    if bore is not None and radius is not None and bore >= radius:
        yield f"flywheel: {limit('r_max')}, leaves no room above {limit('r_min')}"
    low, high = limits["h_min"], limits["h_max"]
    if low is not None and high is not None and low > high:
        yield f"flywheel: {limit('h_max')}, is below {limit('h_min')}"


def _needing_gravity(specification: Specification) -> Iterator[str]:
    """Jumps and falls in orbit, and turns without a time, requested in words, one line each."""
    requirement = specification.requirement
    if requirement.gravity == 0.0:
        falling = [word for word in WORDS if word not in TURNS and getattr(requirement, word)]
        if specification.takes_default_maneuvers:
            falling.append("maneuvers")
        for word in falling:
            yield f"requirement.{word}: nothing jumps or falls in orbit: use a turn or a catch"
        if any(
            turn.duration is None for word in TURNS for turn in getattr(requirement, word) or ()
        ):
            yield "requirement: in orbit a turn needs a time: 'yaw 90deg in 60s'"


def _layout_contradictions(specification: Specification) -> Iterator[str]:
    """Faulty axes or positions, and keys of pairs for other layouts, one line each."""
    specified = specification.ocs
    places = 1 if specified.layout in {None, PAIR, ALL_LAYOUTS} else WHEELS[specified.layout]
    if specified.axes is not None:
        if specified.layout is not None:
            yield "ocs.axes: takes the place of ocs.layout, so leave that out"
        rows = [specified.axes[first : first + 3] for first in range(0, len(specified.axes), 3)]
        if not all(map(any, rows)):
            yield "ocs.axes: an axis of length 0 has no direction"
        places = len(rows)
    given = len(specified.position or ())
    if specified.position is not None and given != 3 * places:
        yield f"ocs.position: this layout needs {3 * places} coordinates, not {given}"
    if specified.co_design and specification.requirement.notices is not None:
        yield "ocs.co_design: plans with all wheels, but requirement.survives has one fail"
    layout = specified.layout if specified.axes is None else "by hand"
    if layout in {None, PAIR, ALL_LAYOUTS}:
        return
    pairs = layout in MORE_PAIRS
    if specified.alpha is not None and not pairs and layout != PYRAMID:
        yield f"ocs.alpha: has no effect where ocs.layout is {layout!r}"
    if specified.alpha_criterion and not pairs:
        yield f"ocs.alpha_criterion: for pairs only, but ocs.layout is {layout!r}"
    if specified.co_design:
        yield f"ocs.co_design: for a pair only, but ocs.layout is {layout!r}"
    if specification.motor.name == NO_MOTOR:
        yield f"ocs.layout: {layout!r} needs a motor, but motor.name is {NO_MOTOR!r}"
    yield from (
        f"maneuver.{maneuver.name}: only pairs can be turned to another incidence by hand, "
        f"but ocs.layout is {layout!r}"
        for maneuver in specification.maneuvers
        if maneuver.incidence is not None and not pairs
    )


def _needing_motor(specification: Specification) -> Iterator[str]:
    """Keys that need a motor although none is wanted, one line each."""
    if specification.motor.name != NO_MOTOR:
        return
    of_motors: Mapping[str, Iterable[str]] = {
        "motor": ("gear", "any", "motors", "with_catalogue", "gears"),
        "flywheel": WEB_KEYS,
        "ocs": ("guard", "wheel"),
        "supply": vars(specification.supply),
    }
    where = f"motor.name is {NO_MOTOR!r}"
    for table, keys in of_motors.items():
        yield from _without_effect(specification, table, keys, f"has no effect where {where}")
    ocs = specification.ocs
    needs = {
        f"ocs.alpha_criterion: {LIGHTEST!r}": ocs.alpha_criterion == LIGHTEST,
        "ocs.lighter_by:": ocs.lighter_by is not None,
        "requirement.survives:": specification.requirement.notices is not None,
        "ocs.co_design:": ocs.co_design,
    }
    yield from (f"{what} needs a motor, but {where}" for what, holds in needs.items() if holds)


def robot_contradictions(
    specification: Specification,
    robot: Robot,
    robot_size: float,
    requirement: Requirement,
    envelope: Envelope,
    *,
    varied: bool = False,
) -> Iterator[str]:
    """Faults of a specification that its robot reveals, one line each.

    `requirement` and `envelope` have their defaults filled in. `varied`: see `resolve`.
    """
    position = specification.ocs.position
    yield from _oversized(specification, robot, robot_size)
    specified = specification.ocs
    of_pair = specified.axes is None and specified.layout in {None, PAIR, ALL_LAYOUTS}
    if position is not None and of_pair and position[1] <= 0.0:
        yield (
            f"ocs.position: y = {format_quantity(position[1], 'mm')} is not on the left side: "
            "the left wheel needs y > 0"
        )
    yield from _contradictory_limits(specification.flywheel, envelope.by_key)
    only_maneuvers = requirement.rate_change is None and requirement.spin_inertia is None
    if only_maneuvers and not requirement.maneuvers:
        yield "requirement: nothing is required: add a maneuver, rate_change or spin_inertia"
    for maneuver in requirement.maneuvers:
        try:
            maneuver.momentum(TiltInertia.of(robot.inertia))
        except OcsError as error:
            yield error.sentence
        with_wheels = maneuver.with_wheels(direct=specified.acts_about_vertical)
        # One in a list is refused as well: a device has no ratio to a demand of zero.
        if only_maneuvers and with_wheels.zero_demand:
            zeros = with_wheels.zero_demand
            yield f"maneuver.{maneuver.name}: {zeros}, which requires nothing of the device"
        tolerance = inf if varied else LANDING_TOLERANCE
        yield from with_wheels.infeasibilities(tilting=specified.tilting, tolerance=tolerance)
        # Tables were checked before; maneuvers requested in words have their jump only now.
        yield from with_wheels.contradictions()
    yield from _implausible_supply(specification, robot)
    chosen = specification.flywheel.material
    try:
        if chosen not in {None, STEEL, AUTO}:
            material(chosen)
    except SpecificationError as error:
        yield f"flywheel.material: {error.sentence}"
    yield from unknown_names(specification)


def _oversized(specification: Specification, robot: Robot, size: float) -> Iterator[str]:
    """Lengths larger than the robot itself, as if meant in another unit, one line each."""
    for key in ("r_max", "r_min", "h_max", "h_min", "wall_min"):
        length = getattr(specification.flywheel, key)
        if length is not None and length > size:
            yield (
                f"flywheel.{key}: {length:g} m is larger than the robot ({size:.2g} m): "
                f"did you mean {length:g}mm?"
            )
    for axis, coordinate in zip(cycle("xyz"), specification.ocs.position or (), strict=False):
        if abs(coordinate) > size:
            yield (
                f"ocs.position: {axis} = {coordinate:g} m is off the robot ({size:.2g} m): "
                f"did you mean {coordinate:g}mm?"
            )
    for kick in specification.requirement.kick or ():
        if not isinstance(kick.point, str) and max(map(abs, kick.point)) > size:
            yield (
                f"requirement.kick: '{kick}' is off the robot ({size:.2g} m): a point without a "
                "unit is in metres"
            )
    pivot = specification.requirement.pivot
    # A robot may stand on a pole.
    if pivot is not None and max(map(abs, pivot.point)) > 10.0 * size:
        yield (
            f"requirement.pivot: '{pivot}' is far off the robot ({size:.2g} m): a point without a "
            "unit is in metres"
        )
    masses = {
        "flywheel.wheel_mass_max": specification.flywheel.wheel_mass_max,
        "ocs.mass_max": specification.ocs.mass_max,
        "ocs.lighter_by": specification.ocs.lighter_by,
    }
    for path, mass in masses.items():
        if mass is not None and mass > robot.mass:
            yield (
                f"{path}: {mass:g} kg is more than the robot ({robot.mass:.3g} kg): "
                f"did you mean {mass:g}g?"
            )


OVERVOLTAGE_MAX = 1.25
"""Ratio to the highest voltage of known motors; above it, the decimal point was misplaced."""

EMPTY_CELL_VOLTAGE = 3.0
"""Voltage of one empty lithium cell [V]: no robot has a lower supply."""

POWER_PER_MASS_MIN = 1.0
"""Least supply power over the robot's mass [W/kg]: with less, kilowatts were meant."""


def _implausible_supply(specification: Specification, robot: Robot) -> Iterator[str]:
    """Supply voltage or power that is implausibly high or low, one line each."""
    voltage, power = specification.supply.voltage, specification.supply.power_max
    highest = highest_known_voltage(specification)
    if voltage is not None and highest and voltage > OVERVOLTAGE_MAX * highest:
        meant = next(volts for place in range(1, 9) if (volts := voltage / 10**place) <= highest)
        yield (
            f"supply.voltage: {voltage:g} V, but no known motor takes more than {highest:g} V: "
            f"did you mean {meant:g}V?"
        )
    if voltage is not None and voltage < EMPTY_CELL_VOLTAGE:
        meant = next(
            volts for place in range(1, 99) if (volts := voltage * 10**place) > EMPTY_CELL_VOLTAGE
        )
        yield (
            f"supply.voltage: {voltage:g} V is less than one empty lithium cell: did you mean "
            f"{meant:g}V?"
        )
    if power is not None and power < POWER_PER_MASS_MIN * robot.mass:
        yield (
            f"supply.power_max: {power:g} W is less than {POWER_PER_MASS_MIN:g} W per kg of the "
            f"robot ({robot.mass:.3g} kg): did you mean {power:g}kW?"
        )
