"""The limits of the specification by name."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any, TypeVar

from ocs_design.common.units import round_outwards
from ocs_design.requirement.froude import Envelope
from ocs_design.requirement.requirement import Requirement

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
        """Limits with this one alone changed."""
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
        """Text with three digits, rounded to the loose side."""
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
"""Limits of the envelope, in the order in which they are reported."""

WHEEL_SPEED = Limit("wheel_speed_max", "wheel_speed_max", "wheel_speed_max", True, "rpm", 30.0 / pi)
BUS_VOLTAGE = Limit("bus_voltage", "bus_voltage", "bus_voltage", True, "V", 1.0)
BUS_POWER = Limit("bus_power", "supply.power_max", "power", True, "W", 1.0)
TIME = Limit("time", "time for every maneuver", "", True, "times what is given", 1.0)

DEVICE_MASS = Limit("mass_max", "mass_max", "mass_max", True, "g", 1e3)

LIMITS: Mapping[str, Limit] = {
    limit.name: limit
    for limit in (*RIM_LIMITS, WHEEL_SPEED, BUS_VOLTAGE, BUS_POWER, TIME, DEVICE_MASS)
}
"""All limits by name."""
