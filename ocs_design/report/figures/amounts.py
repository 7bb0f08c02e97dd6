"""Arrays of SI values in the units of an axis."""

from typing import TypeVar

from ocs_design.arrays import FloatArray
from ocs_design.units import to_unit

Amount = TypeVar("Amount", float, FloatArray)


def in_unit(values: Amount, unit: str) -> Amount:
    """One value or many, from SI to `unit`."""
    return values * to_unit(1.0, unit)
