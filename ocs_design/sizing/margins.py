"""Margins of a motion: its demands on winding, supply, rim and bearings against their capacities.

The motor is modelled as a DC motor behind an ideal inverter, V = R i + k_t w; the bus has constant
voltage and accepts all regenerated power (docs/theory.md, Margins). Friction is the motor's no-load
current, conservatively: it adds to the power drawn and takes nothing off the power fed back.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.drive import speed_limit
from ocs_design.common.arrays import FloatArray, finite_or_none
from ocs_design.common.units import rpm
from ocs_design.device.joints import BEARING_MOMENT
from ocs_design.device.records.flights import Margin
from ocs_design.parts.joints import OVERSPEED
from ocs_design.sizing.driven_wheel import DrivenWheel
from ocs_design.sizing.trajectory.motion import Trajectory


@dataclass(frozen=True, eq=False)
class SampledMotion:
    """Motion of trunk and m wheels, linear between samples; two samples at one time are a jump.

    Attributes:
        time: [s], non-decreasing, shape (n,).
        wheel_speed: relative to the trunk [rad/s], shape (n, m).
        wheel_torque: of the motors at the wheels [N m], shape (n, m).
        rate: of the trunk in B [rad/s], shape (n, 3).
        acceleration: of the trunk in B [rad/s^2], shape (n, 3).
    """

    time: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    rate: FloatArray
    acceleration: FloatArray

    @classmethod
    def along(cls, trajectory: Trajectory) -> "SampledMotion":
        """Motion along a reference, which is linear between its samples and may jump at them."""
        samples = [
            trajectory.time,
            trajectory.wheel_speed,
            trajectory.wheel_torque,
            trajectory.rate,
            trajectory.acceleration,
        ]
        if trajectory.step_torque is None:
            return cls(*samples)
        time, speed, torque, *rest = map(_both_ends, samples)
        return cls(time, speed, trajectory.step_torque.reshape(torque.shape), *rest)

    @classmethod
    def flown(
        cls,
        time: FloatArray,
        wheel_speed: FloatArray,
        wheel_torque: FloatArray,
        rate: FloatArray,
    ) -> "SampledMotion":
        """Motion of a recorded flight, whose torque is held from each sample to the next.

        The trunk's acceleration is the mean between two samples; in a landing it is briefly larger.

        Args:
            time: [s], increasing, shape (n,), n >= 2.
            wheel_speed, wheel_torque, rate: see `SampledMotion`; the last torque is not used.
        """
        acceleration = np.diff(rate, axis=0) / np.diff(time)[:, None]
        return cls(
            _both_ends(time),
            _both_ends(wheel_speed),
            np.repeat(wheel_torque[:-1], 2, axis=0),
            _both_ends(rate),
            np.repeat(acceleration, 2, axis=0),
        )

    def between(self) -> "SampledMotion":
        """Samples with the midpoint of each interval inserted, shape (2 n - 1, ...)."""
        fields = {}
        for name, values in vars(self).items():
            fields[name] = np.repeat(values, 2, axis=0)[:-1]
            fields[name][1::2] = 0.5 * (values[:-1] + values[1:])
        return SampledMotion(**fields)


def integral(values: FloatArray, time: FloatArray) -> float:
    """Simpson's rule over intervals with midpoints: exact for functions quadratic in each.

    Values and times are those of `SampledMotion.between`, shape (2 n - 1,).
    """
    step = time[2::2] - time[:-2:2]
    return float(step @ (values[:-2:2] + 4.0 * values[1::2] + values[2::2]) / 6.0)


def _both_ends(values: FloatArray) -> FloatArray:
    """Start and end of each interval, one after the other."""
    return np.repeat(values, 2, axis=0)[1:-1]


@dataclass(frozen=True)
class Consumption:
    """Consumption over one motion; of one motor unless stated otherwise.

    Attributes:
        duration: of the motion [s].
        peak_current: of a winding [A].
        current_squared_time: integral of i^2 in the busiest motor [A^2 s].
        heat: in the winding that heats most [J]. heat_all: in all windings [J].
        gear_loss: of all gears [J].
        drawn, fed_back: energy from the bus and to it, all motors together [J].
        power_drawn, power_fed_back: largest power from the bus and to it, all motors together [W].
    """

    duration: float
    peak_current: float
    current_squared_time: float
    heat: float
    heat_all: float
    gear_loss: float
    drawn: float
    fed_back: float
    power_drawn: float
    power_fed_back: float


def consumption(motion: SampledMotion, wheel: DrivenWheel) -> Consumption:
    """Currents, heat, powers and energies of a motion with equal wheels."""
    refined = motion.between()
    current = winding_current(refined, wheel)
    squared_time = [integral(values**2, refined.time) for values in current.T]
    drawn, fed_back = bus_power(refined, wheel), -bus_power(refined, wheel, friction=False)
    # Midpoints of jumps do not exist in time.
    has_duration = np.ones(len(refined.time), dtype=bool)
    has_duration[1::2] = np.diff(motion.time) > 0.0
    loss = shaft_power(refined, wheel) - refined.wheel_torque * refined.wheel_speed
    return Consumption(
        duration=float(motion.time[-1] - motion.time[0]),
        peak_current=float(np.abs(current).max()),
        current_squared_time=max(squared_time),
        heat=wheel.resistance * max(squared_time),
        heat_all=wheel.resistance * sum(squared_time),
        gear_loss=integral(loss.sum(axis=1), refined.time),
        drawn=integral(np.maximum(drawn, 0.0), refined.time),
        fed_back=integral(np.maximum(fed_back, 0.0), refined.time),
        power_drawn=float(max(drawn[has_duration].max(), 0.0)),
        power_fed_back=float(max(fed_back[has_duration].max(), 0.0)),
    )


def winding_current(
    motion: SampledMotion, wheel: DrivenWheel, *, friction: bool = True
) -> FloatArray:
    """i = tau / (N eta k_t) [A], as in the drive's voltage line, plus I_0; shape (n, m).

    Losses of gear and bearings are counted against the motor even in braking, where they really
    help: currents and heat are conservative.
    """
    gear, torque = wheel.gear, motion.wheel_torque
    current = torque / (gear.ratio * gear.efficiency * wheel.torque_constant)
    idle = wheel.drive.no_load_current or 0.0
    if friction and idle:
        direction = np.where(torque == 0.0, np.sign(motion.wheel_speed), np.sign(torque))
        current = current + idle * direction
    return current


def shaft_power(motion: SampledMotion, wheel: DrivenWheel) -> FloatArray:
    """Power at the motors' shafts [W], shape (n, m): tau W / eta driving, eta tau W braking.

    Unlike the current, the returned energy is not conservative: a gear that loses power in one
    direction would create it in the other.
    """
    power = motion.wheel_torque * motion.wheel_speed
    efficiency = wheel.gear.efficiency
    return np.where(power > 0.0, power / efficiency, power * efficiency)


def bus_power(motion: SampledMotion, wheel: DrivenWheel, *, friction: bool = True) -> FloatArray:
    """Power of all motors together [W], shape (n,): R i^2, shaft power, and friction.

    For direct drive that is V i with V = R i + k_t w. Friction is k_t I_0 at the motor's speed.
    """
    copper = wheel.resistance * winding_current(motion, wheel, friction=friction) ** 2
    power_per_motor = copper + shaft_power(motion, wheel)
    if friction:
        motor_speed = wheel.gear.ratio * np.abs(motion.wheel_speed)
        power_per_motor = (
            power_per_motor
            + wheel.torque_constant * (wheel.drive.no_load_current or 0.0) * motor_speed
        )
    power: FloatArray = np.sum(power_per_motor, axis=1)
    return power


def worst(by_scenario: Iterable[tuple[str, Iterable[Margin]]]) -> tuple[Margin, ...]:
    """The smallest margin of each kind, with the scenario that sets it, in order of appearance.

    Without a capacity, it is the one with the largest demand.

    Args:
        by_scenario: names of maneuvers, each with the margins of a motion; a name may occur twice,
            for the planned and for the flown motion.
    """
    worst_by_name: dict[str, Margin] = {}
    for name, margins in by_scenario:
        for margin in margins:
            known = worst_by_name.get(margin.name)
            if known is None or margin.sort_key > known.sort_key:
                # A rim's stress is that at the drive's highest speed in every scenario.
                scenario = "" if margin.name == HOOP_STRESS else name
                worst_by_name[margin.name] = replace(margin, scenario=scenario)
    return tuple(worst_by_name.values())


def bearing_moment(motion: SampledMotion, axes: FloatArray, wheel: DrivenWheel) -> FloatArray:
    """Moment of the trunk on each wheel, perpendicular to its axis [N m], shape (n, m).

    With a the axis, w the trunk's rate and W the wheel's speed relative to it, a rotor has the
    momentum I_t w_perp + (I_s (a w) + h W) a, whose inertial derivative perpendicular to a is
    (Euler's equations in a frame that does not spin with the rotor; Hughes1986, Gyrostats):

        M = I_t w_dot_perp + (I_s (a w) + h W - I_t (a w)) w x a .

    `axes`: unit spin axes in B as columns, shape (3, m).
    """
    moments = []
    for wheel_speed, axis in zip(motion.wheel_speed.T, axes.T, strict=True):
        along = motion.rate @ axis
        across = motion.acceleration - np.outer(motion.acceleration @ axis, axis)
        transverse = wheel.wheel.transverse_inertia
        excess = (wheel.wheel.axial_inertia + wheel.rotor_inertia - transverse) * along
        momentum = excess + wheel.flywheel.spin_inertia * wheel_speed
        moment = transverse * across + momentum[:, None] * np.cross(motion.rate, axis)
        moments.append(np.linalg.norm(moment, axis=1))
    return np.column_stack(moments)


WHEEL_SPEED, MOTOR_SPEED, MOTOR_TORQUE = "wheel speed", "motor speed", "motor torque"
BUS_CURRENT, BUS_POWER, HOOP_STRESS = "bus current", "bus power", "hoop stress"
RMS_CURRENT = "rms current"
BRAKE_TORQUE = "brake torque"
BRAKED_SHAFT, BRAKED_RIM = "shaft joint, braked", "rim joint, braked"
FED_BACK = ", fed back"
"""Suffix of the names of margins on power fed into the bus."""

ALL_MOTORS = "all motors together, ideal inverter, friction included"


def margins(motion: SampledMotion, axes: FloatArray, wheel: DrivenWheel) -> tuple[Margin, ...]:
    """Margins of drive, rim, supply and bearings for one motion, flown or planned.

    `axes`: unit spin axes in B in this motion, as columns, shape (3, m).
    """
    margins_found = [
        *_drive_margins(motion, wheel),
        *_electric_margins(consumption(motion, wheel), wheel),
    ]
    stress = wheel.overspeed_stress
    if stress is not None:
        strength = wheel.material.yield_strength
        note = f"at {OVERSPEED:g} x the highest speed that the drive reaches"
        margins_found.append(Margin(HOOP_STRESS, stress, strength, "Pa", note=note))
    driven_inertia = wheel.flywheel.spin_inertia + wheel.drive.armature
    energy = float((0.5 * driven_inertia * np.sum(motion.wheel_speed**2, axis=1)).max())
    # No data sheet in the catalogue gives the load rating or the spacing of the bearings.
    moment = float(bearing_moment(motion, axes, wheel).max())
    return (
        *margins_found,
        Margin("stored energy", energy, None, "J", note="all wheels with their rotors"),
        Margin(BEARING_MOMENT, moment, None, "N m", note="gyroscopic, and accelerating the trunk"),
    )


def _drive_margins(motion: SampledMotion, wheel: DrivenWheel) -> Iterator[Margin]:
    """Current limit, voltage line and speeds (docs/theory.md, What a motor can do)."""
    line, gear = wheel.line, wheel.gear
    speed = _peak(motion.wheel_speed)
    speed_note = ""
    if line.no_load_speed < line.speed_max < np.inf:
        speed_note = (
            f"the most allowed; at {wheel.supply.voltage:g} V the drive reaches "
            f"{rpm(float(line.no_load_speed))}, see voltage line"
        )
    yield Margin(WHEEL_SPEED, speed, finite_or_none(line.speed_max), "rad/s", note=speed_note)
    motor_limit = speed_limit(wheel.motor) or np.inf
    capacity, note = min(motor_limit, gear.motor_speed_max), ""
    if gear.motor_speed_max < motor_limit:
        note = "the gear's limit"
    elif wheel.motor.speed_max is None:
        note = "no limit stated: no-load speed at rated voltage"
    yield Margin(MOTOR_SPEED, gear.ratio * speed, finite_or_none(capacity), "rad/s", note=note)
    # A motor in use also works against its own friction.
    friction_torque = wheel.drive.friction
    torque = _peak(motion.wheel_torque)
    yield Margin(
        MOTOR_TORQUE,
        torque + friction_torque if torque else 0.0,
        finite_or_none(line.torque_limit + friction_torque),
        "N m",
        note=f"at the wheel, {friction_torque:.3g} N m of friction included"
        if friction_torque
        else "at the wheel",
    )
    friction = np.sign(motion.wheel_speed) * friction_torque
    driven = (motion.wheel_torque + friction) / line.stall_torque
    yield Margin(
        "voltage line",
        _peak(motion.wheel_speed / line.no_load_speed + driven),
        1.0,
        "",
        note=f"share of {wheel.supply.voltage:g} V: speed over no-load speed plus torque over "
        "stall torque",
    )


def _electric_margins(used: Consumption, wheel: DrivenWheel) -> Iterator[Margin]:
    """Bus current and power against the supply's limits, energies, and heat of the busiest motor.

    Continuous ratings are for hours and a maneuver lasts a second: exceeding one is not a fault,
    but requires a pause until the mean of i^2 is back at the rating's.
    """
    supply = wheel.supply.explicit
    current_max = finite_or_none(supply.power / supply.voltage)
    power_max = finite_or_none(supply.power)
    for name, power in (("", used.power_drawn), (FED_BACK, used.power_fed_back)):
        note = "" if name else ALL_MOTORS
        yield Margin(BUS_CURRENT + name, power / supply.voltage, current_max, "A", note=note)
        yield Margin(BUS_POWER + name, power, power_max, "W")
    yield Margin(
        "energy from the bus",
        used.drawn,
        None,
        "J",
        note=f"of which {used.heat_all:.3g} J heat the windings",
    )
    yield Margin(
        "energy fed back",
        used.fed_back,
        None,
        "J",
        note="braking, if the inverter lets it through",
    )
    note = "of one motor at its cold resistance; the winding's heat capacity is not known"
    yield Margin("winding heat", used.heat, None, "J", note=note)
    mean = float(np.sqrt(used.current_squared_time / used.duration))
    rating = wheel.motor.continuous_torque
    if rating is None:
        yield Margin(RMS_CURRENT, mean, None, "A", note="no continuous rating is stated")
        return
    continuous = rating / wheel.torque_constant
    pause = used.current_squared_time / continuous**2 - used.duration
    note = f"a pause of {pause:.2g} s after each maneuver cools it"
    note = f"for {used.duration:.2g} s; {note}" if pause > 0.0 else ""
    yield Margin(RMS_CURRENT, mean, continuous, "A", note=note)


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())
