"""A motor, its mounting and its gear, as their data sheets give them, in one convention.

`Motor` has what a six-step drive sees: torque per current through two lines and the resistance
between two lines, so that `V = R i + k_t w` holds with the voltage of the supply.

A motor's back-EMF has the amplitude E between a line and the star point. Driven by sines of
amplitude I it takes the power 3/2 E I. Of a supply V, sines reach sqrt(3) E = V between two lines
(space-vector modulation), so that its no-load speed is Kv V with `1 / Kv = sqrt(3) E / w`. As one
direct current i through two lines, the same power, torque and heat come to

    k_t = sqrt(3) E / w = 1 / Kv        3/2 E I = k_t w i, so i = sqrt(3)/2 I
    3/2 R_phase I^2 = R i^2,            so R = 2 R_phase

The conventions of k_t differ by these factors of the current alone; the torque is the same.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from math import pi, sin

from ocs_design.actuation.fasteners import USUAL_CLASS, screw


class TorqueConstantConvention(StrEnum):
    """Which current the stated torque constant is per."""

    SIX_STEP = "six-step"
    """Through two lines, or of the supply at full voltage: `k_t = 30 / (pi Kv)`, 9.549/Kv."""
    FOC = "foc"
    """Amplitude of a phase's sine, as field-oriented drives count it: 8.270/Kv."""
    FOC_RMS = "foc-rms"
    """Root mean square of a phase's sine: 11.695/Kv."""


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
    """k_t of `Motor` [N m/A] from one in that convention; see the module's text."""
    return stated / _PER_SIX_STEP[convention]


def six_step_current(stated: float, convention: TorqueConstantConvention) -> float:
    """Current of `Motor` [A] of the same torque; that of the supply at full voltage."""
    return stated * _PER_SIX_STEP[convention]


def line_to_line_resistance(stated: float, between: ResistanceConvention) -> float:
    """R of `Motor` [ohm]: two phases in series."""
    return 2.0 * stated if between is ResistanceConvention.PHASE else stated


class Face(StrEnum):
    """Face of a motor that its own threads are in."""

    OUTPUT = "output"
    """The one that its shaft comes out of: flat motors, inrunners."""
    BACK = "back"
    """The other: outrunners of aircraft."""


BY_CONVENTION = "threads by convention"
"""Words in `Motor.confidence`: threads are those that makers use for motors of that size."""


class MotorKind(StrEnum):
    """Which part of a motor turns, and what comes with it."""

    OUTRUNNER = "outrunner"
    """The bell around the stator turns: motors of aircraft, gimbals, flat motors."""
    INRUNNER = "inrunner"
    """The rotor turns inside a housing that stands still."""
    FRAMELESS = "frameless"
    """Stator and rotor without bearings, shaft and housing."""


class ShaftForm(StrEnum):
    """What a wheel's hub can hold on to."""

    PLAIN = "plain"
    """A cylinder, for a clamp or a collet."""
    FLAT = "d-flat"
    """Shaft with a flat, for a set screw beside the clamp."""
    THREAD = "thread"
    """Shaft with a thread, for a nut that presses the wheel on a shoulder."""


@dataclass(frozen=True)
class BoltCircle:
    """Threads around a motor's axis, evenly spaced.

    Attributes:
        diameter: of the circle that they are on [m].
        bolts: how many.
        thread: of each, such as "M3".
        screws: property class of the screws in them.
        depth, depth_max: by which its maker wants them in the motor, at least and at most [m].
    """

    diameter: float
    bolts: int
    thread: str
    screws: str = USUAL_CLASS
    depth: float | None = None
    depth_max: float | None = None

    def __str__(self) -> str:
        """Text for people, as in `4 x M3 on 25 mm`."""
        return f"{self.bolts} x {self.thread} on {1e3 * self.diameter:.4g} mm"

    @property
    def radius(self) -> float:
        """Radius of the circle [m]."""
        return self.diameter / 2.0

    @property
    def hole_radius(self) -> float:
        """Radius of the holes that the screws pass through, ISO 273 medium [m]."""
        return screw(self.thread).clearance_hole / 2.0

    @property
    def inside(self) -> float:
        """Radius that the holes stay outside of [m]."""
        return self.radius - self.hole_radius

    @property
    def reach(self) -> float:
        """Radius that the holes stay within [m]."""
        return self.radius + self.hole_radius

    @property
    def spacing(self) -> float:
        """Material between neighbouring holes [m]."""
        return 2.0 * (self.radius * sin(pi / self.bolts) - self.hole_radius)


@dataclass(frozen=True)
class Mounting:
    """What holds a wheel on a motor, and the motor on what stands still.

    None is what no source gives.

    Attributes:
        shaft_diameter: of the shaft where it comes out of the motor on the wheel's side [m].
        rotor: threads in what turns, on the wheel's side.
        stator: threads in what stands still. stator_face: where they are.
        shaft_length: by which the shaft stands out there, from the motor's face [m].
        shaft_form: what a hub can hold on to.
    """

    shaft_diameter: float | None = None
    rotor: BoltCircle | None = None
    stator: BoltCircle | None = None
    stator_face: Face | None = None
    shaft_length: float | None = None
    shaft_form: ShaftForm | None = None


@dataclass(frozen=True)
class GearRoom:
    """What a stage takes between the plate behind a wheel and the motor; 0: not known.

    Attributes:
        depth: along the wheel's axis [m].
        offset: of the motor's axis from the wheel's [m].
        wheel_radius, motor_radius: of what turns with the wheel and with the motor [m]; of a stage
            on one axis the same.
        center: of its mass, from the wheel's axis towards the motor's [m].
    """

    depth: float = 0.0
    offset: float = 0.0
    wheel_radius: float = 0.0
    motor_radius: float = 0.0
    center: float = 0.0


@dataclass(frozen=True)
class Gear:
    """One stage with a fixed ratio; a stage that may have any ratio is one `Gear` per ratio.

    Attributes:
        name: in the catalogue; "direct" for none.
        ratio: N, motor speed over wheel speed; below 1 the wheel turns faster than the motor.
        efficiency: of the torque, 0..1, taken as a loss in both directions.
        mass: of the whole stage [kg].
        inertia: of its turning parts, seen at the wheel [kg m^2].
        motor_speed_max, wheel_speed_max: of its input and its output [rad/s]; inf: not limited.
        torque_max: at its output, short-term [N m]; inf: not limited.
        reverses: whether the wheel turns against the motor, as behind a pair of spur gears.
        source: where the figures come from.
        room: that it takes; None: there is no gear.
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
"""No gear."""


@dataclass(frozen=True)
class Motor:
    """A brushless motor, as one equivalent DC motor: `V = R i + k_t w` (docs/theory.md, The motor).

    None is what its source does not give.

    Attributes:
        name: in the catalogue, unique. maker: of the motor.
        mass: [kg]. diameter, length: of its body [m].
        torque_constant: k_t, torque per current and voltage per speed between two lines (six-step
            commutation) [N m/A].
        resistance: between two lines [ohm].
        rated_voltage: at which the figures hold, or the highest of the maker's range [V].
        no_load_speed: stated, at the rated voltage [rad/s].
        speed_max: highest that bearings and rotor stand, if stated [rad/s].
        peak_torque: at the highest short-term current [N m].
        peak_current: of the supply line, in the same convention [A].
        continuous_torque: that the winding stands for good [N m].
        rotor_inertia: [kg m^2].
        source: where the figures come from. confidence: good, second-hand, ...
        peak_basis: what `peak_torque` rests on: the maker's peak torque, k_t times its peak
            current, or the stall torque of its data sheet.
        remark: what a reader of the figures must know.
        mounting: shaft and threads, if any of them is known.
        no_load_current: that it draws turning freely, at the rated voltage [A].
        saturation_torque: above which k_t falls off [N m]; no bound on the torque, for the maker's
            peak torque is measured with it.
        kind: which part turns.
        voltage_max: highest supply that the maker allows, if it is not the rated one [V].
        rotor_inertia_source: empty: the source's own; else the estimate and its spread.
        continuous_torque_source: the same of the continuous torque.
        controller_mass: of the controller that comes with it [kg].
    """

    name: str
    maker: str
    mass: float | None
    diameter: float | None
    length: float | None
    torque_constant: float | None
    resistance: float | None
    rated_voltage: float | None
    no_load_speed: float | None
    speed_max: float | None
    peak_torque: float | None
    peak_current: float | None
    continuous_torque: float | None
    rotor_inertia: float | None
    source: str
    confidence: str
    peak_basis: str = ""
    remark: str = ""
    mounting: Mounting | None = None
    no_load_current: float | None = None
    saturation_torque: float | None = None
    kind: MotorKind | None = None
    voltage_max: float | None = None
    rotor_inertia_source: str = ""
    continuous_torque_source: str = ""
    controller_mass: float = 0.0


INERTIA_SHARE = {
    MotorKind.OUTRUNNER: (0.050, 0.085),
    MotorKind.FRAMELESS: (0.018, 0.028),
}
"""Rotor inertia over mass times diameter squared, least and most of the motors where it is known.

A thin bell with half of an outrunner's mass at 0.4 of its diameter would have 0.08. The catalogue's
tests hold every known row within; docs/catalogue.md, Rotor inertia.
"""


def estimated_rotor_inertia(
    kind: MotorKind | None, mass: float | None, diameter: float | None
) -> tuple[float | None, str]:
    """Least rotor inertia of a motor of that kind, mass [kg] and diameter [m], and how it is known.

    The least, `INERTIA_SHARE` m D^2, is the safe side where the rotor turns with the wheel: the
    wheel makes up for what is missing.

    Returns:
        [kg m^2], and a text that names the estimate; None and no text where it cannot be told.
    """
    share = None if kind is None else INERTIA_SHARE.get(kind)
    if share is None or mass is None or diameter is None:
        return None, ""
    least, most = share
    return least * mass * diameter**2, (
        f"estimate: {least:g} m D^2, the least of known {kind} motors, which have up to {most:g}"
    )


CONVECTION = 10.0
"""Heat that leaves a motor's surface in still air, radiation included [W/(m^2 K)].

Free convection of gases gives 2 to 25 (Incropera, Fundamentals of Heat and Mass Transfer,
table 1.1). Continuous torques of the catalogue's rows ask for 10 and more.
"""

TEMPERATURE_RISE = 75.0
"""Rise of the winding above air of 25 degrees [K]; insulation of class B stands 130 (IEC 60085)."""

COPPER_COEFFICIENT = 0.00393
"""Change of copper's resistance per degree, over that at 20 degrees [1/K] (IEC 60028)."""


def estimated_continuous_torque(
    torque_constant: float | None,
    resistance: float | None,
    diameter: float | None,
    length: float | None,
) -> tuple[float | None, str]:
    """Torque that a motor's own surface keeps cool [N m], and how it is known.

    `R (1 + a dT) i^2 = h A dT` with the surface A of its body: a cylinder and both ends.

    Args:
        torque_constant: [N m/A]. resistance: between two lines, cold [ohm].
        diameter, length: of its body [m].
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
    """Figures that anybody who builds with this motor needs and that are missing, in plain words.

    How it is held and how it holds a wheel, its size, winding, limits, rotor inertia and heat.
    """
    mounting = motor.mounting or Mounting()
    shaft = mounting.shaft_diameter, mounting.shaft_length
    missing = {
        "bolt circle of the stator": mounting.stator,
        "bolt circle of the rotor, or diameter, length and form of the shaft": (
            mounting.rotor or (None if None in shaft else mounting.shaft_form)
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
        return ("kind: outrunner or inrunner", *gaps)
    if motor.kind is MotorKind.FRAMELESS:
        return ("bearings: it is frameless, and modules have none", *gaps)
    return gaps
