"""The limits of the specification by name, and the smallest change of one that would do.

The search for that change knows nothing of designs. It asks whether a problem is feasible with a
limit at another value and, where that takes long, whether it is conceivable at all, which a bound
answers quickly.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, pi, sqrt
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from ocs_design.common.errors import Constraint
from ocs_design.common.units import round_outwards

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Owner = TypeVar("Owner", bound="DataclassInstance")


@dataclass(frozen=True)
class Limit:
    """One limit of the specification.

    Attributes:
        name: the constraint. label: of the figure that sets it, in the specification.
        loosens_upwards: whether a larger value allows more.
        unit: of its figure in messages. per_si: ratio of that figure to the SI one.
        field: attribute of the `Envelope` or the `Requirement` that holds it; empty: neither does.
    """

    name: Constraint
    label: str
    loosens_upwards: bool
    unit: str
    per_si: float
    field: str = ""

    def value(self, owner: object) -> float:
        """Present value of the limit [SI]."""
        return float(getattr(owner, self.field))

    def replaced(self, owner: Owner, value: float) -> Owner:
        """The owner with this limit alone changed."""
        change: dict[str, Any] = {self.field: value}
        return replace(owner, **change)

    def loosened(self, value: float, factor: float) -> float:
        """`value` loosened by a factor above one."""
        return value * factor if self.loosens_upwards else value / factor

    def figure(self, value: float) -> str:
        """Figure and unit."""
        return f"{value * self.per_si:.5g} {self.unit}".rstrip()

    def text(self, value: float) -> str:
        """Name, figure and unit."""
        return f"{self.label} {self.figure(value)}"

    def loose_text(self, value: float) -> str:
        """Text with three digits, rounded to the loose side."""
        figure = round_outwards(value * self.per_si, upwards=self.loosens_upwards)
        return f"{self.label} {figure:.6g} {self.unit}".rstrip()


STRESS = Limit(Constraint.HOOP_STRESS, "stress_safety", False, "", 1.0, "stress_safety")

RIM_LIMITS = (
    Limit(Constraint.R_MAX, "r_max", True, "mm", 1e3, "outer_radius_max"),
    Limit(Constraint.R_MIN, "r_min", False, "mm", 1e3, "inner_radius_min"),
    Limit(Constraint.H_MAX, "h_max", True, "mm", 1e3, "height_max"),
    Limit(Constraint.H_MIN, "h_min", False, "mm", 1e3, "height_min"),
    Limit(Constraint.WALL_MIN, "wall_min", False, "mm", 1e3, "wall_min"),
    Limit(Constraint.WHEEL_MASS_MAX, "wheel_mass_max", True, "g", 1e3, "mass_max"),
    STRESS,
)
"""Limits of the envelope, in the order in which they are reported."""

TOP_SPEED = Limit(
    Constraint.WHEEL_SPEED_MAX, "wheel_speed_max", True, "rpm", 30.0 / pi, "wheel_speed_max"
)
BUS_VOLTAGE = Limit(Constraint.BUS_VOLTAGE, "bus_voltage", True, "V", 1.0)
SUPPLY_POWER = Limit(Constraint.BUS_POWER, "supply.power_max", True, "W", 1.0)
TIME = Limit(Constraint.TIME, "time for every maneuver", True, "times what is given", 1.0)

DEVICE_MASS = Limit(Constraint.MASS_MAX, "mass_max", True, "g", 1e3)

LIMITS: Mapping[str, Limit] = {
    limit.name: limit
    for limit in (*RIM_LIMITS, TOP_SPEED, BUS_VOLTAGE, SUPPLY_POWER, TIME, DEVICE_MASS)
}
"""All limits by name."""


LARGEST_CHANGE = 1e3
"""A limit that must be multiplied or divided by more than this to help is not advised."""

_LARGEST_STEP = 1.25
"""Largest ratio of two successive changes tried."""


Progress: TypeAlias = Callable[[float], None]
"""Called with the fraction done."""


def ignore_progress(share: float) -> None:
    """Progress that is ignored."""


def narrowed(
    succeeds: Callable[[float], bool], low: float, high: float, precision: float
) -> tuple[float, float]:
    """Bisection on a logarithmic scale: a value that fails and one, slightly larger, that succeeds.

    `low` fails and `high` succeeds; `precision`: largest relative difference of the result's two.
    """
    while high > (1.0 + precision) * low:
        middle = sqrt(low * high)
        low, high = (low, middle) if succeeds(middle) else (middle, high)
    return low, high


def smallest_changes(
    present: Mapping[Limit, float],
    possible: Callable[[Limit, float], bool],
    *,
    precision: float,
    most: Callable[[Limit], float] = lambda _: LARGEST_CHANGE,
    conceivable: Callable[[Limit, float], bool] | None = None,
    progress: Progress = ignore_progress,
) -> dict[Limit, float]:
    """Values of single limits that just make a problem feasible, the gentlest change first [SI].

    Args:
        present: values of the limits to change [SI], with which the problem is infeasible.
        possible: whether it is feasible with one limit at another value.
        precision: relative precision of the values.
        most: largest factor by which a limit is changed.
        conceivable: where `possible` takes long, whether a bound leaves any design: true from some
            change onwards. A limit that does not help at its largest change is then assumed never
            to help.
        progress: called with the fraction done.
    """
    factors: dict[Limit, float | None] = {}
    for index, (limit, value) in enumerate(present.items()):
        start, largest = 1.0, most(limit)

        def at(
            holds: Callable[[Limit, float], bool], limit: Limit = limit, value: float = value
        ) -> Callable[[float], bool]:
            """A test of the problem, as a function of the factor by which the limit is loosened."""
            return lambda factor: holds(limit, limit.loosened(value, factor))

        if isfinite(value) and value > 0.0:
            if conceivable is not None:
                # A bound's edge, which is quick to find, is where to start.
                feasible_at_all = at(possible)(largest)
                start = (
                    narrowed(at(conceivable), start, largest, precision)[0]
                    if feasible_at_all
                    else largest
                )
            factors[limit] = smallest_factor(at(possible), start, largest, precision)
        progress((index + 1) / len(present))
    known = {limit: factor for limit, factor in factors.items() if factor is not None}
    ordered = sorted(known.items(), key=lambda item: item[1])
    return {limit: limit.loosened(present[limit], factor) for limit, factor in ordered}


def smallest_factor(
    helps: Callable[[float], bool], start: float, largest: float, precision: float
) -> float | None:
    """The smallest factor on a limit that makes the design feasible; None: there is none.

    Growing steps outwards until one succeeds, then bisection of the last one: loosening a limit too
    far may fail where a smaller change succeeds, since a larger wheel also loads the robot. `start`
    is a factor of at least 1 that fails.
    """
    low, step = start, 1.0 + precision
    while low < largest:
        factor = min(low * step, largest)
        if helps(factor):
            return narrowed(helps, low, factor, precision)[1]
        low, step = factor, min(step**2, _LARGEST_STEP)
    return None


def advice(changes: Sequence[str], otherwise: str) -> str:
    """Sentence on the single changes that would do; `otherwise`: advice where there is none."""
    if not changes:
        return f"No single change within reason would do: {otherwise}"
    which = "Any one of these" if len(changes) > 1 else "This"
    return f"{which} alone would do: {'; '.join(changes)}."
