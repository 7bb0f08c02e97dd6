"""Electrical ratings and wiring of controllers, battery and cables."""

import math
from collections.abc import Iterator, Sequence

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.motor import TorqueConstantConvention, six_step_current
from ocs_design.common.units import rpm, significant
from ocs_design.device.device import Device
from ocs_design.device.records.flights import Margin

VOLTAGE_RESERVE = 1.2
"""Rated voltage of controllers relative to the bus voltage: a full battery is 5 % above its nominal
voltage, and braking wheels raise it by the current through its resistance."""


def controllers(motor: Drive) -> str:
    """Rating of each controller; empty if it is not known."""
    current, voltage = motor_current(motor), motor.bus_voltage
    if current is None or voltage is None:
        return ""
    # A saturated motor draws more than its k_t implies.
    more = "more than " if _saturates(motor) else ""
    kinds = TorqueConstantConvention.FOC, TorqueConstantConvention.FOC_RMS
    amplitude, effective = (current / six_step_current(1.0, kind) for kind in kinds)
    return (
        f"at least {more}{_ceil(current)} A through two lines (six-step), which field-oriented "
        f"control counts as {_ceil(amplitude)} A of amplitude or {_ceil(effective)} A rms of a "
        f"phase; rated for {_ceil(VOLTAGE_RESERVE * voltage)} V or more"
    )


def battery(motor: Drive, margins: Sequence[Margin]) -> str:
    """Current, power and energy that the battery gives and takes back; empty if unknown."""
    voltage, parts = motor.bus_voltage, []
    # The current drawn may be recorded without a direction.
    for does, ways in (("gives", ("", ", drawn")), ("takes back", (", fed back",))):
        current, power = (
            demand_of(margins, *(f"bus {what}{way}" for way in ways))
            for what in ("current", "power")
        )
        if current is not None:
            power = power or (None if voltage is None else current * voltage)
            watts = "" if power is None else f" ({_ceil(power)} W)"
            parts.append(f"{does} at least {_ceil(current)} A{watts}")
    at = "" if voltage is None else f" at {voltage:g} V"
    both = {"out": "energy from the bus", "back": "energy fed back"}
    taken = ((way, demand_of(margins, name)) for way, name in both.items())
    energies = [f"{significant(most, 3)} J {way}" for way, most in taken if most is not None]
    most = f"; a maneuver takes at most {' and '.join(energies)}" if energies else ""
    return f"{' and '.join(parts)}{at}{most}" if parts else ""


def wiring_parts(device: Device, margins: Sequence[Margin]) -> Iterator[tuple[str, int, str]]:
    """Bought parts between battery and motors: name, number, and required rating."""
    motor, count = device.motor, len(device.modules)
    current, voltage = motor_current(motor), motor.bus_voltage
    if voltage is None:
        return
    bus = _bus_current(margins)
    rated, fuse = f"{_ceil(VOLTAGE_RESERVE * voltage)} V DC or more", ""
    flows = f"rated for {rated}"
    if bus is not None:
        flows = f"{_ceil(bus)} A for the length of a maneuver; {flows}"
        usual = next((rating for rating in FUSES if rating >= bus), _ceil(bus))
        fuse = f"; the next usual rating is {usual} A"
    fastest = motor.top_speed * motor.gear_ratio
    up_to = f", up to {rpm(fastest)}" if math.isfinite(fastest) else ""
    sensor = "encoder at the motor's back with its magnet, or Hall sensors, that the controller "
    sensor += f"reads{up_to}; not needed if the motor has one"
    yield "rotor angle sensor", count, sensor
    yield "fuse with holder", 1, f"between battery and switch: {flows}{fuse}"
    yield "switch", 1, f"within reach; carries and breaks {flows}"
    yield "bus cables, two wires", 1, f"battery to controllers, short: {flows}"
    least = "" if current is None else f": each wire for {_ceil(current)} A at the torque limit"
    yield "motor cables, three wires", count, f"controller to motor{least}; plus the sensor's cable"
    set_of = f"for bus, motors and sensors: rated as their cables, for {rated}"
    yield "connectors, a set", 1, set_of
    yield "cable ties, a set", 1, "hold controllers on the feet, and wires clear of the wheels"
    measured = "attitude and rate of the trunk, which the wheel law needs in every period"
    yield "IMU", 1, f"{measured}; not needed if the robot has one"


FUSES = (10, 15, 20, 25, 30, 40, 50, 60, 70, 80, 100, 125, 150, 175, 200, 250, 300, 400, 500)
"""Standard ratings of automotive fuses [A]: ISO 8820-3 and -5."""


def wiring(device: Device, margins: Sequence[Margin]) -> Iterator[str]:
    """Wiring instructions for the builder."""
    motor, supply, count = device.motor, device.supply, len(device.modules)
    rating, gives = controllers(motor), battery(motor, margins)
    counted = "but controllers are" if motor.controller_mass > 0.0 else "nor are controllers"
    if motor.bus_voltage is None:
        return
    on_bus, which = "a controller next to the motor", "the"
    if count > 1:
        on_bus, which = f"one bus for all - {count} controllers, each next to its motor", "each"
    yield (
        f"Battery ({motor.bus_voltage:g} V) - fuse and switch - {on_bus} - three wires to {which} "
        "motor. Keep the bus short: its inductance adds to every spike."
    )
    if rating:
        yield f"Controllers, {count}: {rating}. They take torque (current) commands."
    yield from _settings(motor)
    yield (
        "design.json has the wheel law's gains and period (`control`). `ocs-design export DESIGN "
        "--formats controller` writes that law with its plans and limits in C, for the robot's "
        "computer: it needs the attitude and the rate of the trunk and the wheels' speeds in "
        "every period. validation/*.csv has torque and speed of each wheel over time, to compare "
        "with the first flights."
    )
    yield (
        "Torque is needed from standstill and through zero speed: each motor needs a sensor "
        "of its rotor's angle (an encoder at its back, or Hall sensors), or a controller that "
        "holds torque at low speed without one. The printed parts have no seat for a sensor: make "
        "sure that the motor has one, or fit it before the motor is screwed in. They have none for "
        "controllers either: tie each to the stem of its foot, clear of the wheel. Fuse, switch "
        "and battery go where the robot has room. Sensors and cables are not in the device's mass, "
        f"{counted}: add what is not to the robot's file."
    )
    if gives:
        together = f"The battery, for all motors together, {gives}"
        yield f"{together}. Choose cables and fuse for this current."
    limits = []
    if supply is not None and math.isfinite(supply.current_max):
        limits.append(f"{significant(supply.current_max, 3)} A")
    if supply is not None and math.isfinite(supply.power_max):
        limits.append(f"{significant(supply.power_max, 4)} W")
    if limits:
        bus = _bus_current(margins)
        drawn = "" if bus is None else f"; its maneuvers take up to {_ceil(bus)} A of it"
        least = "what a maneuver takes" if bus is None else f"{_ceil(bus)} A"
        yield (
            f"The design keeps all motors together within a supply of {' and '.join(limits)}, "
            f"drawn or fed back{drawn}. Where a controller limits its own bus current, set that "
            f"limit to no less than {least}, or the wheels brake too late."
        )
    yield (
        "Braking wheels feed current back. A battery takes it unless it is full or its "
        "protection opens; a bench supply does not, and the voltage then rises until something "
        "breaks. Put a brake resistor with its switch on the bus, set below the controllers' "
        "voltage limit, and never let the battery's protection cut the bus while wheels turn."
    )


def _settings(motor: Drive) -> Iterator[str]:
    """Settings of each controller; none if the motor's data are insufficient."""
    current, k_t, resistance = motor_current(motor), motor.torque_constant, motor.resistance
    if current is None or k_t is None or resistance is None:
        return
    per_amplitude = k_t * six_step_current(1.0, TorqueConstantConvention.FOC)
    fastest, idle = motor.gear_ratio * motor.top_speed, motor.no_load_current
    limits, friction = [f"{_ceil(current)} A through two lines"], ""
    if math.isfinite(fastest):
        limits.append(rpm(fastest))
    if idle:
        friction = f" Friction takes another {idle:g} A in the direction of rotation."
    yield (
        "Set each controller to torque mode, with zero torque if no command arrives for two "
        f"periods. Its values: {significant(k_t, 4)} N m/A through two lines "
        f"({significant(per_amplitude, 4)} of a phase's amplitude), {significant(resistance, 3)} "
        f"ohm between two lines (half of it a phase), limits {' and '.join(limits)}. No source "
        "gives inductance and poles: let the controller measure the former, and count the "
        f"magnets.{friction}"
    )


def _bus_current(margins: Sequence[Margin]) -> float | None:
    """Largest total current that the motors draw or feed back [A]; None: none is recorded."""
    demands = (demand_of(margins, f"bus current{way}") for way in ("", ", drawn", ", fed back"))
    return max((demand for demand in demands if demand is not None), default=None)


def demand_of(margins: Sequence[Margin], *names: str) -> float | None:
    """Demand of the first margin with one of these names, SI; None: none is recorded."""
    return next((margin.demand for margin in margins if margin.name in names), None)


def motor_current(motor: Drive) -> float | None:
    """Current through two lines at the torque limit [A]; None if its data are insufficient."""
    if motor.torque_limit is None or motor.torque_constant is None or motor.bus_voltage is None:
        return None
    # Friction in the motor takes current in addition to the wheel's torque.
    return motor.torque_limit / motor.torque_per_current + (motor.no_load_current or 0.0)


def _saturates(motor: Drive) -> bool:
    limit, starts = motor.torque_limit, motor.saturation_torque
    return starts is not None and limit is not None and limit > starts


def controller_rating(motor: Drive) -> str:
    """Current and voltage of a motor's controller; empty if its data are insufficient."""
    current = motor_current(motor)
    if current is None or motor.bus_voltage is None:
        return ""
    return (
        f"{'more than ' if _saturates(motor) else ''}{_ceil(current)} A at {motor.bus_voltage:g} V"
    )


def _ceil(figure: float) -> int:
    """Next whole number; a whole number with a rounding error stays."""
    return math.ceil(round(figure, 6))
