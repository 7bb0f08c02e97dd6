"""The limits of the specification by name, and the smallest change of one that mends a design."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite, log10, pi
from typing import Any, TypeVar

from ocs_design.requirement.envelope import Envelope
from ocs_design.requirement.requirement import Requirement
from ocs_design.units import round_outwards

MOST_CHANGE = 1e3
"""A limit that helps only when multiplied or divided by more than this is no advice."""

PRECISION = 1e-6
"""Relative, of the smallest change that helps."""

_STEP = 1.25

Owner = TypeVar("Owner", Envelope, Requirement)


@dataclass(frozen=True)
class Limit:
    """One limit of the specification.

    Attributes:
        name: of the constraint. label: of the figure that sets it, in the specification.
        field: of the `Envelope` or the `Requirement` that holds it.
        loosens_upwards: more is possible if it is larger.
        unit: of its figure in messages. per_si: that figure over the SI one.
    """

    name: str
    label: str
    field: str
    loosens_upwards: bool
    unit: str
    per_si: float

    def value(self, owner: Owner) -> float:
        """The limit as it is [SI]."""
        return float(getattr(owner, self.field))

    def replaced(self, owner: Owner, value: float) -> Owner:
        """The same with this limit alone changed."""
        change: dict[str, Any] = {self.field: value}
        return replace(owner, **change)

    def loosened(self, value: float, factor: float) -> float:
        """`value` made looser by a factor above one."""
        return value * factor if self.loosens_upwards else value / factor

    def figure(self, value: float) -> str:
        """Figure and unit."""
        return f"{value * self.per_si:.5g} {self.unit}".rstrip()

    def text(self, value: float) -> str:
        """Name, figure and unit."""
        return f"{self.label} {self.figure(value)}"

    def loose_text(self, value: float) -> str:
        """The same with three digits, rounded to the loose side."""
        figure = round_outwards(value * self.per_si, upwards=self.loosens_upwards)
        return f"{self.label} {figure:.6g} {self.unit}".rstrip()


STRESS = Limit("hoop_stress", "stress_safety", "stress_safety", False, "", 1.0)

RIM_LIMITS = (
    Limit("r_max", "r_max", "outer_radius_max", True, "mm", 1e3),
    Limit("r_min", "r_min", "inner_radius_min", False, "mm", 1e3),
    Limit("h_max", "h_max", "height_max", True, "mm", 1e3),
    Limit("h_min", "h_min", "height_min", False, "mm", 1e3),
    Limit("wall_min", "wall_min", "wall_min", False, "mm", 1e3),
    Limit("wheel_mass_max", "wheel_mass_max", "mass_max", True, "g", 1e3),
    STRESS,
)
"""Those of the envelope, in the order in which they are reported."""

WHEEL_SPEED = Limit("wheel_speed_max", "wheel_speed_max", "wheel_speed_max", True, "rpm", 30.0 / pi)
BUS_VOLTAGE = Limit("bus_voltage", "bus_voltage", "bus_voltage", True, "V", 1.0)
TIME = Limit("time", "time for every maneuver", "", True, "times what is given", 1.0)

DEVICE_MASS = Limit("mass_max", "mass_max", "mass_max", True, "g", 1e3)

LIMITS: Mapping[str, Limit] = {
    limit.name: limit for limit in (*RIM_LIMITS, WHEEL_SPEED, BUS_VOLTAGE, TIME, DEVICE_MASS)
}
"""By name."""


def told_changes(texts: Sequence[str]) -> str:
    """Single changes that would do, at least one, as a sentence."""
    which = "Any one of these" if len(texts) > 1 else "This"
    return f"{which} alone would do: {'; '.join(texts)}."


def smallest_changes(
    values: Mapping[Limit, float],
    mends: Callable[[Limit, float], bool],
    precision: float = PRECISION,
) -> dict[Limit, float]:
    """For each limit that can mend the design alone the value that just does, gentlest first [SI].

    Args:
        values: of the limits as they are [SI].
        mends: whether a design exists with one limit at another value.
        precision: of the values, relative.
    """
    found = {
        limit: smallest_change(limit, now, partial(mends, limit), precision)
        for limit, now in values.items()
    }
    helpful = {limit: value for limit, value in found.items() if value is not None}
    return dict(sorted(helpful.items(), key=lambda item: abs(log10(item[1] / values[item[0]]))))


def smallest_change(
    limit: Limit, now: float, mends: Callable[[float], bool], precision: float = PRECISION
) -> float | None:
    """The value next to `now`, on its loose side, that mends the design.

    Steps outwards until it mends, then halves the last step: a limit loosened too far need not
    mend what a smaller change does, as a larger wheel also weighs on the robot.

    Args:
        limit: which one, for the side on which it is loose.
        now: its value, at which `mends` is false.
        mends: whether a value allows a design.
        precision: of the value, relative.

    Returns:
        None if nothing within `MOST_CHANGE` helps.
    """
    if not (isfinite(now) and now > 0.0):
        return None
    tight, loose = 1.0, _STEP
    while not mends(limit.loosened(now, loose)):
        tight, loose = loose, loose * _STEP
        if tight > MOST_CHANGE:
            return None
    while loose - tight > precision / 3.0 * tight:
        middle = (tight + loose) / 2.0
        if mends(limit.loosened(now, middle)):
            loose = middle
        else:
            tight = middle
    # Just inside: on the edge itself a single point is feasible, and no solver can prove it.
    return limit.loosened(now, loose * (1.0 + precision / 3.0))
