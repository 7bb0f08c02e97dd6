"""One robot with its device, drawn from the distributions of reality."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.monte_carlo.reality import KEYS, NAMES, PARTS, Reality


@dataclass(frozen=True, eq=False)
class Sample:
    """What was drawn, in the order of `NAMES`.

    Attributes:
        seed, index: which the values follow from, whatever else is drawn with them.
        values: SI, shape (len(NAMES),).
    """

    seed: int
    index: int
    values: FloatArray

    @classmethod
    def draw(cls, reality: Reality, seed: int, index: int) -> "Sample":
        """Sample `index` of `seed`, by a counter-based generator of its own."""
        generator = np.random.Generator(np.random.Philox(_sequence(seed, index)))
        parts = generator.random(len(NAMES)).tolist()
        spreads = reality.by_name.values()
        values = [spread.at(part) for spread, part in zip(spreads, parts, strict=True)]
        return cls(seed, index, np.array(values))

    def of(self, key: str) -> FloatArray:
        """All parts of a key of `[reality]`, shape (parts,)."""
        return self.values[_PLACES[key]]

    def only(self, key: str) -> float:
        """Of a key that has no parts."""
        return float(self.of(key)[0])

    def noise(self, flight: int) -> np.random.SeedSequence:
        """Where the noise of a flight by its number comes from."""
        return _sequence(self.seed, self.index, flight)


def _sequence(seed: int, *key: int) -> np.random.SeedSequence:
    return np.random.SeedSequence(seed, spawn_key=key)


_ENDS = np.cumsum([len(PARTS.get(key, ("",))) for key in KEYS]).tolist()
_PLACES = {
    key: slice(end - len(PARTS.get(key, ("",))), end) for key, end in zip(KEYS, _ENDS, strict=True)
}
