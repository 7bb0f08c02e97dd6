"""Demand against capacity, and the worst of several maneuvers."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Margin:
    """What is asked of one part against what it stands.

    Attributes:
        name: of the quantity; one name is one kind of margin.
        demand: largest that is asked, never negative.
        capacity: what the part stands; None: no limit, or none known, and `note` says which.
        unit: of both, SI.
        note: what the figures rest on, one sentence; empty if there is nothing to say.
        maneuver: that asks it; empty if none does.
        of_motion: whether a maneuver has any part in it.
    """

    name: str
    demand: float
    capacity: float | None
    unit: str
    note: str = ""
    maneuver: str = ""
    of_motion: bool = True

    @property
    def factor(self) -> float | None:
        """Capacity over demand: below 1 it is exceeded; None: no limit, or nothing asked."""
        return None if self.capacity is None or self.demand == 0.0 else self.capacity / self.demand

    @property
    def _strain(self) -> tuple[float, float]:
        """Grows with what is asked, and with its share of the capacity first."""
        factor = self.factor
        return (0.0 if factor is None else 1.0 / factor, self.demand)


def worst(by_maneuver: Mapping[str, Iterable[Margin]]) -> tuple[Margin, ...]:
    """The smallest margin of each kind, with the maneuver that sets it, in the order they come.

    Where there is no capacity it is the largest demand.

    Args:
        by_maneuver: the margins of each maneuver by its name.
    """
    found: dict[str, Margin] = {}
    for name, margins in by_maneuver.items():
        for margin in margins:
            kept = found.get(margin.name)
            if kept is None or margin._strain > kept._strain:
                found[margin.name] = replace(margin, maneuver=name if margin.of_motion else "")
    return tuple(found.values())
