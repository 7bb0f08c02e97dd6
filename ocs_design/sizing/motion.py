"""Motions of trunk and wheels over time, and what they take from winding and supply.

The motor is one equivalent DC motor behind an ideal inverter, V = R i + k_t w; the voltage of the
bus is constant, and it takes back whatever the motors give (docs/theory.md, Margins). Friction is
the motor's no-load current, on the safe side: it adds to whatever is drawn, and takes nothing off
what is fed back.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy as np

from ocs_design.actuation.drive import FIGURES_HINT, DriveLine, armature, drive_line, rotor_share
from ocs_design.actuation.motor import Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import OcsError
from ocs_design.parts.joints import OVERSPEED
from ocs_design.parts.rim import NO_CUTS, Hub, RimCuts, hoop_stress, wheel_body
from ocs_design.parts.solids import Carrier
from ocs_design.sizing.selection.problem import Candidate
from ocs_design.sizing.trajectory.motion import Trajectory


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of trunk and wheels, linear between samples; two samples at one time are a jump.

    Attributes:
        time: [s], not falling, shape (n,).
        wheel_speed: relative to the trunk [rad/s], shape (n, 2).
        wheel_torque: of the motors at the wheels [N m], shape (n, 2).
        rate: of the trunk in B [rad/s], shape (n, 3).
        acceleration: of the trunk in B [rad/s^2], shape (n, 3).
    """

    time: FloatArray
    wheel_speed: FloatArray
    wheel_torque: FloatArray
    rate: FloatArray
    acceleration: FloatArray

    @classmethod
    def along(cls, trajectory: Trajectory) -> "Motion":
        """Motion along a reference, which is linear between its samples and may jump at them."""
        if trajectory.step_torque is not None:
            return cls(
                _both_ends(trajectory.time),
                _both_ends(trajectory.wheel_speed),
                trajectory.step_torque.reshape(-1, trajectory.step_torque.shape[-1]),
                _both_ends(trajectory.rate),
                _both_ends(trajectory.acceleration),
            )
        return cls(
            trajectory.time,
            trajectory.wheel_speed,
            trajectory.wheel_torque,
            trajectory.rate,
            trajectory.acceleration,
        )

    @classmethod
    def flown(
        cls,
        time: FloatArray,
        wheel_speed: FloatArray,
        wheel_torque: FloatArray,
        rate: FloatArray,
    ) -> "Motion":
        """Motion of a recorded flight, whose torque is held from each sample to the next.

        The trunk's acceleration is the mean one between two samples; a landing's is larger for
        shorter.

        Args:
            time: [s], increasing, shape (n,), n >= 2.
            wheel_speed, wheel_torque, rate: see `Motion`; the last torque is not used.
        """
        acceleration = np.diff(rate, axis=0) / np.diff(time)[:, None]
        return cls(
            _both_ends(time),
            _both_ends(wheel_speed),
            np.repeat(wheel_torque[:-1], 2, axis=0),
            _both_ends(rate),
            np.repeat(acceleration, 2, axis=0),
        )

    @property
    def duration(self) -> float:
        """Duration [s]."""
        return float(self.time[-1] - self.time[0])

    def between(self) -> "Motion":
        """Samples with the middle of each interval between them, shape (2 n - 1, ...)."""
        return Motion(
            _with_middles(self.time),
            _with_middles(self.wheel_speed),
            _with_middles(self.wheel_torque),
            _with_middles(self.rate),
            _with_middles(self.acceleration),
        )


def integral(values: FloatArray, time: FloatArray) -> float:
    """Simpson's rule over intervals with their middles: exact for what is quadratic in each.

    Args:
        values: shape (2 n - 1,).
        time: as `Motion.between` gives it, shape (2 n - 1,).
    """
    step = time[2::2] - time[:-2:2]
    return float(step @ (values[:-2:2] + 4.0 * values[1::2] + values[2::2]) / 6.0)


def _both_ends(values: FloatArray) -> FloatArray:
    """Start and end of each interval, one after the other."""
    return np.repeat(values, 2, axis=0)[1:-1]


def _with_middles(values: FloatArray) -> FloatArray:
    found = np.repeat(values, 2, axis=0)[:-1]
    found[1::2] = 0.5 * (values[:-1] + values[1:])
    return found


@dataclass(frozen=True, eq=False)
class DrivenWheel:
    """Wheel, motor, gear and supply of one module.

    Attributes:
        inner_radius, outer_radius, height: of the rim [m].
        material: of the rim.
        motor, gear: that drive it.
        bus_voltage: [V].
        wheel_speed_max: stated highest speed of the wheel [rad/s]; inf: none.
        hub: in the middle of the wheel's web; None: massless spokes.
        cuts: off the rim.
        web_material: of web and hub; None: of one piece with the rim.
        supply: of all motors; None: no limit of it is known.
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: Material
    motor: Motor
    gear: Gear
    bus_voltage: float
    wheel_speed_max: float = inf
    hub: Hub | None = None
    cuts: RimCuts = NO_CUTS
    web_material: Material | None = None
    supply: Supply | None = None

    @classmethod
    def of(
        cls, device: Candidate, supply: Supply, wheel_speed_max: float | None = None
    ) -> "DrivenWheel":
        """Wheel of a selected device, fed by a supply, up to a stated speed [rad/s]."""
        return cls(
            device.inner_radius,
            device.outer_radius,
            device.height,
            device.material,
            device.motor,
            device.gear,
            supply.voltage,
            inf if wheel_speed_max is None else wheel_speed_max,
            device.hub,
            device.cuts,
            device.web_material,
            supply,
        )

    @cached_property
    def line(self) -> DriveLine:
        """All that the motor does at the wheel, without a reserve; scalars.

        Raises:
            OcsError: the motor lacks a figure that every drive needs.
        """
        line = drive_line(self.motor, self.gear, self.bus_voltage)
        return replace(line, speed_max=min(float(line.speed_max), self.wheel_speed_max))

    @property
    def friction_current(self) -> float:
        """I_0, that the motor itself draws turning freely [A]; 0 where it is not stated."""
        return self.motor.no_load_current or 0.0

    @property
    def friction(self) -> float:
        """N eta k_t I_0, what the motor's own friction takes of the torque at the wheel [N m]."""
        return (
            self.gear.ratio * self.gear.efficiency * torque_constant(self) * self.friction_current
        )

    @property
    def body(self) -> Carrier:
        """Rim, web and hub; no source states the rotor's transverse inertia."""
        size = (self.inner_radius, self.outer_radius, self.height)
        web = None if self.web_material is None else self.web_material.density
        return wheel_body(*size, self.material.density, self.hub, cuts=self.cuts, web_density=web)

    @property
    def spin_inertia(self) -> float:
        """Momentum per wheel speed, of wheel and rotor [kg m^2]."""
        return self.body.axial_inertia + rotor_share(self._rotor_inertia, self.gear)

    @property
    def moved_inertia(self) -> float:
        """What the motor accelerates, of wheel, gear and rotor [kg m^2]."""
        return self.spin_inertia + armature(self._rotor_inertia, self.gear)

    @property
    def axial_inertia(self) -> float:
        """Axial inertia of wheel and rotor while they do not turn on the trunk [kg m^2]."""
        return self.body.axial_inertia + self._rotor_inertia

    @property
    def _rotor_inertia(self) -> float:
        """Inertia of the rotor [kg m^2]; 0 where it is not stated."""
        return self.motor.rotor_inertia or 0.0

    @property
    def wheel_speed_reached(self) -> float:
        """No-load speed at the bus voltage, or the mechanical limit if that is lower [rad/s]."""
        return min(float(self.line.no_load_speed), float(self.line.speed_max))

    @property
    def overspeed_stress(self) -> float | None:
        """Hoop stress at `OVERSPEED` times the speed reached [Pa]; None: no Poisson's ratio."""
        if self.material.poisson_ratio is None:
            return None
        return hoop_stress(
            self.inner_radius,
            self.outer_radius,
            density=self.material.density,
            poisson_ratio=self.material.poisson_ratio,
            wheel_speed=OVERSPEED * self.wheel_speed_reached,
        )


@dataclass(frozen=True)
class Consumption:
    """Consumption over one motion; of one motor where nothing else is said.

    Attributes:
        duration: of the motion [s].
        peak_current: of a winding [A].
        current_squared_time: integral of i^2 of the busier motor [A^2 s].
        heat: in the busier winding [J]. heat_both: in both windings [J].
        gear_loss: of both gears [J].
        drawn, fed_back: energy from the bus and to it, both motors together [J].
        power_drawn, power_fed_back: largest from the bus and to it, both motors together [W].
    """

    duration: float
    peak_current: float
    current_squared_time: float
    heat: float
    heat_both: float
    gear_loss: float
    drawn: float
    fed_back: float
    power_drawn: float
    power_fed_back: float


def consumption(motion: Motion, wheel: DrivenWheel) -> Consumption:
    """Currents, heat, powers and energies of a motion with two equal wheels.

    Raises:
        OcsError: the motor lacks its torque constant or its resistance.
    """
    fine = motion.between()
    current = winding_current(fine, wheel)
    squared_time = [integral(values**2, fine.time) for values in current.T]
    drawn, fed_back = bus_power(fine, wheel), -bus_power(fine, wheel, friction=False)
    # In the middle of a jump there is nothing.
    lasts = np.ones(len(fine.time), dtype=bool)
    lasts[1::2] = np.diff(motion.time) > 0.0
    loss = shaft_power(fine, wheel) - fine.wheel_torque * fine.wheel_speed
    return Consumption(
        duration=motion.duration,
        peak_current=float(np.abs(current).max()),
        current_squared_time=max(squared_time),
        heat=resistance(wheel) * max(squared_time),
        heat_both=resistance(wheel) * sum(squared_time),
        gear_loss=integral(loss.sum(axis=1), fine.time),
        drawn=integral(np.maximum(drawn, 0.0), fine.time),
        fed_back=integral(np.maximum(fed_back, 0.0), fine.time),
        power_drawn=float(max(drawn[lasts].max(), 0.0)),
        power_fed_back=float(max(fed_back[lasts].max(), 0.0)),
    )


def winding_current(motion: Motion, wheel: DrivenWheel, *, friction: bool = True) -> FloatArray:
    """i = tau / (N eta k_t) [A], as the drive's line has it, and I_0 on top; shape (n, 2).

    The losses of gear and bearings are taken to work against the motor also where it brakes, when
    in truth they help: currents and heat are on the safe side.
    """
    gear, torque = wheel.gear, motion.wheel_torque
    current = torque / (gear.ratio * gear.efficiency * torque_constant(wheel))
    if friction and wheel.friction_current:
        direction = np.where(torque == 0.0, np.sign(motion.wheel_speed), np.sign(torque))
        current = current + wheel.friction_current * direction
    return current


def shaft_power(motion: Motion, wheel: DrivenWheel) -> FloatArray:
    """Power at the motors' shafts [W], shape (n, 2): tau W / eta driving, eta tau W braking.

    Unlike the current, the energy that comes back is not rounded to the safe side: a gear that
    loses in the one direction would make energy in the other.
    """
    power = motion.wheel_torque * motion.wheel_speed
    efficiency = wheel.gear.efficiency
    return np.where(power > 0.0, power / efficiency, power * efficiency)


def bus_power(motion: Motion, wheel: DrivenWheel, *, friction: bool = True) -> FloatArray:
    """Power of all motors together [W], shape (n,): R i^2, what the shafts take, and friction.

    For direct drive that is V i with V = R i + k_t w. Friction is k_t I_0 at the motor's speed.
    """
    copper = resistance(wheel) * winding_current(motion, wheel, friction=friction) ** 2
    each = copper + shaft_power(motion, wheel)
    if friction:
        turning = wheel.gear.ratio * np.abs(motion.wheel_speed)
        each = each + torque_constant(wheel) * wheel.friction_current * turning
    power: FloatArray = np.sum(each, axis=1)
    return power


def torque_constant(wheel: DrivenWheel) -> float:
    """k_t [N m/A]."""
    return _known(wheel.motor.torque_constant, "torque constant", wheel)


def resistance(wheel: DrivenWheel) -> float:
    """Resistance between two lines [ohm]."""
    return _known(wheel.motor.resistance, "resistance", wheel)


def _known(figure: float | None, name: str, wheel: DrivenWheel) -> float:
    if figure is None:
        raise OcsError(
            f"motor {wheel.motor.name!r}: its source does not give its {name}",
            hint=FIGURES_HINT,
        )
    return figure
