"""How a quantity is spread that nobody knows exactly.

Drawn by the inverse of its distribution function from one number between 0 and 1: then another
distribution of one quantity leaves what is drawn of the others as it was.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from statistics import NormalDist

CUT = 3.0
"""Standard deviations at which a normal distribution ends: no part is off by ten."""

_STANDARD = NormalDist()
_TAIL = _STANDARD.cdf(-CUT)


class Distribution(ABC):
    """Of one quantity, SI."""

    @abstractmethod
    def at(self, part: float) -> float:
        """The value that a `part` of all, 0..1, lie below."""

    @abstractmethod
    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """As `normal(0.0, 0.01)`, each number as `quantity` writes it."""


@dataclass(frozen=True)
class Constant(Distribution):
    """Always the same."""

    value: float

    def at(self, part: float) -> float:
        """The value."""
        del part
        return self.value

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """The bare quantity."""
        return quantity(self.value)


@dataclass(frozen=True)
class Uniform(Distribution):
    """Between two ends, `low <= high`."""

    low: float
    high: float

    def at(self, part: float) -> float:
        """Linear."""
        return self.low + part * (self.high - self.low)

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """See `Distribution.written`."""
        return f"uniform({quantity(self.low)}, {quantity(self.high)})"


@dataclass(frozen=True)
class Normal(Distribution):
    """Around a mean, cut off at `CUT` standard deviations."""

    mean: float
    deviation: float

    def at(self, part: float) -> float:
        """The inverse of the cut normal distribution function."""
        return self.mean + self.deviation * _STANDARD.inv_cdf(_TAIL + part * (1.0 - 2.0 * _TAIL))

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """See `Distribution.written`."""
        return f"normal({quantity(self.mean)}, {quantity(self.deviation)})"
