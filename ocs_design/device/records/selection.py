"""Records of how the device was found, and of alternatives, in `design.json`."""

from collections.abc import Mapping
from dataclasses import dataclass

from ocs_design.common.ranges import NotNegative, Positive, Signed


@dataclass(frozen=True)
class TaskDemand:
    """Demand of one part of the requirement on a drive.

    Attributes:
        source: name of the maneuver, or `rate change, roll` and `rate change, pitch`.
        incidence: of the modules during it [rad].
        spin_inertia: smallest of a wheel with which this drive does it in time [kg m^2].
        time_needed: least time with the wheel as designed, within the usable fraction of voltage
            and current [s]; None: no time limit.
        time_given: [s]; None: no time limit.
        peak_speed: of the busier wheel in that least time [rad/s].
        peak_torque: of its motor at the wheel, accelerating or braking [N m]; None: no time limit.
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
        mass: of the whole device, the sum of its five parts [kg].
        wheels_mass, motors_mass, gears_mass, housings_mass, plate_mass: [kg].
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
    """Reason why a motor is not among the candidates.

    Attributes:
        motor: its name. reason: one word. detail: a sentence with figures.
    """

    motor: str
    reason: str
    detail: str


@dataclass(frozen=True, kw_only=True)
class CoDesignRecord:
    """Result of the co-design by optimal control.

    Attributes:
        adopted: whether the device is the co-designed one; otherwise the selected device is kept.
        status: of the solver. iterations: of the solver.
        mass: of the co-designed device [kg]; None if there is none.
        selected_mass: of the selected one [kg].
        violation: largest relative violation of a limit on a ten times finer grid.
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
    """Price of a limit: the mass that loosening it saves.

    Attributes:
        limit: its word, as in `binding` of a refusal: `r_max`, `bus_power`, `time`, ...
        value: present [SI]; of the time, 1. changed: looser [SI].
        mass_change: of the whole device [kg], at most 0.
    """

    limit: str
    value: float
    changed: float
    mass_change: float


@dataclass(frozen=True, kw_only=True)
class ManeuverReserveRecord:
    """Reserve kept for a maneuver.

    Attributes:
        maneuver: its name. demand: factor on the demand on the wheels, at least 1.
        needed: factor that the required fraction of robots needs of this device; below 1, a device
            designed for the mean has enough margin.
        roll_rate, pitch_rate: initial rates of the trunk that are covered [rad/s].
        undone: roll rate at lift-off that a flip must cancel [rad/s]; 0: no flip.
        lost: fraction of robots that drift off level about an axis that the wheels cannot control.
    """

    maneuver: str
    demand: Positive
    needed: NotNegative
    roll_rate: NotNegative
    pitch_rate: NotNegative
    lost: NotNegative
    undone: NotNegative = 0.0


@dataclass(frozen=True, kw_only=True)
class UncertaintyCost:
    """Cost of one uncertain quantity.

    Attributes:
        key: of `[reality]`.
        share: fraction of the extra need of all quantities, each evaluated as if known alone.
        mass: mass that would be saved if the quantity were known [kg].
    """

    key: str
    share: Signed
    mass: Signed


@dataclass(frozen=True, kw_only=True)
class ReserveRecord:
    """Reserve for uncertainty, and its cost.

    Attributes:
        reliability: required fraction of samples that pass. predicted: the fraction by closed
            forms.
        scale: factor on every deviation; above 1 where simulated flights need more.
        nominal: mass of the lightest device without a reserve [kg].
        maneuvers: what is kept for each.
        costs: of each uncertain quantity, the largest share first.
        curve: reliability and mass of the device of the same parts [kg], where there is one.
    """

    reliability: NotNegative
    predicted: NotNegative
    scale: NotNegative
    nominal: NotNegative
    maneuvers: tuple[ManeuverReserveRecord, ...]
    costs: tuple[UncertaintyCost, ...]
    curve: tuple[tuple[float, float], ...]

    @property
    def demands(self) -> Mapping[str, float]:
        """Factor on the demand of each maneuver, by name."""
        return {kept.maneuver: kept.demand for kept in self.maneuvers}


@dataclass(frozen=True, kw_only=True)
class SelectionRecord:
    """The choice of motor, gear, material and incidence.

    Attributes:
        bus_voltage: [V]. reserve: usable fraction of voltage, current and speed limit.
        candidates: number of combinations examined.
        binding_maneuver: the one that requires the most spin inertia. binding: active limits.
        tasks: what each maneuver demands of the chosen drive.
        ranking: the lightest devices, the chosen one first. rejections: of all other motors.
        co_design: result of the co-design; None if not requested.
        prices: of the limits, before any co-design; empty in files of older versions.
        kept: reserve for sampled errors; None without maneuvers or in files of older versions.
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
        status, method: of the optimum.
        objective: minimised mass, of the whole device or of one rim [kg].
        binding: active limits.
        shadow_prices: change of one module's mass per change of each active limit [kg per SI unit
            of the limit].
        gap: relative gap of the optimum.
        residual: relative residual of the fixed point. iterations: number of iterations.
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
"""Note on an alternative that is not lighter than the device."""


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """A lighter or simpler device that one change of the specification would give.

    Attributes:
        change: the change, in plain words.
        mass_total: of the whole device, with plate or pedestals [kg]; None: infeasible.
        motor: its name; empty if infeasible.
        note: remark for or against it; may be empty.
    """

    change: str
    mass_total: float | None
    motor: str
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class DrivingManeuver:
    """The maneuver that drives the mass.

    Attributes:
        maneuver: its name; empty: no single one, as omitting any of them saves nothing.
        mass_without: mass of the whole device for the rest of the requirement, with plate or
            pedestals [kg]; None: nothing else is required.
    """

    maneuver: str
    mass_without: float | None


@dataclass(frozen=True, kw_only=True)
class TradeOffs:
    """Trade-offs for a lighter device.

    Attributes:
        by: mass to save on the whole device, with plate or pedestals [kg].
        changes: changes that each save it; empty: none was found.
    """

    by: float
    changes: tuple[Alternative, ...]
