"""A distribution as the specification writes it: `normal(0, 2%)`, `uniform(1ms, 3ms)`, `0.1deg`."""

import math
import re
from dataclasses import dataclass

from ocs_design.exceptions import QuantityError
from ocs_design.requirement.distributions import Constant, Distribution, Normal, Uniform
from ocs_design.requirement.values import Quantity, Value
from ocs_design.units import Dimension, format_quantity, parse_quantity

_FORM = re.compile(r"\s*(normal|uniform)\s*\(([^,()]*),([^,()]*)\)\s*")


@dataclass(frozen=True)
class Spread(Value[Distribution]):
    """A quantity, or how it is spread.

    Attributes:
        dimension: what it measures.
        unit: that people think in.
        least, most: that it can be at all (SI).
    """

    dimension: Dimension
    unit: str
    least: float = -math.inf
    most: float = math.inf

    @property
    def takes(self) -> str:
        """See `Value.takes`."""
        return f"{Quantity(self.dimension).takes}; or how it is spread"

    def read(self, raw: object, where: str) -> Distribution:
        """See `Value.read`."""
        found = self._read(raw, where)
        low, high = found.at(0.0), found.at(1.0)
        for end, beyond in ((low, low < self.least), (high, high > self.most)):
            if beyond:
                limit = self.least if end < self.least else self.most
                told, bound = (format_quantity(value, self.unit) for value in (end, limit))
                raise QuantityError(
                    f"{where}: {raw} reaches {told}, beyond {bound}",
                    hint="Make it narrower; a normal distribution ends at three deviations.",
                )
        return found

    def _read(self, raw: object, where: str) -> Distribution:
        match = _FORM.fullmatch(raw) if isinstance(raw, str) else None
        if match is None:
            if isinstance(raw, str) and "(" in raw:
                raise QuantityError(
                    f"{where}: {raw!r} is no distribution",
                    hint="Write normal(MEAN, DEVIATION), uniform(LOW, HIGH) or one quantity.",
                )
            return Constant(parse_quantity(raw, self.dimension, where))
        kind = match[1]
        first, second = (
            parse_quantity(text.strip(), self.dimension, where) for text in match.groups()[1:]
        )
        if kind == "normal" and second < 0.0:
            raise QuantityError(f"{where}: {raw}: the deviation must be zero or positive")
        if kind == "uniform" and second < first:
            raise QuantityError(f"{where}: {raw}: the low end comes first")
        return Normal(first, second) if kind == "normal" else Uniform(first, second)
