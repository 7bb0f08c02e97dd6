"""Motors to choose from: rows, each with its source and checked for consistency."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import inf
from pathlib import Path
from types import MappingProxyType
from typing import Annotated

import msgspec

from ocs_design.actuation.drive import missing_figures
from ocs_design.actuation.fasteners import CLASSES, LIGAMENT, SCREW_NAMES, USUAL_CLASS, BoltCircle
from ocs_design.actuation.motor import (
    DIRECT,
    Face,
    Motor,
    MotorFigures,
    MotorKind,
    Mounting,
    ResistanceConvention,
    ShaftForm,
    TorqueConstantConvention,
    build_gaps,
    estimated_continuous_torque,
    estimated_rotor_inertia,
    line_to_line_resistance,
    six_step_current,
    six_step_torque_constant,
)
from ocs_design.catalogue.rows import catalogue, columns_of, entry, load_entries
from ocs_design.common.files import to_json
from ocs_design.common.ranges import Unit
from ocs_design.common.records import recorded


@dataclass(frozen=True)
class DrawnThreads:
    """Threads of a motor in a model that is not the maker's.

    Attributes:
        model: motor that it shows.
        rotor, stator: depth of the threads there [m].
    """

    model: str
    rotor: float
    stator: float


_DRAWN_THREADS = (
    DrawnThreads("U8 Lite", 3.0e-3, 3.6e-3),
    DrawnThreads("MN4014", 3.8e-3, 3.6e-3),
    DrawnThreads("MN6007 II", 7.0e-3, 9.0e-3),
)
"""github.com/defencore/ProtoLab-3D src/parts/bldc-motor/lib/models.json. No maker states them."""


@cache
def drawn_threads(name: str, source: str) -> DrawnThreads | None:
    """What a model draws of a motor of that name, or of one whose threads its source counts."""
    named = f"{name} {source}"
    return next(
        (threads for threads in _DRAWN_THREADS if re.search(rf"\b{threads.model}\b", named)), None
    )


@dataclass(frozen=True, kw_only=True)
class MotorSheet(MotorFigures):
    """A motor's data as given by its source; each field is a column, with its unit as suffix.

    Each column is parsed by its type (`catalogue.rows.columns_of`). None means not given.

    Attributes:
        kind: by the part that turns.
        kt_nm_per_a: torque constant, in the convention `kt_convention`.
        kv_rpm_per_v: speed constant, no-load speed per supply voltage.
        resistance_ohm: of the winding, measured between `resistance_between`.
        voltage_max: highest supply voltage that the maker allows, if not the rated one.
        no_load_speed_rpm: as stated, at the rated voltage.
        stall_torque_nm, stall_current_a: at rest and at the rated voltage.
        speed_max_rpm: highest that the maker allows.
        peak_torque_nm, peak_current_a: highest that the maker allows for a short time.
        continuous_torque_nm: thermally sustainable torque of the winding.
        saturation_torque: torque above which k_t decreases.
        rotor_inertia_kg_m2: of the rotor.
        shaft_diameter_m: on the wheel's side.
        shaft_length_m: protrusion there, from the mounting face of the motor.
        shaft_form: form of the shaft, for the hub.
        rotor_bolt_circle_m, rotor_bolts, rotor_thread: threads in the rotor, on the wheel's side:
            diameter of their circle, number, and size such as M3.
        rotor_screws: property class of the screws that hold the wheel there, if not 8.8.
        stator_bolt_circle_m, stator_bolts, stator_thread: the same in the stator, on its
            `stator_face`.
        rotor_depth_m, rotor_depth_max_m, stator_depth_m, stator_depth_max_m: least and largest
            depth of engagement of the screws that the maker allows.
        remark: explanation of apparent contradictions.
    """

    kt_nm_per_a: float | None = None
    kt_convention: TorqueConstantConvention | None = None
    kv_rpm_per_v: float | None = None
    resistance_ohm: float | None = None
    resistance_between: ResistanceConvention | None = None
    no_load_speed_rpm: float | None = None
    stall_torque_nm: float | None = None
    stall_current_a: float | None = None
    speed_max_rpm: float | None = None
    peak_torque_nm: float | None = None
    peak_current_a: float | None = None
    continuous_torque_nm: float | None = None
    rotor_inertia_kg_m2: float | None = None
    shaft_diameter_m: float | None = None
    shaft_length_m: float | None = None
    rotor_bolt_circle_m: float | None = None
    rotor_bolts: int | None = None
    rotor_thread: str | None = None
    stator_bolt_circle_m: float | None = None
    stator_bolts: int | None = None
    stator_thread: str | None = None
    stator_face: Face | None = None
    remark: str = ""
    saturation_torque: Annotated[float | None, Unit("nm")] = None
    kind: MotorKind | None = None
    voltage_max: Annotated[float | None, Unit("v")] = None
    shaft_form: ShaftForm | None = None
    rotor_screws: str | None = None
    rotor_depth_m: float | None = None
    rotor_depth_max_m: float | None = None
    stator_depth_m: float | None = None
    stator_depth_max_m: float | None = None

    @property
    def torque_constant(self) -> float | None:
        """k_t, line to line [N m/A]; derived from the speed constant if not stated."""
        if self.kt_nm_per_a is not None and self.kt_convention is not None:
            return six_step_torque_constant(self.kt_nm_per_a, self.kt_convention)
        if self.kv_rpm_per_v is not None:
            return 1.0 / rad_s(self.kv_rpm_per_v)
        return None

    @property
    def resistance(self) -> float | None:
        """Line-to-line resistance [ohm]."""
        if self.resistance_ohm is None or self.resistance_between is None:
            return None
        return line_to_line_resistance(self.resistance_ohm, self.resistance_between)

    @property
    def rotor(self) -> BoltCircle | None:
        """Threads in the rotor; None unless all of their figures are given."""
        circle = self._circle("rotor")
        return circle and replace(circle, screws=self.rotor_screws or USUAL_CLASS)

    @property
    def stator(self) -> BoltCircle | None:
        """Threads in the stator; None unless all of their figures are given."""
        return self._circle("stator")

    def _circle(self, side: str) -> BoltCircle | None:
        """Threads on one side, `rotor` or `stator`."""
        columns = (f"{side}_{end}" for end in ("bolt_circle_m", "bolts", "thread"))
        diameter, bolts, thread = (getattr(self, column) for column in columns)
        if diameter is None or bolts is None or thread is None:
            return None
        return BoltCircle(
            diameter,
            bolts,
            thread,
            depth=getattr(self, f"{side}_depth_m"),
            depth_max=getattr(self, f"{side}_depth_max_m"),
            drawn=getattr(drawn_threads(self.name, self.source), side, None),
        )

    @property
    def mounting(self) -> Mounting | None:
        """Mechanical interfaces; None if none of them is given."""
        mounting = Mounting(
            self.shaft_diameter_m,
            self.rotor,
            self.stator,
            self.stator_face,
            self.shaft_length_m,
            self.shaft_form,
        )
        return None if mounting == Mounting() else mounting

    def motor(self) -> Motor:
        """The motor in SI and in the convention of `Motor`."""
        # Highest short-term torque; a motor gives the stall torque of its data sheet when starting.
        torque, basis = self.stall_torque_nm, "stall torque" if self.stall_torque_nm else ""
        if self.peak_torque_nm is not None:
            torque, basis = self.peak_torque_nm, "peak torque"
        elif self.peak_current is not None and self.torque_constant is not None:
            torque, basis = self.peak_current * self.torque_constant, "peak current"
        inertia, inertia_source = self.rotor_inertia_kg_m2, ""
        if inertia is None:
            inertia, inertia_source = estimated_rotor_inertia(self.kind, self.mass, self.diameter)
        continuous, continuous_source = self.continuous_torque_nm, ""
        if continuous is None:
            continuous, continuous_source = estimated_continuous_torque(
                self.torque_constant, self.resistance, self.diameter, self.length
            )
            # The continuous torque cannot exceed the short-term one.
            if continuous is not None and torque is not None:
                continuous = min(continuous, torque)
        return recorded(
            Motor,
            self,
            controller_mass=0.0,
            no_load_speed=_speed(self.no_load_speed_rpm),
            speed_max=_speed(self.speed_max_rpm),
            peak_torque=torque,
            peak_current=self.peak_current,
            continuous_torque=continuous,
            rotor_inertia=inertia,
            peak_basis=basis,
            rotor_inertia_source=inertia_source,
            continuous_torque_source=continuous_source,
        )

    @property
    def peak_current(self) -> float | None:
        """Peak current in the convention of `Motor`: the one that gives the same torque [A]."""
        if self.peak_current_a is None or self.kt_convention is None:
            return self.peak_current_a
        return six_step_current(self.peak_current_a, self.kt_convention)


def rad_s(speed_rpm: float) -> float:
    """Angular speed [rad/s]."""
    return speed_rpm * math.pi / 30.0


def _speed(speed_rpm: float | None) -> float | None:
    return None if speed_rpm is None else rad_s(speed_rpm)


SPEED_CONSTANT_TOLERANCE = 0.05
"""Tolerance of k_t times Kv: Kv is rounded in data sheets, and errors of 3.8 % occur."""

NO_LOAD_TOLERANCE = 0.05
"""Tolerance of the no-load speed: friction and iron losses reduce it by up to 3.6 %."""

STALL_TOLERANCE = 0.03
"""Tolerance of stall torque and current: data sheets compute them, and errors of 2.1 % occur."""

PEAK_TOLERANCE = 0.05
"""Fraction by which a peak torque may exceed k_t times the peak current: 2.0 % occurs."""


def _contradictions(sheet: MotorSheet) -> Iterator[str]:
    """Figures that cannot both be right within the tolerances, one line each."""
    voltage, resistance, k_t = sheet.rated_voltage, sheet.resistance, sheet.torque_constant

    # k_t = 30 / (pi Kv) in the six-step convention; `actuation.motor` has the others.
    given_kt, convention, kv = sheet.kt_nm_per_a, sheet.kt_convention, sheet.kv_rpm_per_v
    if given_kt is not None and convention is not None and kv is not None and k_t is not None:
        product = k_t * rad_s(kv)
        if not _close(product, 1.0, SPEED_CONSTANT_TOLERANCE):
            yield (
                f"k_t Kv is {given_kt * kv:.2f} N m/A rpm/V, which is not "
                f"{convention}{_fitting(sheet)}"
            )

    # No-load speed is (V - R I_0) / k_t; without I_0, V / k_t.
    no_load = sheet.no_load_speed_rpm
    if no_load is not None and voltage is not None and k_t is not None:
        drop = (resistance or 0.0) * (sheet.no_load_current or 0.0)
        expected = (voltage - drop) / k_t
        if not _close(rad_s(no_load), expected, NO_LOAD_TOLERANCE):
            yield (
                f"no-load speed is {no_load:,.0f} rpm, but V, R and k_t make it "
                f"{expected / rad_s(1.0):,.0f} rpm"
            )

    # Stall current is V / R, stall torque k_t times it.
    if voltage is not None and resistance is not None:
        current, given = voltage / resistance, sheet.stall_current_a
        if given is not None and not _close(given, current, STALL_TOLERANCE):
            yield f"stall current is {given:g} A, but V / R is {current:.4g} A"
        torque, given = current * (k_t or 0.0), sheet.stall_torque_nm
        if k_t is not None and given is not None and not _close(given, torque, STALL_TOLERANCE):
            yield f"stall torque is {given:g} N m, but V k_t / R is {torque:.4g} N m"

    # Saturation reduces k_t times the peak current; nothing increases it.
    peak, current_max = sheet.peak_torque_nm, sheet.peak_current
    if peak is not None and current_max is not None and k_t is not None:
        peak_max = k_t * current_max
        if peak > peak_max * (1.0 + PEAK_TOLERANCE):
            yield (
                f"peak torque is {peak:g} N m, above k_t times the peak current, {peak_max:.4g} N m"
            )
    short_term = peak or sheet.stall_torque_nm
    if short_term is not None and (sheet.continuous_torque_nm or 0.0) > short_term:
        yield f"continuous torque is above the short-term {short_term:g} N m"


def _fitting(sheet: MotorSheet) -> str:
    """Text on the conventions in which k_t agrees with Kv."""
    k_t, kv = sheet.kt_nm_per_a, sheet.kv_rpm_per_v
    if k_t is None or kv is None:
        return f": one of {', '.join(TorqueConstantConvention)}"
    fitting = [
        convention
        for convention in TorqueConstantConvention
        if _close(
            six_step_torque_constant(k_t, convention) * rad_s(kv), 1.0, SPEED_CONSTANT_TOLERANCE
        )
    ]
    return f"; it fits {' or '.join(fitting)}" if fitting else "; it fits no convention"


def _close(value: float, expected: float, tolerance: float) -> bool:
    """Whether a figure equals the expected one within a relative tolerance."""
    return abs(value / expected - 1.0) <= tolerance


LEAST_BOLTS = {"rotor": 3, "stator": 2}
"""Fewest bolts: with two, a wheel's inertia is not the same about all transverse axes."""


def _bolt_circle_faults(sheet: MotorSheet, side: str, circle: BoltCircle | None) -> Iterator[str]:
    """Faults of the threads on one side, `rotor` or `stator`, one line each."""
    columns = [f"{side}_{end}" for end in ("bolt_circle_m", "bolts", "thread")]
    depths = [getattr(sheet, f"{side}_{end}") for end in ("depth_m", "depth_max_m")]
    if depths.count(None) == 1 or (circle is None and depths != [None, None]):
        yield f"give {side}_depth_m and {side}_depth_max_m together, and only with {columns[0]}"
    elif None not in depths and depths[0] > depths[1]:
        yield f"{side}_depth_m is {depths[0]:g}, above {side}_depth_max_m, {depths[1]:g}"
    if circle is None:
        missing = [column for column in columns if getattr(sheet, column) is None]
        if len(missing) < len(columns):
            yield f"give all of {', '.join(columns)} or none: {', '.join(missing)} missing"
        return
    where = f"{columns[0]} is {circle.diameter:g}"
    if circle.bolts < LEAST_BOLTS[side]:
        yield f"{columns[1]} is {circle.bolts}; it must be {LEAST_BOLTS[side]} or more"
    elif circle.thread not in SCREW_NAMES:
        yield f"{columns[2]} is {circle.thread!r}, which is not one of {', '.join(SCREW_NAMES)}"
    elif circle.diameter >= (sheet.diameter or inf):
        yield f"{where}, but the motor is only {sheet.diameter:g} m wide"
    elif circle.inside < (sheet.shaft_diameter_m or 0.0) / 2.0 + LIGAMENT:
        yield f"{where}: holes for {circle.thread} leave less than 1 mm to the shaft"
    elif circle.spacing < LIGAMENT:
        yield f"{where}: {circle.bolts} holes for {circle.thread} leave less than 1 mm between them"


LARGEST_MOTOR = 1.0
"""Size that no motor reaches [m]; the widest of the catalogue has 0.23."""

DENSITIES = (1.3e3, 7.0e3)
"""Range of mass over the volume of the body's enclosing cylinder, for the catalogue's motors
[kg/m^3]."""

POSSIBLE, LIKELY = (0.3e3, 20e3), (0.5e3, 15e3)
"""Ranges outside which a row is refused, and outside which a warning is given [kg/m^3]. Tungsten
has 19.3e3."""

SPEED_CONSTANTS = (25.0, 2800.0)
"""Range of the catalogue's speed constants [rpm/V]; a warning is given outside a tenth to ten times
that."""

VOLTAGE_SHARES = (1e-3, 3.0)
"""Range, outside which a warning is given, of the voltage for the peak current at rest over the
rated voltage; the catalogue's motors have 0.01 to 1."""

SHAFT_SHARE = 3.0
"""Ratio of a shaft's length to that of its motor's body above which a warning is given; the
catalogue's motors have up to 0.9."""

TORQUE_SHARES = (3.2, 22.0)
"""Range of peak torque over mass to the power of 4/3 for the catalogue's motors [N m/kg^(4/3)]:
both grow with volume, and torque by another third with the lever arm. A warning is given outside a
tenth to ten times that."""


def _density(sheet: MotorSheet) -> float | None:
    """Mass over the volume of the body's enclosing cylinder [kg/m^3]; None: unknown."""
    mass, diameter, length = sheet.mass, sheet.diameter, sheet.length
    if mass is None or diameter is None or length is None:
        return None
    return mass / (math.pi / 4.0 * diameter**2 * length)


def _likely_unit(value: float, unit: str, share: float, limits: tuple[float, float]) -> str:
    """Question whether the unit is off by a thousand, if that would explain it.

    Args:
        value: as given. unit: its unit.
        share: figure proportional to it that should be within `limits`.
    """
    for factor in (1e-3, 1e3):
        if limits[0] <= share * factor <= limits[1]:
            return f"did you mean {value * factor:g} {unit}?"
    return "check its unit"


def _mass_fault(sheet: MotorSheet, limits: tuple[float, float]) -> Iterator[str]:
    """Line on a mass that is implausible for the body, given a range of densities [kg/m^3]."""
    mass, density = sheet.mass or 0.0, _density(sheet)
    if density is not None and not limits[0] <= density <= limits[1]:
        size = " x ".join(
            f"{1e3 * (length or 0.0):.4g}" for length in (sheet.diameter, sheet.length)
        )
        usual = " to ".join(f"{1e-3 * density:g}" for density in DENSITIES)
        yield (
            f"mass_kg is {mass:g} kg in a body of {size} mm, {1e-3 * density:.4g} g/cm3, where "
            f"motors have {usual}: {_likely_unit(mass, 'kg', density, LIKELY)}"
        )


def _implausible_figures(sheet: MotorSheet) -> Iterator[str]:
    """Figures that are possible but implausible, one line each, with the likely mistake."""
    yield from _mass_fault(sheet, LIKELY)
    mass, torque = sheet.mass, sheet.motor().peak_torque
    # Without a size, the mass is judged by the torque.
    if mass is not None and torque is not None and _density(sheet) is None:
        least, most = TORQUE_SHARES
        if not least / 10.0 <= torque / mass ** (4.0 / 3.0) <= 10.0 * most:
            lightest, heaviest = ((torque / share) ** 0.75 for share in (most, least))
            yield (
                f"mass_kg is {mass:g} kg for {torque:.3g} N m, where motors weigh {lightest:.2g} "
                f"to {heaviest:.2g} kg: "
                f"{_likely_unit(mass, 'kg', mass, (lightest / 3.0, 3.0 * heaviest))}"
            )
    shaft, body = sheet.shaft_length_m, sheet.length
    if shaft is not None and body is not None and shaft > SHAFT_SHARE * body:
        yield (
            f"shaft_length_m is {shaft:g} m, {shaft / body:.2g} times its motor's body, and shafts "
            f"protrude by less than {SHAFT_SHARE:g} times that: "
            f"{_likely_unit(shaft, 'm', shaft / body, (0.05, 1.0))}"
        )
    k_t, (slow, fast) = sheet.torque_constant, SPEED_CONSTANTS
    kv = slow if k_t is None else 1.0 / (k_t * rad_s(1.0))
    if not slow / 10.0 <= kv <= 10.0 * fast:
        of_kt = "kt_nm_per_a", sheet.kt_nm_per_a, "N m/A", 1.0 / kv, (1.0 / fast, 1.0 / slow)
        of_kv = "kv_rpm_per_v", sheet.kv_rpm_per_v, "rpm/V", kv, SPEED_CONSTANTS
        name, value, unit, share, limits = of_kt if sheet.kv_rpm_per_v is None else of_kv
        yield (
            f"{name} is {value:g} {unit}, where motors have {slow:g} to {fast:g} rpm/V: "
            f"{_likely_unit(value or 0.0, unit, share, limits)}"
        )
    current, resistance, voltage = sheet.peak_current, sheet.resistance, sheet.rated_voltage
    if current is not None and resistance is not None and voltage is not None:
        share = current * resistance / voltage
        if not VOLTAGE_SHARES[0] <= share <= VOLTAGE_SHARES[1]:
            resistance_given = sheet.resistance_ohm or 0.0
            yield (
                f"resistance_ohm is {resistance_given:g} ohm, which takes "
                f"{current * resistance:.4g} V for peak_current_a, {sheet.peak_current_a:g} A, "
                f"and rated_voltage_v is {voltage:g} V: "
                f"{_likely_unit(resistance_given, 'ohm', share, VOLTAGE_SHARES)}"
            )


def _faults(sheet: MotorSheet) -> Iterator[str]:
    """Faults of a row, one line each; only contradictions can be excused by a remark."""
    figures = {
        name: getattr(sheet, column.field) for name, column in columns_of(MotorSheet).items()
    }
    sizes = {name: size for name, size in figures.items() if name.endswith("_m") and size}
    large = {name: size for name, size in sizes.items() if size >= LARGEST_MOTOR}
    for name, size in large.items():
        yield f"{name} is {size:g} m, and no motor is that large: did you mean {size / 1e3:g} m?"
    if not large:
        yield from _mass_fault(sheet, POSSIBLE)
    if sheet.kt_nm_per_a is not None and sheet.kt_convention is None:
        yield f"kt_nm_per_a needs its kt_convention{_fitting(sheet)}"
    if sheet.resistance_ohm is not None and sheet.resistance_between is None:
        yield "resistance_ohm needs its resistance_between"
    shaft, body = sheet.shaft_diameter_m, sheet.diameter
    if shaft is not None and body is not None and shaft >= body:
        yield f"shaft_diameter_m is {shaft:g}, but the motor is only {body:g} m wide"
    yield from _bolt_circle_faults(sheet, "rotor", sheet.rotor)
    yield from _bolt_circle_faults(sheet, "stator", sheet.stator)
    voltage, voltage_max = sheet.rated_voltage, sheet.voltage_max
    if voltage is not None and voltage_max is not None and voltage > voltage_max:
        yield f"rated_voltage_v is {voltage:g}, above voltage_max_v, {voltage_max:g}"
    if sheet.shaft_form is not None and sheet.shaft_diameter_m is None:
        yield "shaft_form needs shaft_diameter_m"
    if sheet.rotor_screws is not None and sheet.rotor_screws not in CLASSES:
        yield f"rotor_screws is {sheet.rotor_screws!r}, which is not one of {', '.join(CLASSES)}"
    if (sheet.stator is None) != (sheet.stator_face is None):
        yield "give stator_face and the stator's bolt circle together"
    if not sheet.remark:
        yield from (f"{doubt}; explain it in `remark`" for doubt in _contradictions(sheet))


def motors(file: Path | None = None) -> Mapping[str, Motor]:
    """Every motor of the catalogue by name, sorted, and those of a user's file.

    Those of the file replace ones of the same name.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return catalogue("motors.csv", load_motors, file)


def motor(name: str, known: Mapping[str, Motor] | None = None) -> Motor:
    """The motor called `name`, from the catalogue or from `known`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    rows = motors() if known is None else known
    # Maker and model, as printed in a design and by shops.
    by_maker_and_name = {f"{motor.maker} {motor.name}": motor for motor in rows.values()}
    return entry(rows, name, "motor", by_maker_and_name)


def load_motors(path: Path) -> Mapping[str, Motor]:
    """Every motor of a CSV or TOML file by name, sorted.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return MappingProxyType({name: sheet.motor() for name, sheet in _sheets(path).items()})


def implausible_values(path: Path) -> tuple[str, ...]:
    """Sentences on implausible values in a file of motors, each with its row and column.

    Raises:
        SpecificationError: see `load_entries`.
    """
    sheets = _sheets(path).items()
    return tuple(
        f"{path}, {name}: {doubt}"
        for name, sheet in sheets
        for doubt in _implausible_figures(sheet)
    )


def _sheets(path: Path) -> Mapping[str, MotorSheet]:
    """Every row of a file by its motor's name."""

    def lacks(sheet: MotorSheet) -> str:
        """Clause on missing data that are needed to build with it; empty: none is missing."""
        gaps = build_gaps(sheet.motor())
        return f"to build with it, it lacks {', '.join(gaps)}" if gaps else ""

    return load_entries(path, "motor", MotorSheet, _faults, lacks)


def motors_to_json(motors: Iterable[Motor], warnings: Iterable[str] = ()) -> bytes:
    """Motors as indented UTF-8 JSON, SI, each with data missing for a direct drive and to build.

    Warnings about a user's file, one sentence each, are included.
    """
    rows = [
        {
            **msgspec.to_builtins(motor),
            "missing": missing_figures(motor, DIRECT),
            "build_gaps": build_gaps(motor),
        }
        for motor in motors
    ]
    return to_json({"schema_version": 1, "motors": rows, "warnings": list(warnings)})
