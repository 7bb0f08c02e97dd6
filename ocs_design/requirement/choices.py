"""What the selection may choose from, as a specification states it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

from ocs_design.actuation.motor import DIRECT, Gear, Motor
from ocs_design.catalogue.gears import known_gears, named_stages, stages
from ocs_design.catalogue.materials import Material, material, materials
from ocs_design.catalogue.motors import known_motors, motor
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.froude import default_bus_voltage
from ocs_design.requirement.specification import AUTO, NO_MOTOR, Specification
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class MotorChoice:
    """Motors, gears and materials to choose from, and what feeds the motors.

    Attributes:
        motors, gears, materials: the candidates.
        bus_voltage: of the supply [V].
        wheel_speed_max: specified highest speed of a wheel [rad/s]; None: what the drive can do.
    """

    motors: tuple[Motor, ...]
    gears: tuple[Gear, ...]
    materials: tuple[Material, ...]
    bus_voltage: float
    wheel_speed_max: float | None


def motor_choice(specification: Specification, robot: Robot) -> MotorChoice | None:
    """What may be chosen from; None where the specification wants no motor.

    Raises:
        SpecificationError: a name that no catalogue has, or a file that cannot be read; see
            `unknown_names`.
    """
    specified = specification.motor
    if specified.name == NO_MOTOR:
        return None
    name, limit = specification.flywheel.material, specified.torque_max or inf
    # Those whose stress can be checked.
    strong = tuple(
        found
        for found in materials().values()
        if found.yield_strength is not None and found.poisson_ratio is not None
    )
    return MotorChoice(
        motors=_motors(specification),
        gears=tuple(
            replace(stage, torque_max=min(stage.torque_max, limit))
            for stage in _gears(specification)
        ),
        materials=strong if name in {None, AUTO} else (material(name),),
        bus_voltage=specified.bus_voltage or default_bus_voltage(robot),
        wheel_speed_max=specification.requirement.wheel_speed_max,
    )


def unknown_names(specification: Specification) -> Iterator[str]:
    """Each motor and gear that is asked for and in no catalogue, one line each.

    Raises:
        SpecificationError: a catalogue file cannot be read.
    """
    choices: tuple[tuple[str, Callable[[Specification], object]], ...] = (
        ("motor.name", _motors),
        ("motor.gear", _gears),
    )
    for path, choose in choices:
        try:
            choose(specification)
        except SpecificationError as error:
            if error.problems:
                raise
            yield f"{path}: {error.message}. {error.hint}"


def _motors(specification: Specification) -> tuple[Motor, ...]:
    specified = specification.motor
    known = known_motors(_path(specified.motors))
    if specified.name in {None, AUTO, NO_MOTOR}:
        return tuple(known.values())
    return (motor(specified.name, known),)


def _gears(specification: Specification) -> tuple[Gear, ...]:
    specified = specification.motor
    known = known_gears(_path(specified.gears))
    if specified.gear in {None, AUTO}:
        return (DIRECT, *stages(known.values()))
    if specified.gear == DIRECT.name:
        return (DIRECT,)
    return named_stages(specified.gear, known)


def _path(file: str | None) -> Path | None:
    return None if file is None else Path(file)
