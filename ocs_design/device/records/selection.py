"""How the device was found and what else would do, as `design.json` has it."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class TaskDemand:
    """What one part of the requirement asks of a drive.

    Attributes:
        source: name of the maneuver, or `rate change, roll` and `rate change, pitch`.
        incidence: of the modules during it [rad].
        spin_inertia: smallest of a wheel with which this drive does it in time [kg m^2].
        time_needed: at the least, with the wheel as designed, on the reserved share of voltage and
            current [s]; None: no time is set.
        time_given: [s]; None likewise.
        peak_speed: of the busier wheel in that least time [rad/s].
        peak_torque: of its motor at the wheel, accelerating or braking [N m]; None: no time is set.
    """

    source: str
    incidence: float
    spin_inertia: float
    time_needed: float | None
    time_given: float | None
    peak_speed: float
    peak_torque: float | None


@dataclass(frozen=True, kw_only=True)
class RankedRecord:
    """One of the lightest devices.

    Attributes:
        motor, gear, material: names in the catalogues. gear_ratio: motor speed over wheel speed.
        incidence: [rad].
        mass: of the whole device, the sum of those that follow. wheels_mass, motors_mass,
            gears_mass, housings_mass, plate_mass: [kg].
        spin_inertia: of each wheel [kg m^2].
        outer_radius, height: of its rim [m].
    """

    motor: str
    gear: str
    gear_ratio: float
    material: str
    incidence: float
    mass: float
    wheels_mass: float
    motors_mass: float
    gears_mass: float
    housings_mass: float
    spin_inertia: float
    outer_radius: float
    height: float
    plate_mass: float = 0.0


@dataclass(frozen=True, kw_only=True)
class RejectionRecord:
    """Why a motor has no place among the candidates.

    Attributes:
        motor: its name. reason: one word. detail: a sentence with figures.
    """

    motor: str
    reason: str
    detail: str


@dataclass(frozen=True, kw_only=True)
class CoDesignRecord:
    """What optimal control made of the selected device.

    Attributes:
        adopted: whether the device is the co-designed one; else the selection stands.
        status: of the solver. iterations: of the solver.
        mass: of the co-designed device [kg]; None if there is none.
        selected_mass: of the selected one [kg].
        violation: largest of any limit on a ten times finer grid, relative.
        remark: one sentence.
    """

    adopted: bool
    status: str
    iterations: int
    mass: float | None
    selected_mass: float
    violation: float | None
    remark: str


@dataclass(frozen=True, kw_only=True)
class PriceRecord:
    """What one more of a limit buys, the limit by its name in `sizing.limits.LIMITS`.

    Attributes:
        limit: its name. value: as it is [SI]. changed: the looser one [SI].
        mass_change: of the whole device [kg], at most 0.
    """

    limit: str
    value: float
    changed: float
    mass_change: float


@dataclass(frozen=True, kw_only=True)
class KeptRecord:
    """Reserve that is kept for a maneuver.

    Attributes:
        maneuver: its name. demand: factor on what is asked of the wheels, at least 1.
        needed: factor that the asked share of robots needs of this device; below 1, one that is
            designed for the mean has enough to spare.
        roll_rate, pitch_rate: that the trunk may begin with [rad/s].
        undone: rate of roll at lift-off that a flip undoes [rad/s]; 0: no flip.
        lost: share of robots that drift off level about an axis out of the wheels' reach.
    """

    maneuver: str
    demand: float
    needed: float
    roll_rate: float
    pitch_rate: float
    lost: float
    undone: float = 0.0


@dataclass(frozen=True, kw_only=True)
class UncertaintyCost:
    """What one uncertain quantity costs.

    Attributes:
        key: of `[reality]`. share: of what robots need more for all keys, each known by itself.
        mass: that the device would be lighter by if the quantity were known [kg].
    """

    key: str
    share: float
    mass: float


@dataclass(frozen=True, kw_only=True)
class ReserveRecord:
    """What is kept for what is uncertain, and what it costs.

    Attributes:
        reliability: share of samples that shall pass. predicted: that do by the closed forms.
        scale: factor on every deviation; above 1 where flights showed more.
        nominal: mass of the lightest device without a reserve [kg].
        maneuvers: see `KeptRecord`. costs: the largest share first.
        curve: reliability and mass of the device of the same parts [kg], where there is one.
    """

    reliability: float
    predicted: float
    scale: float
    nominal: float
    maneuvers: tuple[KeptRecord, ...]
    costs: tuple[UncertaintyCost, ...]
    curve: tuple[tuple[float, float], ...]

    @property
    def demands(self) -> Mapping[str, float]:
        """Factor on what each maneuver asks, by its name."""
        return {each.maneuver: each.demand for each in self.maneuvers}


@dataclass(frozen=True, kw_only=True)
class SelectionRecord:
    """The choice of motor, gear, material and incidence.

    Attributes:
        bus_voltage: [V]. reserve: share of voltage, current and speed limit that it may use.
        candidates: how many combinations were looked at.
        binding_maneuver: what asks for the most spin inertia. binding: limits that hold the mass.
        tasks: of the chosen drive. ranking: lightest first. rejections: by motor.
        co_design: None if it was not asked for.
        prices: of the limits, before any co-design; empty where an older version wrote the file.
        kept: for what is drawn; None likewise, or without maneuvers.
    """

    bus_voltage: float
    reserve: float
    candidates: int
    binding_maneuver: str
    binding: tuple[str, ...]
    tasks: tuple[TaskDemand, ...]
    ranking: tuple[RankedRecord, ...]
    rejections: tuple[RejectionRecord, ...]
    co_design: CoDesignRecord | None
    prices: tuple[PriceRecord, ...] = ()
    kept: ReserveRecord | None = None


@dataclass(frozen=True, kw_only=True)
class SizingRecord:
    """How the optimum was found.

    Attributes:
        status, method: of the optimum. objective: what was minimised [kg]: the mass of the whole
            device, or of one rim.
        binding: limits that hold the mass up.
        shadow_prices: change of the mass of one module per change of each binding limit [kg per SI
            unit of the limit].
        gap: relative, of the optimum.
        residual: of the fixed point, relative. iterations: to it.
    """

    status: str
    method: str
    objective: float
    binding: tuple[str, ...]
    shadow_prices: Mapping[str, float]
    gap: float
    residual: float
    iterations: int


SAVES_NOTHING = "saves nothing"
"""Note of an alternative that is no lighter than the device."""


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """A lighter or simpler device that one change of the question would give.

    Attributes:
        change: what would be different, as a person would say it.
        mass_total: of the whole device, with plate or pedestals [kg]; None: there is none then.
        motor: its name; empty where there is no device.
        note: what speaks for or against it; empty if nothing does.
    """

    change: str
    mass_total: float | None
    motor: str
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Owed:
    """The maneuver that the mass is owed to.

    Attributes:
        maneuver: its name; empty: no single one, without any of them it weighs the same.
        mass_without: of the whole device that does all else, with plate or pedestals [kg]; None:
            nothing else is asked.
    """

    maneuver: str
    mass_without: float | None


@dataclass(frozen=True, kw_only=True)
class Lighter:
    """What would have to give for a lighter device.

    Attributes:
        by: mass that the whole device, with plate or pedestals, is to lose [kg].
        changes: each of which does it; empty: none that was looked for.
    """

    by: float
    changes: tuple[Alternative, ...]
