"""A motor's row: figures in the units and conventions of its source, and what they come to."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.catalogue.cells import Reader, choice, positive, text, whole
from ocs_design.drive.conventions import (
    ResistanceConvention,
    TorqueConstantConvention,
    line_to_line_resistance,
    six_step_current,
    six_step_torque_constant,
)
from ocs_design.drive.motor import Motor
from ocs_design.drive.mounting import BoltCircle, Face, Mounting


@dataclass(frozen=True)
class MotorSheet:
    """What a source says of a motor; a field is a column, its unit at the end of its name.

    None is what the source does not give.

    Attributes:
        name: unique. maker: of the motor.
        mass_kg: of the whole motor. diameter_m, length_m: of its body.
        kt_nm_per_a: torque constant, in the convention `kt_convention`.
        kv_rpm_per_v: speed constant, no-load speed per voltage of the supply.
        resistance_ohm: of the winding, measured between `resistance_between`.
        rated_voltage_v: at which the figures hold, or the highest of the maker's range.
        no_load_speed_rpm, no_load_current_a: stated, at the rated voltage.
        stall_torque_nm, stall_current_a: at rest and at the rated voltage.
        speed_max_rpm: highest that the maker allows.
        peak_torque_nm, peak_current_a: highest that the maker allows for a short time.
        continuous_torque_nm: that the winding stands for good.
        saturation_torque_nm: above which k_t falls off.
        rotor_inertia_kg_m2: of the rotor.
        shaft_diameter_m: where it comes out of the motor on the wheel's side.
        shaft_length_m: by which it stands out there, from the face that the motor is mounted by.
        rotor_bolt_circle_m, rotor_bolts, rotor_thread: threads in what turns, on the wheel's side:
            diameter of their circle, number, and size such as M3.
        stator_bolt_circle_m, stator_bolts, stator_thread: the same in what stands still, on its
            `stator_face`.
        source: where the figures come from. confidence: good, second-hand, ...
        remark: why figures that seem to contradict each other stand as they do.
    """

    name: str
    maker: str
    source: str
    confidence: str = ""
    mass_kg: float | None = None
    diameter_m: float | None = None
    length_m: float | None = None
    kt_nm_per_a: float | None = None
    kt_convention: TorqueConstantConvention | None = None
    kv_rpm_per_v: float | None = None
    resistance_ohm: float | None = None
    resistance_between: ResistanceConvention | None = None
    rated_voltage_v: float | None = None
    no_load_speed_rpm: float | None = None
    no_load_current_a: float | None = None
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
    saturation_torque_nm: float | None = None

    @property
    def torque_constant(self) -> float | None:
        """k_t between two lines [N m/A]; from the speed constant if it is not stated itself."""
        if self.kt_nm_per_a is not None and self.kt_convention is not None:
            return six_step_torque_constant(self.kt_nm_per_a, self.kt_convention)
        if self.kv_rpm_per_v is not None:
            return 1.0 / rad_s(self.kv_rpm_per_v)
        return None

    @property
    def resistance(self) -> float | None:
        """Between two lines [ohm]."""
        if self.resistance_ohm is None or self.resistance_between is None:
            return None
        return line_to_line_resistance(self.resistance_ohm, self.resistance_between)

    @property
    def rotor(self) -> BoltCircle | None:
        """Threads in what turns; None unless all of their figures are stated."""
        return _circle(self.rotor_bolt_circle_m, self.rotor_bolts, self.rotor_thread)

    @property
    def stator(self) -> BoltCircle | None:
        """Threads in what stands still; None unless all of their figures are stated."""
        return _circle(self.stator_bolt_circle_m, self.stator_bolts, self.stator_thread)

    @property
    def mounting(self) -> Mounting | None:
        """None if nothing of it is stated."""
        found = Mounting(
            self.shaft_diameter_m, self.rotor, self.stator, self.stator_face, self.shaft_length_m
        )
        return None if found == Mounting() else found

    def motor(self) -> Motor:
        """The motor in SI and in the one convention of `Motor`."""
        torque, basis = self._peak_torque()
        return Motor(
            name=self.name,
            maker=self.maker,
            mass=self.mass_kg,
            diameter=self.diameter_m,
            length=self.length_m,
            torque_constant=self.torque_constant,
            resistance=self.resistance,
            rated_voltage=self.rated_voltage_v,
            no_load_speed=_speed(self.no_load_speed_rpm),
            speed_max=_speed(self.speed_max_rpm),
            peak_torque=torque,
            peak_current=self._peak_current(),
            continuous_torque=self.continuous_torque_nm,
            rotor_inertia=self.rotor_inertia_kg_m2,
            source=self.source,
            confidence=self.confidence,
            peak_basis=basis,
            remark=self.remark,
            mounting=self.mounting,
            no_load_current=self.no_load_current_a,
            saturation_torque=self.saturation_torque_nm,
        )

    def _peak_torque(self) -> tuple[float | None, str]:
        """Highest short-term torque [N m] and what it rests on.

        The maker's peak torque; else k_t times its peak current; else the stall torque of its data
        sheet, which the motor gives while it starts.
        """
        if self.peak_torque_nm is not None:
            return self.peak_torque_nm, "peak torque"
        current = self._peak_current()
        if current is not None and self.torque_constant is not None:
            return current * self.torque_constant, "peak current"
        return self.stall_torque_nm, "stall torque" if self.stall_torque_nm else ""

    def _peak_current(self) -> float | None:
        """In the convention of `Motor` [A]: that of the same torque."""
        if self.peak_current_a is None or self.kt_convention is None:
            return self.peak_current_a
        return six_step_current(self.peak_current_a, self.kt_convention)


def rad_s(speed_rpm: float) -> float:
    """Angular speed [rad/s]."""
    return speed_rpm * math.pi / 30.0


def _circle(diameter: float | None, bolts: int | None, thread: str | None) -> BoltCircle | None:
    if diameter is None or bolts is None or thread is None:
        return None
    return BoltCircle(diameter, bolts, thread)


def _speed(speed_rpm: float | None) -> float | None:
    return None if speed_rpm is None else rad_s(speed_rpm)


MOTOR_COLUMNS: Mapping[str, Reader] = {
    "name": text,
    "maker": text,
    "mass_kg": positive,
    "diameter_m": positive,
    "length_m": positive,
    "kt_nm_per_a": positive,
    "kt_convention": choice(TorqueConstantConvention),
    "kv_rpm_per_v": positive,
    "resistance_ohm": positive,
    "resistance_between": choice(ResistanceConvention),
    "rated_voltage_v": positive,
    "no_load_speed_rpm": positive,
    "no_load_current_a": positive,
    "stall_torque_nm": positive,
    "stall_current_a": positive,
    "speed_max_rpm": positive,
    "peak_torque_nm": positive,
    "peak_current_a": positive,
    "continuous_torque_nm": positive,
    "rotor_inertia_kg_m2": positive,
    "shaft_diameter_m": positive,
    "shaft_length_m": positive,
    "rotor_bolt_circle_m": positive,
    "rotor_bolts": whole,
    "rotor_thread": text,
    "stator_bolt_circle_m": positive,
    "stator_bolts": whole,
    "stator_thread": text,
    "stator_face": choice(Face),
    "source": text,
    "confidence": text,
    "remark": text,
    "saturation_torque_nm": positive,
}
"""Each column and how its cells are read."""
