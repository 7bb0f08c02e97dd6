"""A motor, its mounting and its gear from their data sheets, in one convention.

`Motor` has the figures seen by a six-step drive: torque per line current and line-to-line
resistance, so that `V = R i + k_t w` holds with the supply voltage.

A motor's back-EMF has the amplitude E between a line and the star point. Driven by sinusoidal
currents of amplitude I, it takes the power 3/2 E I. From a supply V, sinusoidal drive reaches
sqrt(3) E = V line to line (space-vector modulation), so the no-load speed is Kv V with `1 / Kv =
sqrt(3) E / w`. Expressed as one direct current i through two lines, the same power, torque and heat
give

    k_t = sqrt(3) E / w = 1 / Kv        3/2 E I = k_t w i, so i = sqrt(3)/2 I
    3/2 R_phase I^2 = R i^2,            so R = 2 R_phase

The conventions of k_t differ only by these factors of the current; the torque is the same.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from math import pi
from typing import Annotated

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.common.ranges import Length, LengthIfAny, NotNegative, Positive, Unit


class TorqueConstantConvention(StrEnum):
    """Current to which a stated torque constant refers."""

    SIX_STEP = "six-step"
    """Line current, or supply current at full voltage: `k_t = 30 / (pi Kv)`, 9.549/Kv."""
    FOC = "foc"
    """Amplitude of the sinusoidal phase current, as in field-oriented drives: 8.270/Kv."""
    FOC_RMS = "foc-rms"
    """RMS of the sinusoidal phase current: 11.695/Kv."""


class ResistanceConvention(StrEnum):
    """Points of the winding between which its resistance is stated."""

    LINE_LINE = "line-line"
    PHASE = "phase"
    """Resistance from a line to the star point."""


_PER_SIX_STEP = {
    TorqueConstantConvention.SIX_STEP: 1.0,
    TorqueConstantConvention.FOC: math.sqrt(3.0) / 2.0,
    TorqueConstantConvention.FOC_RMS: math.sqrt(1.5),
}


def six_step_torque_constant(stated: float, convention: TorqueConstantConvention) -> float:
    """k_t of `Motor` [N m/A] from one in that convention; see the module's docstring."""
    return stated / _PER_SIX_STEP[convention]


def six_step_current(stated: float, convention: TorqueConstantConvention) -> float:
    """Current of `Motor` [A] for the same torque; equals the supply current at full voltage."""
    return stated * _PER_SIX_STEP[convention]


def line_to_line_resistance(stated: float, between: ResistanceConvention) -> float:
    """R of `Motor` [ohm]: two phases in series."""
    return 2.0 * stated if between is ResistanceConvention.PHASE else stated


class Face(StrEnum):
    """Face of a motor that has its mounting threads."""

    OUTPUT = "output"
    """The side of the shaft: flat motors, inrunners."""
    BACK = "back"
    """The opposite side: outrunners of aircraft."""


BY_CONVENTION = "threads by convention"
"""Text in `Motor.confidence`: the threads are those that makers commonly use for that size."""


class MotorKind(StrEnum):
    """Kind of motor, by the part that turns."""

    OUTRUNNER = "outrunner"
    """The bell around the stator turns: aircraft and gimbal motors, flat motors."""
    INRUNNER = "inrunner"
    """The rotor turns inside a stationary housing."""
    FRAMELESS = "frameless"
    """Stator and rotor without bearings, shaft and housing."""


class ShaftForm(StrEnum):
    """Form of the shaft, for a wheel's hub."""

    PLAIN = "plain"
    """A cylinder, for a clamp or a collet."""
    FLAT = "d-flat"
    """Shaft with a flat, for a set screw beside the clamp."""
    THREAD = "thread"
    """Threaded shaft, for a nut that presses the wheel against a shoulder."""


@dataclass(frozen=True)
class Mounting:
    """Interfaces of a motor to the wheel and to its stationary mount.

    None means that no source gives the figure.

    Attributes:
        shaft_diameter: of the shaft on the wheel's side [m].
        rotor: threads in the rotor, on the wheel's side.
        stator: threads in the stator. stator_face: face that they are in.
        shaft_length: protrusion of the shaft from the motor's face on the wheel's side [m].
        shaft_form: form of the shaft.
    """

    shaft_diameter: LengthIfAny | None = None
    rotor: BoltCircle | None = None
    stator: BoltCircle | None = None
    stator_face: Face | None = None
    shaft_length: LengthIfAny | None = None
    shaft_form: ShaftForm | None = None


@dataclass(frozen=True)
class GearRoom:
    """Space that a gear stage takes between the plate behind a wheel and the motor; 0: unknown.

    Attributes:
        depth: along the wheel's axis [m].
        offset: distance of the motor's axis from the wheel's [m].
        wheel_radius, motor_radius: of the parts that turn with the wheel and with the motor [m];
            equal for a coaxial stage.
        center: centre of its mass, from the wheel's axis towards the motor's [m].
    """

    depth: LengthIfAny = 0.0
    offset: LengthIfAny = 0.0
    wheel_radius: LengthIfAny = 0.0
    motor_radius: LengthIfAny = 0.0
    center: LengthIfAny = 0.0


@dataclass(frozen=True)
class Gear:
    """One stage with a fixed ratio; a stage with several ratios is one `Gear` per ratio.

    Attributes:
        name: in the catalogue; "direct" for none.
        ratio: N, motor speed over wheel speed; below 1 the wheel turns faster than the motor.
        efficiency: of the torque, 0..1, counted as a loss in both directions.
        mass: of the whole stage [kg].
        inertia: of its turning parts, seen at the wheel [kg m^2].
        motor_speed_max, wheel_speed_max: of its input and its output [rad/s]; inf: not limited.
        torque_max: at its output, short-term [N m]; inf: not limited.
        reverses: whether the wheel turns against the motor, as with a pair of spur gears.
        source: source of the figures.
        room: space that it takes; None: no gear.
    """

    name: str
    ratio: float
    efficiency: float
    mass: float
    inertia: float
    motor_speed_max: float
    wheel_speed_max: float
    torque_max: float
    reverses: bool
    source: str
    room: GearRoom | None = GearRoom()


DIRECT = Gear(
    name="direct",
    ratio=1.0,
    efficiency=1.0,
    mass=0.0,
    inertia=0.0,
    motor_speed_max=float("inf"),
    wheel_speed_max=float("inf"),
    torque_max=float("inf"),
    reverses=False,
    source="the wheel sits on the motor's shaft",
    room=None,
)
"""Direct drive, without a gear."""


@dataclass(frozen=True, kw_only=True)
class MotorFigures:
    """Figures of a motor that no convention, voltage or gear changes.

    A row of the catalogue, the motor made from it and a drive with that motor all have them. None
    means that the source does not give the figure.

    Attributes:
        name: in the catalogue, unique. maker: of the motor.
        source: source of the figures. confidence: good, second-hand, ...
        mass: of the motor alone [kg]. diameter, length: of its body [m].
        rated_voltage: voltage at which the figures hold, or the highest of the maker's range [V].
        no_load_current: drawn when turning freely at the rated voltage [A].
    """

    name: str
    maker: str
    source: str
    confidence: str = ""
    mass: Annotated[NotNegative | None, Unit("kg")] = None
    diameter: Annotated[Length | None, Unit("m")] = None
    length: Annotated[LengthIfAny | None, Unit("m")] = None
    rated_voltage: Annotated[Positive | None, Unit("v")] = None
    no_load_current: Annotated[NotNegative | None, Unit("a")] = None


@dataclass(frozen=True, kw_only=True)
class AnyMotor(MotorFigures):
    """A motor on its own or in a drive, with its figures in the convention of this module.

    Attributes:
        torque_constant: k_t, torque per current and voltage per speed, line to line (six-step
            commutation) [N m/A].
        resistance: line to line [ohm].
        mounting: shaft and threads, if any of them is known; in a drive only without a gear, where
            the wheel sits on the motor.
        rotor_inertia_source: empty: the source's own figure; otherwise the estimate and its
            uncertainty.
        continuous_torque_source: the same of the continuous torque.
        controller_mass: of the controller mounted with the motor [kg]; 0: not counted.
    """

    torque_constant: Positive | None = None
    resistance: Positive | None = None
    mounting: Mounting | None = None
    rotor_inertia_source: str = ""
    continuous_torque_source: str = ""
    controller_mass: NotNegative = 0.0


@dataclass(frozen=True, kw_only=True)
class Motor(AnyMotor):
    """A brushless motor as an equivalent DC motor: `V = R i + k_t w` (docs/theory.md, The motor).

    None means that its source does not give the figure.

    Attributes:
        no_load_speed: as stated, at the rated voltage [rad/s].
        speed_max: highest speed for bearings and rotor, if stated [rad/s].
        peak_torque: at the highest short-term current [N m].
        peak_current: of the supply line, in the same convention [A].
        continuous_torque: thermally sustainable torque of the winding [N m].
        rotor_inertia: [kg m^2].
        peak_basis: basis of `peak_torque`: the maker's peak torque, k_t times its peak current, or
            the stall torque of its data sheet.
        remark: note on the figures.
        saturation_torque: torque above which k_t decreases [N m]; not a limit of the torque, as the
            maker's peak torque is measured with saturation.
        kind: kind of motor.
        voltage_max: highest supply voltage that the maker allows, if not the rated one [V].
    """

    no_load_speed: float | None
    speed_max: float | None
    peak_torque: float | None
    peak_current: float | None
    continuous_torque: float | None
    rotor_inertia: float | None
    peak_basis: str = ""
    remark: str = ""
    saturation_torque: float | None = None
    kind: MotorKind | None = None
    voltage_max: float | None = None


INERTIA_SHARE = {
    MotorKind.OUTRUNNER: (0.050, 0.085),
    MotorKind.FRAMELESS: (0.018, 0.028),
}
"""Range of rotor inertia over mass times diameter squared, for motors where it is known.

A thin bell with half of an outrunner's mass at 0.4 of its diameter would have 0.08. The catalogue's
tests check that every known row lies within; see docs/catalogue.md, Rotor inertia.
"""


def estimated_rotor_inertia(
    kind: MotorKind | None, mass: float | None, diameter: float | None
) -> tuple[float | None, str]:
    """Least rotor inertia of a motor of that kind, mass [kg] and diameter [m], and its basis.

    The least, `INERTIA_SHARE` m D^2 [kg m^2], is conservative where the rotor turns with the wheel:
    the wheel makes up for the rest. The text names the estimate; None and empty if unknown.
    """
    share = None if kind is None else INERTIA_SHARE.get(kind)
    if share is None or mass is None or diameter is None:
        return None, ""
    least, most = share
    return least * mass * diameter**2, (
        f"estimate: {least:g} m D^2, the least of known {kind} motors, which have up to {most:g}"
    )


CONVECTION = 10.0
"""Heat transfer coefficient of a motor's surface in still air, with radiation [W/(m^2 K)].

Free convection of gases gives 2 to 25 (Incropera, Fundamentals of Heat and Mass Transfer, table
1.1). Continuous torques of the catalogue's rows imply 10 and more.
"""

TEMPERATURE_RISE = 75.0
"""Temperature rise of the winding above air at 25 degrees C [K]; insulation class B allows 130
degrees C (IEC 60085)."""

COPPER_COEFFICIENT = 0.00393
"""Temperature coefficient of copper's resistance, relative to that at 20 degrees C [1/K] (IEC
60028)."""


def estimated_continuous_torque(
    torque_constant: float | None,
    resistance: float | None,
    diameter: float | None,
    length: float | None,
) -> tuple[float | None, str]:
    """Torque whose heat a motor's own surface can dissipate [N m], and its basis.

    `R (1 + a dT) i^2 = h A dT` with the surface A of its body: a cylinder and both ends. The
    resistance is line to line, cold.
    """
    if torque_constant is None or resistance is None or diameter is None or length is None:
        return None, ""
    surface = pi * diameter * (length + diameter / 2.0)
    hot = resistance * (1.0 + COPPER_COEFFICIENT * TEMPERATURE_RISE)
    current = math.sqrt(CONVECTION * surface * TEMPERATURE_RISE / hot)
    return torque_constant * current, (
        f"estimate: its surface in still air, {CONVECTION:g} W/(m^2 K), "
        f"winding {TEMPERATURE_RISE:g} K warmer"
    )


def build_gaps(motor: Motor) -> tuple[str, ...]:
    """Names of missing data that are needed to build with this motor.

    They cover its mounting and the wheel's, its size, winding, limits, rotor inertia and heat.
    """
    mounting = motor.mounting or Mounting()
    shaft = mounting.shaft_diameter, mounting.shaft_length
    # The hub's bore centres a cylinder; a thread has up to 0.2 mm of play in it (M5 of ISO 965).
    held = None not in shaft and mounting.shaft_form in {ShaftForm.PLAIN, ShaftForm.FLAT}
    missing = {
        "bolt circle of the stator": mounting.stator,
        "bolt circle of the rotor or data of a shaft without thread (diameter, length, form)": (
            mounting.rotor or (mounting.shaft_form if held else None)
        ),
        "body diameter": motor.diameter,
        "body length": motor.length,
        "mass": motor.mass,
        "torque constant": motor.torque_constant,
        "resistance": motor.resistance,
        "peak torque or current": motor.peak_torque,
        "highest voltage": motor.voltage_max or motor.rated_voltage,
        "rotor inertia": motor.rotor_inertia,
        "continuous torque": motor.continuous_torque,
    }
    gaps = tuple(name for name, figure in missing.items() if figure is None)
    if motor.kind is None:
        return ("kind (outrunner or inrunner)", *gaps)
    if motor.kind is MotorKind.FRAMELESS:
        return ("bearings (it is frameless, and modules have none)", *gaps)
    return gaps
