"""Margins of a motion: demand against capacity, and the worst of several motions."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ocs_design.actuation.drive import speed_limit
from ocs_design.common.arrays import FloatArray
from ocs_design.device.foot_hold import BEARING_MOMENT
from ocs_design.parts.joints import OVERSPEED, Margin
from ocs_design.sizing.motion import (
    Consumption,
    DrivenWheel,
    Motion,
    consumption,
    torque_constant,
)


def worst(by_scenario: Iterable[tuple[str, Iterable[Margin]]]) -> tuple[Margin, ...]:
    """The smallest margin of each kind, with the scenario that sets it, in the order they come.

    Where there is no capacity it is the largest demand.

    Args:
        by_scenario: names of maneuvers and the margins of a motion of each; a name may come twice,
            for what was planned and for what was flown.
    """
    found: dict[str, Margin] = {}
    for name, margins in by_scenario:
        for margin in margins:
            kept = found.get(margin.name)
            if kept is None or margin.strain > kept.strain:
                found[margin.name] = replace(margin, scenario=name if margin.of_motion else "")
    return tuple(found.values())


def bearing_moment(motion: Motion, axes: FloatArray, wheel: DrivenWheel) -> FloatArray:
    """Moment of the trunk on each wheel across its axis [N m], shape (n, 2).

    With a the axis, w the trunk's rate and W the wheel's speed relative to it, a rotor has the
    momentum I_t w_perp + (I_s (a w) + h W) a, whose change as seen from the world is, across a
    (Euler's equations in a frame that does not spin with the rotor; Hughes1986, Gyrostats):

        M = I_t w_dot_perp + (I_s (a w) + h W - I_t (a w)) w x a .

    Args:
        motion: of trunk and wheels.
        axes: unit spin axes in B as columns, shape (3, 2).
        wheel: either of the two.
    """
    moments = []
    for wheel_speed, axis in zip(motion.wheel_speed.T, axes.T, strict=True):
        along = motion.rate @ axis
        across = motion.acceleration - np.outer(motion.acceleration @ axis, axis)
        own = wheel.body.transverse_inertia
        excess = (wheel.axial_inertia - own) * along
        momentum = excess + wheel.spin_inertia * wheel_speed
        moment = own * across + momentum[:, None] * np.cross(motion.rate, axis)
        moments.append(np.linalg.norm(moment, axis=1))
    return np.column_stack(moments)


WHEEL_SPEED, MOTOR_SPEED, MOTOR_TORQUE = "wheel speed", "motor speed", "motor torque"
BUS_CURRENT, BUS_POWER, HOOP_STRESS = "bus current", "bus power", "hoop stress"
RMS_CURRENT = "rms current"
BRAKE_TORQUE, BRAKED_SHAFT = "brake torque", "shaft joint, braked"
FED_BACK = ", fed back"
"""Words behind the name of what goes into the bus."""

ALL_MOTORS = "all motors together, ideal inverter, friction included"


def margins(motion: Motion, axes: FloatArray, wheel: DrivenWheel) -> tuple[Margin, ...]:
    """What a motion asks of the drive, the rim, the supply and the bearings.

    Args:
        motion: of trunk and wheels, flown or a reference.
        axes: unit spin axes in B as columns, as they are in this motion, shape (3, 2).
        wheel: each of the two.

    Raises:
        OcsError: the motor lacks a figure that every drive needs.
    """
    found = [*_drive_margins(motion, wheel), *_electric_margins(consumption(motion, wheel), wheel)]
    stress = wheel.overspeed_stress
    if stress is not None:
        strength = wheel.material.yield_strength
        note = f"at {OVERSPEED:g} x the highest speed that the drive reaches"
        found.append(Margin(HOOP_STRESS, stress, strength, "Pa", note, of_motion=False))
    energy = float((0.5 * wheel.moved_inertia * np.sum(motion.wheel_speed**2, axis=1)).max())
    # No motor of the catalogue states what its bearings stand, or how far apart they are.
    moment = float(bearing_moment(motion, axes, wheel).max())
    return (
        *found,
        Margin("stored energy", energy, None, "J", "all wheels with their rotors"),
        Margin(BEARING_MOMENT, moment, None, "N m", "gyroscopic, and of the trunk's turning"),
    )


def _drive_margins(motion: Motion, wheel: DrivenWheel) -> Iterator[Margin]:
    """Current limit, voltage line and speeds (docs/theory.md, What a motor can do)."""
    line, gear = wheel.line, wheel.gear
    speed = _peak(motion.wheel_speed)
    yield Margin(WHEEL_SPEED, speed, _finite(line.speed_max), "rad/s")
    capacity = min(speed_limit(wheel.motor) or np.inf, gear.motor_speed_max)
    note = "" if wheel.motor.speed_max else "no limit stated: no-load speed at rated voltage"
    yield Margin(MOTOR_SPEED, gear.ratio * speed, _finite(capacity), "rad/s", note)
    # The motor turns against its own friction whenever it is used.
    rubbed = wheel.friction
    asked = _peak(motion.wheel_torque)
    yield Margin(
        MOTOR_TORQUE,
        asked + rubbed if asked else 0.0,
        _finite(line.torque_limit + rubbed),
        "N m",
        f"at the wheel, {rubbed:.3g} N m of friction included" if rubbed else "at the wheel",
    )
    friction = np.sign(motion.wheel_speed) * rubbed
    driven = (motion.wheel_torque + friction) / line.stall_torque
    yield Margin(
        "voltage line",
        _peak(motion.wheel_speed / line.no_load_speed + driven),
        1.0,
        "",
        f"of {wheel.bus_voltage:g} V: speed over no-load speed plus torque over stall torque",
    )


def _electric_margins(taken: Consumption, wheel: DrivenWheel) -> Iterator[Margin]:
    """Current and power of the bus against its supply, the energies, and heat of the busier motor.

    Continuous ratings are for hours and a maneuver lasts a second: a current that exceeds one is no
    fault, but asks for a pause until the mean of i^2 is back at the rating's.
    """
    supply = wheel.supply
    limits = (None, None) if supply is None else (supply.power / supply.voltage, supply.power)
    current_max, power_max = (None if each is None else _finite(each) for each in limits)
    for name, power in (("", taken.power_drawn), (FED_BACK, taken.power_fed_back)):
        note = "" if name else ALL_MOTORS
        yield Margin(BUS_CURRENT + name, power / wheel.bus_voltage, current_max, "A", note)
        yield Margin(BUS_POWER + name, power, power_max, "W")
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
    note = "cold resistance; its heat capacity is not known"
    yield Margin("winding heat", taken.heat, None, "J", note)
    mean = float(np.sqrt(taken.current_squared_time / taken.duration))
    rating = wheel.motor.continuous_torque
    if rating is None:
        yield Margin(RMS_CURRENT, mean, None, "A", "no continuous rating is stated")
        return
    continuous = rating / torque_constant(wheel)
    pause = taken.current_squared_time / continuous**2 - taken.duration
    note = f"a pause of {pause:.2g} s after each maneuver cools it"
    note = f"for {taken.duration:.2g} s; {note}" if pause > 0.0 else ""
    yield Margin(RMS_CURRENT, mean, continuous, "A", note)


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())


def _finite(limit: float | FloatArray) -> float | None:
    """None where there is no limit."""
    figure = float(limit)
    return figure if np.isfinite(figure) else None
