"""What a motion takes from the winding and from the supply.

The motor is one equivalent DC motor behind an ideal inverter, V = R i + k_t w; the voltage of the
bus is constant, and it takes back whatever the motors give (docs/theory.md, Margins).
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import FIGURES_HINT
from ocs_design.exceptions import OcsError
from ocs_design.sizing.margins.driven_wheel import DrivenWheel
from ocs_design.sizing.margins.motion import Motion, integral


@dataclass(frozen=True)
class Supply:
    """Over one motion; of one motor where nothing else is said.

    Attributes:
        duration: of the motion [s].
        peak_current: of a winding [A].
        current_squared_time: integral of i^2 of the busier motor [A^2 s].
        heat: in the busier winding [J]. heat_both: in both windings [J].
        gear_loss: of both gears [J].
        drawn, fed_back: energy from the bus and to it, both motors together [J].
        peak_drawn, peak_fed_back: current from the bus and to it, both motors together [A].
    """

    duration: float
    peak_current: float
    current_squared_time: float
    heat: float
    heat_both: float
    gear_loss: float
    drawn: float
    fed_back: float
    peak_drawn: float
    peak_fed_back: float


def supply(motion: Motion, wheel: DrivenWheel) -> Supply:
    """Currents, heat and energies of a motion with two equal wheels.

    Raises:
        OcsError: the motor lacks its torque constant or its resistance.
    """
    fine = motion.between()
    current = winding_current(fine.wheel_torque, wheel)
    squared_time = [integral(values**2, fine.time) for values in current.T]
    power = bus_power(fine, wheel)
    peaks = bus_power(motion, wheel)
    loss = shaft_power(fine, wheel) - fine.wheel_torque * fine.wheel_speed
    return Supply(
        duration=motion.duration,
        peak_current=float(np.abs(current).max()),
        current_squared_time=max(squared_time),
        heat=resistance(wheel) * max(squared_time),
        heat_both=resistance(wheel) * sum(squared_time),
        gear_loss=integral(loss.sum(axis=1), fine.time),
        drawn=integral(np.maximum(power, 0.0), fine.time),
        fed_back=integral(np.maximum(-power, 0.0), fine.time),
        peak_drawn=float(max(peaks.max(), 0.0)) / wheel.bus_voltage,
        peak_fed_back=float(max(-peaks.min(), 0.0)) / wheel.bus_voltage,
    )


def winding_current(wheel_torque: FloatArray, wheel: DrivenWheel) -> FloatArray:
    """i = tau / (N eta k_t) [A], as the drive's line has it.

    The gear's loss is taken to work against the motor also where it brakes, when in truth it helps:
    currents and heat are on the safe side.
    """
    gear = wheel.gear
    return wheel_torque / (gear.ratio * gear.efficiency * torque_constant(wheel))


def shaft_power(motion: Motion, wheel: DrivenWheel) -> FloatArray:
    """At the motors' shafts [W], shape (n, 2): tau W / eta driving, eta tau W braking.

    Unlike the current, the energy that comes back is not rounded to the safe side: a gear that
    loses in the one direction would make energy in the other.
    """
    power = motion.wheel_torque * motion.wheel_speed
    efficiency = wheel.gear.efficiency
    return np.where(power > 0.0, power / efficiency, power * efficiency)


def bus_power(motion: Motion, wheel: DrivenWheel) -> FloatArray:
    """Of both motors together [W], shape (n,): the sum of R i^2 and of what the shafts take.

    For direct drive that is V i with V = R i + k_t w.
    """
    copper = resistance(wheel) * winding_current(motion.wheel_torque, wheel) ** 2
    power: FloatArray = np.sum(copper + shaft_power(motion, wheel), axis=1)
    return power


def torque_constant(wheel: DrivenWheel) -> float:
    """k_t [N m/A]."""
    return _known(wheel.motor.torque_constant, "torque constant", wheel)


def resistance(wheel: DrivenWheel) -> float:
    """Between two lines [ohm]."""
    return _known(wheel.motor.resistance, "resistance", wheel)


def _known(figure: float | None, name: str, wheel: DrivenWheel) -> float:
    if figure is None:
        raise OcsError(
            f"motor {wheel.motor.name!r}: its source does not give its {name}",
            hint=FIGURES_HINT,
        )
    return figure
