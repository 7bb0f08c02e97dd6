"""A gear's row: figures in the units of its source, and the stages that it offers."""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

from ocs_design.catalogue.belt import BeltStage
from ocs_design.catalogue.cells import (
    Reader,
    choice,
    fraction,
    numbers,
    positive,
    switch,
    text,
    tooth_counts,
)
from ocs_design.drive.gear import Gear


class GearKind(StrEnum):
    """What turns the wheel."""

    BELT = "belt"
    """A timing belt: any two of the pulleys in `teeth`."""
    FIXED = "fixed"
    """Toothed wheels with the ratios in `ratios`: a planetary gearhead, a spur pair."""


class InertiaAt(StrEnum):
    """At which shaft the stated inertia is seen."""

    MOTOR = "motor"
    WHEEL = "wheel"


@dataclass(frozen=True)
class GearSheet:
    """What a source says of a gear; a field is a column, its unit at the end of its name.

    None is what the source does not give.

    Attributes:
        name: unique. maker: of the gear. kind: decides which columns count.
        efficiency: of the torque, 0..1.
        reverses: whether the wheel turns against the motor.
        ratios: motor speed over wheel speed, of each stage on offer (fixed).
        mass_kg: of the whole stage; of a belt's what its pulleys need besides: axle and bearings.
        inertia_kg_m2: of the turning parts, seen at `inertia_at` (fixed).
        torque_max_nm: at the output, short-term (fixed).
        motor_speed_max_rpm: of the input.
        teeth: of the pulleys on offer (belt).
        pitch_m, width_m, belt_mass_kg_per_m: of the belt; the mass is that of its whole width.
        working_tension_n: that the belt stands, at its width (belt).
        belt_speed_max_m_s: of the belt.
        pulley_density_kg_m3: of the pulleys' material (belt).
        source: where the figures come from. confidence: good, second-hand, computed, ...
        remark: what a reader of the figures must know.
    """

    name: str
    maker: str
    kind: GearKind
    source: str
    confidence: str = ""
    efficiency: float | None = None
    reverses: bool = False
    ratios: tuple[float, ...] = ()
    mass_kg: float | None = None
    inertia_kg_m2: float | None = None
    inertia_at: InertiaAt | None = None
    torque_max_nm: float | None = None
    motor_speed_max_rpm: float | None = None
    teeth: tuple[int, ...] = ()
    pitch_m: float | None = None
    width_m: float | None = None
    belt_mass_kg_per_m: float | None = None
    working_tension_n: float | None = None
    belt_speed_max_m_s: float | None = None
    pulley_density_kg_m3: float | None = None
    remark: str = ""

    @property
    def missing(self) -> tuple[str, ...]:
        """Columns that its stages need and that are empty."""
        needed = _NEEDED[self.kind]
        return tuple(column for column in needed if getattr(self, column) in (None, ()))

    def stages(self) -> tuple[Gear, ...]:
        """Every stage on offer, by rising ratio; none if figures are missing."""
        if self.missing:
            return ()
        found = self._belts() if self.kind is GearKind.BELT else self._fixed()
        return tuple(sorted(found, key=lambda gear: (gear.ratio, gear.name)))

    def _fixed(self) -> Iterator[Gear]:
        for ratio in self.ratios:
            # Seen at the wheel, what turns with the motor counts with the square of the ratio.
            scale = ratio**2 if self.inertia_at is InertiaAt.MOTOR else 1.0
            yield Gear(
                name=f"{self.name} {ratio:g}:1",
                ratio=ratio,
                efficiency=_stated(self.efficiency),
                mass=_stated(self.mass_kg),
                inertia=scale * _stated(self.inertia_kg_m2),
                motor_speed_max=_speed(self.motor_speed_max_rpm),
                wheel_speed_max=math.inf,
                torque_max=_stated(self.torque_max_nm),
                reverses=self.reverses,
                source=self.source,
            )

    def _belts(self) -> Iterator[Gear]:
        """Every two different pulleys; two of a size would only add mass."""
        for motor_teeth, wheel_teeth in itertools.permutations(self.teeth, 2):
            belt = self._belt(motor_teeth, wheel_teeth)
            mass = _stated(self.mass_kg) + belt.mass
            yield Gear(
                name=f"{self.name} {motor_teeth}:{wheel_teeth}",
                ratio=belt.ratio,
                efficiency=_stated(self.efficiency),
                mass=mass,
                inertia=belt.inertia,
                motor_speed_max=_speed(self.motor_speed_max_rpm),
                wheel_speed_max=belt.wheel_speed_max(_stated(self.belt_speed_max_m_s)),
                torque_max=belt.torque_max,
                reverses=self.reverses,
                source=self.source,
                room=replace(belt.room, center=belt.room.center * belt.mass / mass),
            )

    def _belt(self, motor_teeth: int, wheel_teeth: int) -> BeltStage:
        return BeltStage(
            motor_teeth=motor_teeth,
            wheel_teeth=wheel_teeth,
            pitch=_stated(self.pitch_m),
            width=_stated(self.width_m),
            belt_density=_stated(self.belt_mass_kg_per_m),
            pulley_density=_stated(self.pulley_density_kg_m3),
            working_tension=_stated(self.working_tension_n),
        )


def _stated(figure: float | None) -> float:
    """A figure that `missing` has found to be there."""
    assert figure is not None
    return figure


def _speed(speed_rpm: float | None) -> float:
    """[rad/s]; inf: not limited."""
    return math.inf if speed_rpm is None else speed_rpm * math.pi / 30.0


_NEEDED: Mapping[GearKind, tuple[str, ...]] = {
    GearKind.FIXED: (
        "ratios",
        "efficiency",
        "mass_kg",
        "inertia_kg_m2",
        "inertia_at",
        "torque_max_nm",
        "motor_speed_max_rpm",
    ),
    GearKind.BELT: (
        "teeth",
        "efficiency",
        "mass_kg",
        "pitch_m",
        "width_m",
        "belt_mass_kg_per_m",
        "working_tension_n",
        "belt_speed_max_m_s",
        "pulley_density_kg_m3",
    ),
}

GEAR_COLUMNS: Mapping[str, Reader] = {
    "name": text,
    "maker": text,
    "kind": choice(GearKind),
    "efficiency": fraction,
    "reverses": switch,
    "ratios": numbers,
    "mass_kg": positive,
    "inertia_kg_m2": positive,
    "inertia_at": choice(InertiaAt),
    "torque_max_nm": positive,
    "motor_speed_max_rpm": positive,
    "teeth": tooth_counts,
    "pitch_m": positive,
    "width_m": positive,
    "belt_mass_kg_per_m": positive,
    "working_tension_n": positive,
    "belt_speed_max_m_s": positive,
    "pulley_density_kg_m3": positive,
    "source": text,
    "confidence": text,
    "remark": text,
}
"""Each column and how its cells are read."""
