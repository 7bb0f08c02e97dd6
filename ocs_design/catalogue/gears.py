"""Gears between a motor and its wheel, including belts, each with its source.

Nothing here is measured. Pulleys are solid discs of the pitch diameter, wider than the belt by a
flange's thickness on either side; the belt is the shortest that fits them. Webbed pulleys are
lighter.
"""

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import msgspec

from ocs_design.actuation.motor import Gear, GearRoom
from ocs_design.catalogue.rows import catalogue, entry, fraction, load_entries
from ocs_design.common.errors import SpecificationError
from ocs_design.common.files import to_json

FLANGE = 1e-3
"""Thickness of one of a pulley's two flanges [m]."""

PULLEY_GAP = 5e-3
"""Least distance between the pitch circles of the two pulleys [m]."""

TEETH_IN_MESH = 6
"""Teeth in mesh on the smaller pulley below which a fifth of the working tension is lost per tooth
(SDP/SI, Handbook of timing belts, section 13.3)."""

LOSS_PER_TOOTH = 0.2


@dataclass(frozen=True)
class BeltStage:
    """A belt and its two pulleys.

    Attributes:
        motor_teeth, wheel_teeth: of the pulleys on the motor and on the wheel.
        pitch: of the teeth [m].
        width: of the belt [m].
        belt_density: mass of the belt per length [kg/m].
        pulley_density: of the pulleys' material [kg/m^3].
        working_tension: permanent working tension of the belt, at its width [N].
    """

    motor_teeth: int
    wheel_teeth: int
    pitch: float
    width: float
    belt_density: float
    pulley_density: float
    working_tension: float

    @property
    def ratio(self) -> float:
        """N, motor speed over wheel speed."""
        return self.wheel_teeth / self.motor_teeth

    @property
    def motor_radius(self) -> float:
        """Pitch radius of the motor's pulley [m]."""
        return self.pitch * self.motor_teeth / (2.0 * math.pi)

    @property
    def wheel_radius(self) -> float:
        """Pitch radius of the wheel's pulley [m]."""
        return self.pitch * self.wheel_teeth / (2.0 * math.pi)

    @property
    def mass(self) -> float:
        """Mass of belt and pulleys [kg]."""
        pulleys = self._pulley_mass(self.motor_radius) + self._pulley_mass(self.wheel_radius)
        return pulleys + self.belt_mass

    @property
    def belt_mass(self) -> float:
        """Mass of the shortest belt with whole teeth that clears the pulleys [kg]."""
        # About the pitch circles: 2 C cos s + pi (R + r) + 2 s (R - r), sin s = (R - r) / C.
        slope, sum_of_radii = self._slope(), self.motor_radius + self.wheel_radius
        difference = abs(self.wheel_radius - self.motor_radius)
        free = 2.0 * self._least_distance() * math.cos(slope)
        least = free + math.pi * sum_of_radii + 2.0 * slope * difference
        return math.ceil(least / self.pitch) * self.pitch * self.belt_density

    @property
    def inertia(self) -> float:
        """Inertia of pulleys and belt, seen at the wheel [kg m^2].

        The motor's pulley turns N times as fast; the belt runs at the wheel's speed times its
        pulley's radius.
        """
        motor = self._pulley_mass(self.motor_radius) * self.motor_radius**2 / 2.0
        wheel = self._pulley_mass(self.wheel_radius) * self.wheel_radius**2 / 2.0
        return wheel + self.ratio**2 * motor + self.belt_mass * self.wheel_radius**2

    @property
    def torque_max(self) -> float:
        """Largest torque at the wheel, from the working tension and the teeth in mesh [N m]."""
        missing = max(0, TEETH_IN_MESH - self.teeth_in_mesh)
        share = max(0.0, 1.0 - LOSS_PER_TOOTH * missing)
        return share * self.working_tension * self.wheel_radius

    @property
    def teeth_in_mesh(self) -> int:
        """Whole teeth of the smaller pulley that the belt wraps."""
        wrap = math.pi - 2.0 * self._slope()
        return int(min(self.motor_teeth, self.wheel_teeth) * wrap / (2.0 * math.pi))

    @property
    def room(self) -> GearRoom:
        """Space that the stage takes, the motor's axis beside the wheel's, without bearings.

        The depth is that of the pulleys with their flanges, with no gap on either side.
        """
        motor = self._pulley_mass(self.motor_radius)
        moment = motor * self._least_distance() + self.belt_mass * self._least_distance() / 2.0
        return GearRoom(
            depth=self.width + 2.0 * FLANGE,
            offset=self._least_distance(),
            wheel_radius=self.wheel_radius,
            motor_radius=self.motor_radius,
            center=moment / self.mass,
        )

    def _pulley_mass(self, radius: float) -> float:
        return self.pulley_density * math.pi * radius**2 * (self.width + 2.0 * FLANGE)

    def _least_distance(self) -> float:
        return self.motor_radius + self.wheel_radius + PULLEY_GAP

    def _slope(self) -> float:
        """Angle of the free spans to the line between the axes [rad]."""
        return math.asin(abs(self.wheel_radius - self.motor_radius) / self._least_distance())


class GearKind(StrEnum):
    """Kind of gear."""

    BELT = "belt"
    """A timing belt on any two of the pulleys in `teeth`."""
    FIXED = "fixed"
    """Gear wheels with the ratios in `ratios`, such as a planetary gearhead or a spur pair."""


class InertiaAt(StrEnum):
    """Shaft to which the stated inertia refers."""

    MOTOR = "motor"
    WHEEL = "wheel"


@dataclass(frozen=True)
class GearSheet:
    """A gear's data as given by its source; each field is a column, with its unit as suffix.

    Each column is parsed by its type (`catalogue.rows.columns_of`). None means not given.

    Attributes:
        name: unique. maker: of the gear. kind: determines which columns apply.
        efficiency: of the torque, 0..1.
        reverses: whether the wheel turns against the motor.
        ratios: motor speed over wheel speed of each available stage (fixed).
        mass_kg: of the whole stage; for a belt, of axle and bearings in addition to the pulleys.
        inertia_kg_m2: of the turning parts, referred to `inertia_at` (fixed).
        torque_max_nm: at the output, short-term (fixed).
        motor_speed_max_rpm: of the input.
        teeth: of the available pulleys (belt).
        pitch_m, width_m, belt_mass_kg_per_m: of the belt; the mass is that of its whole width.
        working_tension_n: of the belt, at its width (belt).
        belt_speed_max_m_s: of the belt.
        pulley_density_kg_m3: of the pulleys' material (belt).
        source: source of the figures. confidence: good, second-hand, computed, ...
        remark: note on the figures.
    """

    name: str
    maker: str
    kind: GearKind
    source: str
    confidence: str = ""
    efficiency: Annotated[float | None, fraction] = None
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
        """Empty columns that its stages need."""
        needed = _NEEDED[self.kind]
        return tuple(column for column in needed if getattr(self, column) in (None, ()))

    def stages(self) -> tuple[Gear, ...]:
        """Every available stage, by increasing ratio; empty if figures are missing."""
        if self.missing:
            return ()
        motor_speed = math.inf
        if self.motor_speed_max_rpm is not None:
            motor_speed = self.motor_speed_max_rpm * math.pi / 30.0
        # Fields that all stages of one gear share; the others follow.
        shared = Gear(
            name=self.name,
            ratio=1.0,
            efficiency=_given(self.efficiency),
            mass=_given(self.mass_kg),
            inertia=0.0,
            motor_speed_max=motor_speed,
            wheel_speed_max=math.inf,
            torque_max=0.0,
            reverses=self.reverses,
            source=self.source,
        )
        available = []
        # For every two different pulleys; two of equal size would only add mass.
        for pair in itertools.permutations(self.teeth, 2) if self.kind is GearKind.BELT else ():
            belt = BeltStage(
                *pair,
                pitch=_given(self.pitch_m),
                width=_given(self.width_m),
                belt_density=_given(self.belt_mass_kg_per_m),
                pulley_density=_given(self.pulley_density_kg_m3),
                working_tension=_given(self.working_tension_n),
            )
            mass = shared.mass + belt.mass
            stage = replace(
                shared,
                name=f"{self.name} {belt.motor_teeth}:{belt.wheel_teeth}",
                ratio=belt.ratio,
                mass=mass,
                inertia=belt.inertia,
                wheel_speed_max=_given(self.belt_speed_max_m_s) / belt.wheel_radius,
                torque_max=belt.torque_max,
                room=replace(belt.room, center=belt.room.center * belt.mass / mass),
            )
            available.append(stage)
        for ratio in self.ratios if self.kind is GearKind.FIXED else ():
            # Referred to the wheel, inertia on the motor's shaft is multiplied by the ratio
            # squared.
            scale = ratio**2 if self.inertia_at is InertiaAt.MOTOR else 1.0
            fixed = replace(
                shared,
                name=f"{self.name} {ratio:g}:1",
                ratio=ratio,
                inertia=scale * _given(self.inertia_kg_m2),
                torque_max=_given(self.torque_max_nm),
            )
            available.append(fixed)
        return tuple(sorted(available, key=lambda gear: (gear.ratio, gear.name)))


def _given(figure: float | None) -> float:
    """A figure that `missing` has confirmed to be given."""
    assert figure is not None
    return figure


_NEEDED: Mapping[GearKind, tuple[str, ...]] = {
    GearKind.FIXED: (
        *("ratios", "efficiency", "mass_kg", "inertia_kg_m2", "inertia_at", "torque_max_nm"),
        "motor_speed_max_rpm",
    ),
    GearKind.BELT: (
        *("teeth", "efficiency", "mass_kg", "pitch_m", "width_m", "belt_mass_kg_per_m"),
        *("working_tension_n", "belt_speed_max_m_s", "pulley_density_kg_m3"),
    ),
}


def gears(file: Path | None = None) -> Mapping[str, GearSheet]:
    """Every gear of the catalogue by name, sorted, and those of a user's file.

    Those of the file replace ones of the same name.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return catalogue("gears.csv", load_gears, file)


def gear(name: str, known: Mapping[str, GearSheet] | None = None) -> GearSheet:
    """The gear called `name`, from the catalogue or from `known`.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    return entry(gears() if known is None else known, name, "gear")


def named_stages(name: str, known: Mapping[str, GearSheet] | None = None) -> tuple[Gear, ...]:
    """Every stage of the gear called `name`, or the single stage of that name with its ratio.

    Raises:
        SpecificationError: see `gear`; or figures that its stages need are missing.
    """
    sheets = gears() if known is None else known
    matching = tuple(stage for stage in stages(sheets.values()) if stage.name == name)
    if matching and name not in sheets:
        return matching
    sheet = gear(name, sheets)
    if not sheet.stages():
        lacks = ", ".join(sheet.missing) or "teeth of a second pulley"
        raise SpecificationError(
            f"no stage of the gear {sheet.name!r} can be computed: its row lacks {lacks}",
            hint="Give these figures in a file with --gears, or name another gear: "
            "`ocs-design catalogue gears` lists all.",
        )
    return sheet.stages()


def load_gears(path: Path) -> Mapping[str, GearSheet]:
    """Every gear of a CSV or TOML file by name, sorted.

    Raises:
        SpecificationError: see `load_entries`.
    """
    return load_entries(path, "gear", GearSheet)


def stages(sheets: Iterable[GearSheet]) -> tuple[Gear, ...]:
    """Every stage of these gears, without direct drive (`actuation.motor.DIRECT`)."""
    return tuple(stage for sheet in sheets for stage in sheet.stages())


def gears_to_json(sheets: Iterable[GearSheet]) -> bytes:
    """Gears as indented UTF-8 JSON: each row as given, and its stages in SI; null: not limited."""
    rows = [
        {**msgspec.to_builtins(sheet), "missing": sheet.missing, "stages": sheet.stages()}
        for sheet in sheets
    ]
    return to_json({"schema_version": 1, "gears": rows})
