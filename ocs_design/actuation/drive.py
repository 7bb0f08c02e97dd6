"""Torque and speed of a motor at a bus voltage, seen at the wheel behind its gear.

With N = motor speed / wheel speed and the gear's efficiency eta, which counts as a loss in both
directions of power flow, so that braking is not overestimated:

    tau_s = N eta V k_t / R        w_0 = V / (k_t N)        tau_L = N eta (peak torque - k_t I_0)

(`V = R i + k_t w`, docs/theory.md, What a motor can do). The voltage line, torque over speed at
full voltage, falls from tau_s at rest to zero at w_0. I_0 is the motor's no-load current due to
friction, where its source gives it.
"""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ocs_design.actuation.motor import DIRECT, AnyMotor, Gear, GearRoom, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.common.arrays import FloatArray, Table, finite_or_none
from ocs_design.common.errors import OcsError
from ocs_design.common.ranges import NotNegative, Positive, Signed
from ocs_design.common.records import recorded
from ocs_design.common.units import rpm

RESERVE = 0.95
"""Fraction of voltage, current and mechanical speed that a design may use; the rest is margin for
the feedback and for a robot that differs from its file."""

PLANNED = (1.0 + RESERVE) / 2.0
"""Fraction of voltage, current, speed limit and power that a plan may use. A device is sized so
that its hardest maneuver takes exactly `RESERVE` of them: half of the rest allows a smoother plan,
the other half is left to the feedback."""

_NO_SPEED = 1e-9
"""Fraction of the line, and speed [rad/s], left to a wheel that starts at its top speed."""

FIGURES_HINT = (
    "Choose another motor, or give its figures in your own file with --motors FILE; "
    "`ocs-design catalogue --help` says how"
)
"""Hint where a motor's source lacks required data."""


@dataclass(frozen=True, eq=False)
class DriveLine(Table):
    """Voltage line and limits at the wheel: scalars, or arrays that broadcast.

    Attributes:
        stall_torque: tau_s, torque of the line at rest [N m]; inf: no line, full torque up to w_0.
        no_load_speed: w_0 [rad/s], finite.
        torque_limit: tau_L, at the current limit [N m]; inf: not limited.
        speed_max: mechanical limit of wheel, motor and gear [rad/s]; inf: not limited.
        power_max: bus power, drawn or fed back, times the gear's efficiency [W]; inf: not limited.
    """

    stall_torque: float | FloatArray
    no_load_speed: float | FloatArray
    torque_limit: float | FloatArray
    speed_max: float | FloatArray
    power_max: float | FloatArray = inf

    @property
    def top_speed(self) -> float | FloatArray:
        """Highest speed without load, limited by voltage or mechanics [rad/s]."""
        return np.minimum(self.no_load_speed, self.speed_max)

    def reserved(self, share: float | FloatArray = RESERVE) -> "DriveLine":
        """The line with a fraction of voltage, current, power and mechanical speed."""
        return replace(self, **{name: limit * share for name, limit in vars(self).items()})

    def divided(self, factor: float) -> "DriveLine":
        """The line with torque and speed divided by a factor, and power unchanged."""
        divided = {
            name: limit / factor for name, limit in vars(self).items() if name != "power_max"
        }
        return replace(self, **divided)

    def from_speed(self, speed: float | FloatArray) -> "DriveLine":
        """The line for the change of a wheel's speed from an initial one [rad/s].

        It is that of the same winding at a voltage reduced by the back EMF at the initial speed,
        exactly for a wheel that only speeds up and that the supply's power does not limit.
        """
        factor = np.maximum(1.0 - speed / np.asarray(self.no_load_speed), _NO_SPEED)
        return replace(
            self,
            stall_torque=self.stall_torque * factor,
            no_load_speed=self.no_load_speed * factor,
            speed_max=np.maximum(self.speed_max - speed, _NO_SPEED),
        )


def drive_line(motor: Motor, gear: Gear, bus_voltage: float) -> DriveLine:
    """Full line of the motor at `bus_voltage` [V] with its gear; see the module's docstring.

    Raises:
        OcsError: required figures are missing; `missing_figures` lists them.
    """
    k_t, resistance = motor.torque_constant, motor.resistance
    peak, speed = motor.peak_torque, speed_limit(motor)
    if k_t is None or resistance is None or peak is None or speed is None:
        raise OcsError(
            f"motor {motor.name!r}: its source does not give "
            f"{', '.join(missing_figures(motor, gear))}",
            hint=FIGURES_HINT,
        )
    gain = gear.ratio * gear.efficiency
    useful = peak - k_t * (motor.no_load_current or 0.0)
    return DriveLine(
        stall_torque=gain * bus_voltage * k_t / resistance,
        no_load_speed=bus_voltage / (k_t * gear.ratio),
        torque_limit=min(gain * useful, gear.torque_max),
        speed_max=min(min(speed, gear.motor_speed_max) / gear.ratio, gear.wheel_speed_max),
    )


def speed_limit(motor: Motor) -> float | None:
    """Highest allowed speed of the motor [rad/s].

    The maker's limit, else the no-load speed at the rated voltage, for which it was built. None if
    the source gives neither.
    """
    if motor.speed_max is not None:
        return motor.speed_max
    if motor.no_load_speed is not None:
        return motor.no_load_speed
    if motor.rated_voltage is None or motor.torque_constant is None:
        return None
    return motor.rated_voltage / motor.torque_constant


def missing_figures(motor: Motor, gear: Gear) -> tuple[str, ...]:
    """Names of required figures of this motor with this gear that its source does not give.

    The rotor's inertia may be missing, or be a lower bound, where that is conservative: where the
    rotor turns with the wheel and no faster, it adds at least as much to the momentum as to the
    inertia to be accelerated. Otherwise its source must state it.
    """
    is_conservative = gear.ratio <= 1.0 and not gear.reverses
    stated_inertia = None if motor.rotor_inertia_source else motor.rotor_inertia
    figures = {
        "mass": motor.mass,
        "torque constant": motor.torque_constant,
        "resistance": motor.resistance,
        "peak torque or current": motor.peak_torque,
        "highest speed or rated voltage": speed_limit(motor),
        "rotor inertia": 0.0 if is_conservative else stated_inertia,
    }
    return tuple(name for name, figure in figures.items() if figure is None)


def rotor_share(rotor_inertia: float, gear: Gear) -> float:
    """Momentum of the rotor per speed of the wheel, s N J_r [kg m^2]; negative if it reverses.

    Part of the spin inertia h = I_rim + s N J_r.
    """
    return _sense(gear) * gear.ratio * rotor_inertia


def armature(rotor_inertia: float, gear: Gear) -> float:
    """Inertia accelerated beyond the spin inertia h, N (N - s) J_r + J_gear [kg m^2].

    The motor accelerates I_m = I_rim + N^2 J_r + J_gear = h + armature; it is zero without a gear,
    and negative for a non-reversing gear that speeds the wheel up.
    """
    return gear.ratio * (gear.ratio - _sense(gear)) * rotor_inertia + gear.inertia


def _sense(gear: Gear) -> float:
    """s, -1 if the wheel turns against the motor."""
    return -1.0 if gear.reverses else 1.0


def power_less_friction(supply: Supply, motors: int, motor: AnyMotor, peak_current: float) -> float:
    """Least power of a supply that remains after the motors' friction [W].

    (R (i + I_0) + k_t w) (i + I_0) exceeds (R i + k_t w) i by at most I_0 (V + R (i + I_0)). A
    motor's `peak_current` is that through its winding [A]; inf: unknown.
    """
    friction, drop = motor.no_load_current or 0.0, 0.0
    if np.isfinite(peak_current) and motor.resistance is not None:
        drop = motor.resistance * (peak_current + friction)
    return max(supply.power - motors * friction * (supply.voltage + drop), 0.0)


@dataclass(frozen=True, kw_only=True)
class Drive(AnyMotor):
    """Motor at a voltage with a gear: its voltage line, limits and inertia, all at the wheel.

    It is written to `design.json` unchanged. None means not limited or unknown; for the assumed
    motor that is everything except its speed and, where specified, its torque.

    Attributes:
        name: in the catalogue, or "assumed". maker: of the motor; empty: unknown.
        mass: of the motor alone, without its gear [kg].
        stall_torque: torque of the voltage line at rest [N m]; None: full torque up to the top
            speed.
        no_load_speed: of the voltage line [rad/s].
        torque_limit: at the current limit of motor and drive, or of the gear [N m].
        rotor_inertia: what the rotor adds to the spin inertia of the wheel [kg m^2]: its own times
            the gear ratio, negative where the gear reverses.
        gear: name in the catalogue, or "direct".
        gear_ratio: motor speed over wheel speed.
        gear_efficiency: of the torque, 0..1, counted as a loss in both directions.
        gear_mass: [kg].
        bus_voltage: [V].
        speed_max: mechanical limit of wheel, gear and motor [rad/s].
        armature: inertia that the motor accelerates beyond the spin inertia of the wheel, at the
            wheel [kg m^2]; 0 without a gear.
        continuous_torque: thermally sustainable torque of the winding [N m].
        gear_room: space that its gear takes; None: no gear.
        saturation_torque: torque at the wheel above which the motor's k_t decreases [N m].
    """

    mass: NotNegative
    maker: str = ""
    stall_torque: Positive | None
    no_load_speed: Positive
    torque_limit: Positive | None
    rotor_inertia: Signed
    gear: str = DIRECT.name
    gear_ratio: Positive = DIRECT.ratio
    gear_efficiency: Positive = DIRECT.efficiency
    gear_mass: NotNegative = DIRECT.mass
    bus_voltage: Positive | None = None
    speed_max: Positive | None = None
    armature: Signed = 0.0
    continuous_torque: NotNegative | None = None
    gear_room: GearRoom | None = None
    saturation_torque: Positive | None = None

    @property
    def full_name(self) -> str:
        """Maker and name, as in an order."""
        return f"{self.maker} {self.name}".lstrip()

    @classmethod
    def of(
        cls, motor: Motor, gear: Gear, bus_voltage: float, line: DriveLine | None = None
    ) -> "Drive":
        """The motor with its gear at `bus_voltage` [V].

        Fields that `Motor` has too are copied by name, unless gear or supply change them. `line`:
        usable voltage line at the wheel; None: the full line of motor and gear.

        Raises:
            OcsError: the motor lacks a required figure.
        """
        line = drive_line(motor, gear, bus_voltage) if line is None else line
        rotor, gain = motor.rotor_inertia or 0.0, gear.ratio * gear.efficiency
        return recorded(
            cls,
            motor,
            mass=motor.mass or 0.0,
            stall_torque=finite_or_none(line.stall_torque),
            no_load_speed=float(line.no_load_speed),
            torque_limit=finite_or_none(line.torque_limit),
            speed_max=finite_or_none(line.speed_max),
            rotor_inertia=rotor_share(rotor, gear),
            armature=armature(rotor, gear),
            continuous_torque=_geared(motor.continuous_torque, gain),
            saturation_torque=_geared(motor.saturation_torque, gain),
            mounting=motor.mounting if gear.room is None else None,
            gear=gear.name,
            gear_ratio=gear.ratio,
            gear_efficiency=gear.efficiency,
            gear_mass=gear.mass,
            gear_room=gear.room,
            bus_voltage=bus_voltage,
        )

    @property
    def top_speed(self) -> float:
        """Highest wheel speed, limited by voltage or mechanics [rad/s]; inf: not limited."""
        return min(self.no_load_speed, self.speed_max or inf)

    @property
    def overvoltage(self) -> str:
        """One sentence if the supply is above the motor's rating; empty otherwise."""
        supplied, rated = self.bus_voltage, self.rated_voltage
        if not supplied or not rated or supplied <= rated:
            return ""
        return (
            f"{self.name} is rated for {rated:g} V but runs at {supplied:g} V: ask the makers of "
            "motor and controller if this is allowed"
        )

    @property
    def top_speed_reason(self) -> str:
        """What limits `top_speed`, in words: the supply, or what is allowed if that is less."""
        without_load = "without load" + (f" at {self.bus_voltage:g} V" if self.bus_voltage else "")
        if self.speed_max is None or self.no_load_speed <= self.speed_max:
            return without_load
        return f"the most allowed; {rpm(self.no_load_speed)} {without_load}"

    @property
    def friction_factor(self) -> float:
        """Factor on the line due to the motor's friction, 1 - N eta k_t I_0 / tau_s.

        Both stall torque and no-load speed are reduced by this factor; the slope stays the same.
        """
        return 1.0 if self.stall_torque is None else 1.0 - self.friction / self.stall_torque

    @property
    def friction(self) -> float:
        """N eta k_t I_0, torque lost to the motor's own friction, at the wheel [N m]."""
        return self.torque_per_current * (self.no_load_current or 0.0)

    @property
    def torque_per_current(self) -> float:
        """N eta k_t, torque at the wheel per current in the winding [N m/A]; 0: unknown."""
        return self.gear_ratio * self.gear_efficiency * (self.torque_constant or 0.0)

    @property
    def without_friction(self) -> "Drive":
        """The drive without its own friction, for models that include friction themselves."""
        limit = None if self.torque_limit is None else self.torque_limit + self.friction
        return replace(self, torque_limit=limit, no_load_current=None)


def _geared(torque: float | None, gain: float) -> float | None:
    """Torque at the wheel [N m]; None if unknown."""
    return None if torque is None else gain * torque
