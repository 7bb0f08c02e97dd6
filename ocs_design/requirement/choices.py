"""Candidate motors, gears and materials of the selection, as specified."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from types import MappingProxyType

from ocs_design.actuation.controllers import controller_mass_of
from ocs_design.actuation.motor import DIRECT, Gear, Motor, build_gaps
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.gears import gears, named_stages, stages
from ocs_design.catalogue.materials import Material, material, strong_materials
from ocs_design.catalogue.motors import implausible_values, load_motors, motor, motors
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.device_sections import MotorSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.values import names_in
from ocs_design.requirement.vocabulary import AUTO, NO_CONTROLLERS, NO_MOTOR, STEEL
from ocs_design.robot.robot import Robot

BUS_VOLTAGES: Mapping[float, float] = MappingProxyType({20.0: 24.0, 60.0: 48.0, inf: 72.0})
"""Default bus voltage [V], by the mass of the heaviest robot that has it [kg].

24 V, six cells of lithium polymer: Solo12, A1, Go2. 48 V: ANYmal; Unitree's B2, 60 kg, has 50.4 V
(docs.westonrobot.com/robot_user_guide/unitree/b2.html). 72 V, twenty cells, for heavier robots:
an assumption."""

POWER_PER_MASS = 400.0
"""Default supply power over the robot's mass [W/kg]: a lithium-polymer pack, sold at 4 kW/kg, that
makes up a tenth of the robot's mass."""


@dataclass(frozen=True, eq=False)
class MotorChoice:
    """Motors, gears and materials to choose from, and the supply of the motors.

    Attributes:
        motors, gears, materials: the candidates.
        supply: of all motors.
        wheel_speed_max: specified highest speed of a wheel [rad/s]; None: the drive's own limit.
        torque_max: specified largest torque of a wheel [N m]; inf: no limit; also set in the gears.
    """

    motors: tuple[Motor, ...]
    gears: tuple[Gear, ...]
    materials: tuple[Material, ...]
    supply: Supply
    wheel_speed_max: float | None
    torque_max: float

    @property
    def direct(self) -> Gear:
        """No gear, with the specified torque limit."""
        return replace(DIRECT, torque_max=self.torque_max)


def motor_choice(specification: Specification, robot: Robot) -> MotorChoice | None:
    """Candidates for the selection; None if the specification wants no motor.

    Raises:
        SpecificationError: a name is in no catalogue, a file cannot be read, or no motor can be
            built with; see `unknown_names`.
    """
    specified = specification.motor
    if specified.name == NO_MOTOR:
        return None
    limit, supply = specified.torque_max or inf, specified_supply(specification, robot)
    offered = _motors(specification, supply.voltage)
    named = specification.flywheel.material or STEEL
    return MotorChoice(
        motors=tuple(_with_controller(candidate, specification) for candidate in offered),
        gears=tuple(
            replace(stage, torque_max=min(stage.torque_max, limit))
            for stage in _gears(specification)
        ),
        # Groups include only materials whose stress can be checked.
        materials=strong_materials(steel=named == STEEL)
        if named in {STEEL, AUTO}
        else (material(named),),
        supply=supply,
        wheel_speed_max=specification.requirement.wheel_speed_max,
        torque_max=limit,
    )


def default_supply(robot: Robot) -> Supply:
    """Default supply of a robot of this mass: `BUS_VOLTAGES`, `POWER_PER_MASS`."""
    voltage = next(usual for most, usual in BUS_VOLTAGES.items() if robot.mass <= most)
    return Supply(voltage, power_max=POWER_PER_MASS * robot.mass)


def specified_supply(specification: Specification, robot: Robot) -> Supply:
    """The supply, with the defaults where nothing is specified."""
    specified, default = specification.supply, default_supply(robot)
    return Supply(
        specified.voltage or default.voltage,
        specified.current_max or default.current_max,
        specified.power_max or default.power_max,
    )


def _with_controller(motor: Motor, specification: Specification) -> Motor:
    """The motor with its controller's mass, specified or estimated from its current."""
    specified = specification.supply.controllers
    if specified == NO_CONTROLLERS:
        return motor
    return replace(
        motor,
        controller_mass=specified if isinstance(specified, float) else controller_mass_of(motor),
    )


def unknown_names(specification: Specification) -> Iterator[str]:
    """Requested motors and gears that are in no catalogue, and files that cannot be read.

    One line each.

    Raises:
        SpecificationError: a catalogue file has faults.
    """
    specified = specification.motor
    # If no motor is named, the fault is in the file: no motors, or none to build with.
    names = "motor.motors" if specified.name in {None, AUTO} else "motor.name"
    choices: tuple[tuple[str, Callable[[], object], str, Callable[[], object]], ...] = (
        (
            "motor.motors",
            lambda: motors(_path(specified.motors)),
            names,
            lambda: _motors(specification),
        ),
        (
            "motor.gears",
            lambda: gears(_path(specified.gears)),
            "motor.gear",
            lambda: _gears(specification),
        ),
    )
    for file, read, name, choose in choices:
        path = file
        try:
            read()
            path = name
            choose()
        except SpecificationError as error:
            if error.problems:
                raise
            yield f"{path}: {error.sentence}"


def _motors(specification: Specification, voltage: float = 0.0) -> tuple[Motor, ...]:
    """Candidate motors: all that are named, else those that can be built with at this supply [V].

    Raises:
        SpecificationError: a name is in no list, no motor can be built with, or none of these is
            rated for the supply.
    """
    specified = specification.motor
    file = _path(specified.motors)
    if specified.name not in {None, AUTO, NO_MOTOR}:
        known = motors(file)
        names = dict.fromkeys(names_in(specified.name or ""))
        if keywords := [word for word in (AUTO, NO_MOTOR) if word in names]:
            raise SpecificationError(
                f"{keywords[0]!r} cannot be combined with names of motors",
                hint=f"Leave out {keywords[0]!r}, or the motors.",
            )
        return tuple(motor(name, known) for name in names)
    only_own = file is not None and not specified.with_catalogue
    available = tuple((load_motors(file) if only_own and file else motors(file)).values())
    if not available:
        raise SpecificationError(
            f"{file} has no motors", hint="`ocs-design catalogue motors` shows what a row has"
        )
    if specified.any:
        return available
    complete = tuple(motor for motor in available if not build_gaps(motor))
    if not complete:
        missing = [
            f"{candidate.name} lacks {', '.join(build_gaps(candidate))}" for candidate in available
        ]
        raise SpecificationError(
            "every motor lacks data needed to build: " + "; ".join(missing[:MOTORS_NAMED]),
            hint="Fill in the data, name the motor with --motor, or allow incomplete motors with "
            "--motors-any",
        )
    rated = tuple(motor for motor in complete if _highest_voltage(motor) >= voltage)
    if not rated:
        highest = max(complete, key=_highest_voltage)
        raise SpecificationError(
            f"no motor that can be built with is rated for {voltage:g} V; the closest is "
            f"{highest.name}, at {_highest_voltage(highest):g} V",
            hint="Lower --bus-voltage, or name the motor with --motor if its maker allows more",
        )
    return rated


def _highest_voltage(motor: Motor) -> float:
    """Highest supply voltage that a motor's maker allows [V]; 0: unknown."""
    return motor.voltage_max or motor.rated_voltage or 0.0


def motor_warnings(specification: Specification) -> tuple[str, ...]:
    """Warnings about the figures in the user's file of motors, one sentence each.

    Raises:
        SpecificationError: the file cannot be read, or has faults.
    """
    file, name = _path(specification.motor.motors), specification.motor.name
    return () if file is None or name == NO_MOTOR else implausible_values(file)


def highest_known_voltage(specification: Specification) -> float:
    """Highest supply voltage that the maker of any known motor allows [V]; 0: unknown."""
    known = motors(_path(specification.motor.motors)).values()
    return max(map(_highest_voltage, known), default=0.0)


MOTORS_NAMED = 3
"""Most motors whose missing data a message lists."""


def _gears(specification: Specification) -> tuple[Gear, ...]:
    specified = specification.motor
    known = gears(_path(specified.gears))
    name = specified.gear or default_gear(specified)
    if name == DIRECT.name:
        return (DIRECT,)
    return (DIRECT, *stages(known.values())) if name == AUTO else named_stages(name, known)


def default_gear(specified: MotorSection) -> str:
    """Default gear: direct drive, as no row says how a gear and a motor are fixed to each other.

    If the user supplies a file of gears, any of them is a candidate.
    """
    return DIRECT.name if specified.gears is None else AUTO


def _path(file: str | None) -> Path | None:
    return None if file is None else Path(file)
