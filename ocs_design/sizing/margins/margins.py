"""Every margin of one motion."""

from collections.abc import Iterator

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import speed_limit
from ocs_design.sizing.margins.bearings import bearing_moment
from ocs_design.sizing.margins.driven_wheel import DrivenWheel
from ocs_design.sizing.margins.margin import Margin
from ocs_design.sizing.margins.motion import Motion
from ocs_design.sizing.margins.supply import Supply, supply, torque_constant
from ocs_design.sizing.selection.drive_table import OVERSPEED

HOOP_STRESS = "hoop stress, to yield"

NO_SUPPLY = "both motors together, ideal inverter; no limit of the supply is known"


def margins(motion: Motion, axes: FloatArray, wheel: DrivenWheel) -> tuple[Margin, ...]:
    """What a motion asks of the drive, the rim, the supply and the bearings.

    Args:
        motion: of trunk and wheels, flown or a reference.
        axes: unit spin axes in B as columns, as they are in this motion, shape (3, 2).
        wheel: each of the two.

    Raises:
        OcsError: the motor lacks a figure that every drive needs.
    """
    taken = supply(motion, wheel)
    return (
        *_drive(motion, wheel),
        *_rim(motion, wheel),
        *_supply(taken),
        *_heat(taken, wheel),
        *_bearings(motion, axes, wheel),
    )


def _drive(motion: Motion, wheel: DrivenWheel) -> Iterator[Margin]:
    """Current limit, voltage line and speeds (docs/theory.md, What a motor can do)."""
    line, gear = wheel.line, wheel.gear
    torque, speed = _peak(motion.wheel_torque), _peak(motion.wheel_speed)
    no_load = float(line.no_load_speed)
    yield Margin("torque, to the current limit", torque, _finite(line.torque_limit), "N m")
    share = _peak(motion.wheel_speed / no_load + motion.wheel_torque / line.stall_torque)
    yield Margin(
        "voltage line",
        share,
        1.0,
        "",
        f"of {wheel.bus_voltage:g} V: speed over no-load speed plus torque over stall torque",
    )
    yield Margin("wheel speed, to no load", speed, no_load, "rad/s")
    yield Margin("wheel speed, mechanical", speed, _finite(line.speed_max), "rad/s")
    capacity = min(speed_limit(wheel.motor) or np.inf, gear.motor_speed_max)
    yield Margin("motor speed", gear.ratio * speed, _finite(capacity), "rad/s", _unstated(wheel))


def _rim(motion: Motion, wheel: DrivenWheel) -> Iterator[Margin]:
    """Stress if the motor runs away, and the energy in both wheels and rotors."""
    stress = wheel.overspeed_stress
    if stress is not None:
        strength = wheel.material.yield_strength
        note = f"at {OVERSPEED:g} x the highest speed that the drive reaches"
        yield Margin(HOOP_STRESS, stress, strength, "Pa", note, of_motion=False)
    energy = 0.5 * wheel.moved_inertia * np.sum(motion.wheel_speed**2, axis=1)
    yield Margin("stored energy", float(energy.max()), None, "J", "both wheels with their rotors")


def _supply(taken: Supply) -> Iterator[Margin]:
    yield Margin("bus current", taken.peak_drawn, None, "A", NO_SUPPLY)
    yield Margin("bus current, fed back", taken.peak_fed_back, None, "A")
    yield Margin(
        "energy from the bus",
        taken.drawn,
        None,
        "J",
        f"heat in the windings {taken.heat_both:.3g} J",
    )
    yield Margin(
        "energy fed back", taken.fed_back, None, "J", "braking, if the inverter lets it through"
    )


def _heat(taken: Supply, wheel: DrivenWheel) -> Iterator[Margin]:
    """i^2 t of the busier motor against the current that it stands for good.

    Continuous ratings are for hours and a maneuver lasts a second: what exceeds one is no fault,
    but asks for a pause until the mean of i^2 is back at the rating's.
    """
    yield Margin(
        "heat in a winding",
        taken.heat,
        None,
        "J",
        "cold resistance; its heat capacity is not known",
    )
    mean = float(np.sqrt(taken.current_squared_time / taken.duration))
    rating = wheel.motor.continuous_torque
    if rating is None:
        yield Margin("rms current", mean, None, "A", "no continuous rating is stated")
        return
    continuous = rating / torque_constant(wheel)
    pause = taken.current_squared_time / continuous**2 - taken.duration
    note = f"a pause of {pause:.2g} s after each maneuver cools it" if pause > 0.0 else ""
    yield Margin("rms current", mean, continuous, "A", note)


def _bearings(motion: Motion, axes: FloatArray, wheel: DrivenWheel) -> Iterator[Margin]:
    """No motor of the catalogue states what its bearings stand, or how far apart they are."""
    moment = float(bearing_moment(motion, axes, wheel).max())
    yield Margin("bearing moment", moment, None, "N m", "gyroscopic; shocks of landing left out")


def _unstated(wheel: DrivenWheel) -> str:
    return "" if wheel.motor.speed_max else "no limit stated: no-load speed at rated voltage"


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())


def _finite(limit: float | FloatArray) -> float | None:
    """None where there is no limit."""
    figure = float(limit)
    return figure if np.isfinite(figure) else None
