"""What controllers and battery have to stand."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ocs_design.actuation.drive import Drive
from ocs_design.actuation.motor import TorqueConstantConvention, six_step_current
from ocs_design.common.units import significant
from ocs_design.device.device import Device
from ocs_design.device.records.device import MarginRecord

VOLTAGE_RESERVE = 1.2
"""Rated voltage of controllers over the bus voltage: a full battery has 5 % more than its nominal
voltage, and braking wheels lift it by the current through its resistance."""


@dataclass(frozen=True)
class Electrics:
    """Ratings of controllers and battery; None is what is not known.

    Attributes:
        controllers: how many.
        voltage: of the bus [V].
        motor_current: largest through two lines of one motor (six-step) [A].
        saturates: whether the motor takes more than that, because its k_t falls off.
        drawn, fed_back: largest current of the bus, of all motors together [A].
        power_drawn, power_fed_back: likewise [W].
        energy_drawn, energy_fed_back: of the dearest maneuver [J].
        supply_current, supply_power: limits of the supply that the design keeps to [A], [W].
        counted: whether the controllers are in the device's mass.
    """

    controllers: int
    voltage: float | None
    motor_current: float | None
    saturates: bool = False
    drawn: float | None = None
    fed_back: float | None = None
    power_drawn: float | None = None
    power_fed_back: float | None = None
    energy_drawn: float | None = None
    energy_fed_back: float | None = None
    supply_current: float | None = None
    supply_power: float | None = None
    counted: bool = False

    @property
    def controller_voltage(self) -> float | None:
        """Voltage that a controller is rated for, at least [V]."""
        return None if self.voltage is None else VOLTAGE_RESERVE * self.voltage

    def controller(self) -> str:
        """Rating of each controller; empty where it is not known."""
        current, voltage = self.motor_current, self.controller_voltage
        if current is None or voltage is None:
            return ""
        more = "more than " if self.saturates else ""
        amplitude, effective = (
            current / six_step_current(1.0, kind)
            for kind in (TorqueConstantConvention.FOC, TorqueConstantConvention.FOC_RMS)
        )
        return (
            f"at least {more}{_up(current)} A through two lines (six-step), which field-oriented "
            f"control counts as {_up(amplitude)} A of amplitude or {_up(effective)} A rms of a "
            f"phase; rated for {_up(voltage)} V or more"
        )

    def battery(self) -> str:
        """What the battery gives and takes back; empty where nothing of it is known."""
        parts = [
            f"{does} at least {_up(current)} A{'' if power is None else f' ({_up(power)} W)'}"
            for does, current, power in (
                ("gives", self.drawn, self.power_drawn),
                ("takes back", self.fed_back, self.power_fed_back),
            )
            if current is not None
        ]
        at = "" if self.voltage is None else f" at {self.voltage:g} V"
        energies = [
            f"{significant(energy, 3)} J {way}"
            for way, energy in (("out", self.energy_drawn), ("back", self.energy_fed_back))
            if energy is not None
        ]
        energy = f"; a maneuver takes at most {' and '.join(energies)}" if energies else ""
        return f"{' and '.join(parts)}{at}{energy}" if parts else ""

    def sentences(self) -> Iterator[str]:
        """What to tell a builder."""
        rating, battery = self.controller(), self.battery()
        if self.voltage is None:
            return
        yield (
            f"Battery ({self.voltage:g} V) - fuse and switch - one bus for all - "
            f"{self.controllers} controllers, each next to its motor - three wires to "
            "each motor. Keep the bus short: its inductance adds to every spike."
        )
        if rating:
            yield f"Controllers, {self.controllers}: {rating}. They take torque (current) commands."
        yield (
            "design.json has the wheel law's gains and period (`control`); validation/*.csv has "
            "torque and speed of each wheel over time, to hold the first flights against."
        )
        yield (
            "Torque is asked for from standstill and through zero speed: each motor needs a sensor "
            "of its rotor's angle (an encoder at its back, or Hall sensors), or a controller that "
            "holds torque at low speed without one. No part here holds a sensor: see that the "
            "motor has one, or fit it before the motor is screwed in. Sensors and cables are not "
            f"in the device's mass, controllers {'are' if self.counted else 'are not either'}."
        )
        if battery:
            yield f"The battery, for all motors together, {battery}. Cables and fuse stand as much."
        limits = []
        if self.supply_current is not None:
            limits.append(f"{significant(self.supply_current, 3)} A")
        if self.supply_power is not None:
            limits.append(f"{significant(self.supply_power, 4)} W")
        if limits:
            yield (
                f"The design keeps to a supply of {' and '.join(limits)}, drawn or fed back: set "
                "the controllers' limits to no less, or the wheels brake too late."
            )
        yield (
            "Braking wheels feed current back. A battery takes it unless it is full or its "
            "protection opens; a bench supply does not, and the voltage then rises until something "
            "breaks. Put a brake resistor with its switch on the bus, set below the controllers' "
            "voltage limit, and never let the battery's protection cut the bus while wheels turn."
        )


def electrics(device: Device, margins: Sequence[MarginRecord]) -> Electrics:
    """Ratings from the motor's limits and, where flights were recorded, from what they asked.

    Args:
        device: whose motors are driven.
        margins: of the design; empty: not known.
    """
    motor, supply = device.motor, device.supply
    drawn = demand_of(margins, "bus current", "bus current, drawn")
    fed_back = demand_of(margins, "bus current, fed back")
    voltage = motor.bus_voltage
    return Electrics(
        controllers=len(device.modules),
        voltage=voltage,
        motor_current=motor_current(motor),
        saturates=_saturates(motor),
        drawn=drawn,
        fed_back=fed_back,
        power_drawn=demand_of(margins, "bus power", "bus power, drawn") or _times(drawn, voltage),
        power_fed_back=demand_of(margins, "bus power, fed back") or _times(fed_back, voltage),
        energy_drawn=demand_of(margins, "energy from the bus"),
        energy_fed_back=demand_of(margins, "energy fed back"),
        counted=motor.controller_mass > 0.0,
        supply_current=None if supply is None else _finite(supply.current_max),
        supply_power=None if supply is None else _finite(supply.power_max),
    )


def demand_of(margins: Sequence[MarginRecord], *names: str) -> float | None:
    """Demand of the first margin with one of these names, SI; None: none is recorded."""
    return next((each.demand for each in margins if each.name in names), None)


def motor_current(motor: Drive) -> float | None:
    """Current through two lines at the torque limit [A]; None where its data do not tell."""
    if motor.torque_limit is None or motor.torque_constant is None or motor.bus_voltage is None:
        return None
    gain = motor.gear_ratio * motor.gear_efficiency * motor.torque_constant
    # The motor's own friction takes its current on top of what turns the wheel.
    return motor.torque_limit / gain + (motor.no_load_current or 0.0)


def _saturates(motor: Drive) -> bool:
    limit, starts = motor.torque_limit, motor.saturation_torque
    return starts is not None and limit is not None and limit > starts


def controller_rating(motor: Drive) -> str:
    """Current and voltage of a motor's controller; empty where its data do not tell them."""
    current = motor_current(motor)
    if current is None or motor.bus_voltage is None:
        return ""
    return f"{'more than ' if _saturates(motor) else ''}{_up(current)} A at {motor.bus_voltage:g} V"


def _up(figure: float) -> int:
    """Next whole number; what is one but for rounding stays."""
    return math.ceil(round(figure, 6))


def _times(current: float | None, voltage: float | None) -> float | None:
    return None if current is None or voltage is None else current * voltage


def _finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None
