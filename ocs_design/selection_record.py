"""How the motor was chosen, as `design.json` keeps it (SI)."""

from dataclasses import dataclass

from ocs_design.sizing.selection.result import TaskDemand


@dataclass(frozen=True, kw_only=True)
class RankedRecord:
    """One of the lightest devices; masses are of both modules [kg].

    Attributes:
        motor, gear, material: names in the catalogues. gear_ratio: motor speed over wheel speed.
        incidence: [rad].
        mass, wheels_mass, motors_mass, gears_mass, housings_mass: [kg].
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
    """What one more of a limit buys: see `sizing.selection.prices.Price` (SI)."""

    limit: str
    value: float
    changed: float
    mass_change: float


@dataclass(frozen=True, kw_only=True)
class SelectionRecord:
    """The choice of motor, gear, material and incidence.

    Attributes:
        bus_voltage: [V]. reserve: share of voltage and current that the design may use.
        candidates: how many combinations were looked at.
        binding_maneuver: what asks for the most spin inertia. binding: limits that hold the mass.
        tasks: of the chosen drive. ranking: lightest first. rejections: by motor.
        co_design: None if it was not asked for.
        prices: of the limits, before any co-design; empty where an older version wrote the file.
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
