"""The supply that feeds all motors."""

from dataclasses import dataclass, replace
from math import inf

from ocs_design.common.ranges import Capacity, Positive


@dataclass(frozen=True)
class Supply:
    """A battery or power supply, with limits on what it delivers and accepts back.

    Attributes:
        voltage: [V].
        current_max: drawn or fed back, of all motors together [A]; inf: not limited.
        power_max: drawn or fed back, of all motors together [W]; inf: not limited.
    """

    voltage: Positive
    current_max: Capacity = inf
    power_max: Capacity = inf

    @property
    def power(self) -> float:
        """Power that both limits allow [W]."""
        return min(self.power_max, self.voltage * self.current_max)

    @property
    def explicit(self) -> "Supply":
        """The supply with both limits made explicit, for records."""
        return replace(self, current_max=self.power / self.voltage, power_max=self.power)
