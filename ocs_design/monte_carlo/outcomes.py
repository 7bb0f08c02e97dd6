"""What came of samples, as arrays; and as a compact file."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.export.single_file import whole_file
from ocs_design.monte_carlo.reality import NAMES
from ocs_design.simulation.metrics import Metrics
from ocs_design.simulation.verdict import Fault, Verdict

METRICS = tuple(field.name for field in fields(Metrics))
"""Every figure of a flight, in order."""

FAULTS = tuple(Fault)
"""A code of n > 0 is the fault n - 1; 0 is a pass."""


@dataclass(frozen=True, eq=False)
class Outcomes:
    """Of n samples in s scenarios.

    Attributes:
        index: of each sample, shape (n,).
        values: that were drawn, in the order of `NAMES` (SI), shape (n, len(NAMES)).
        metrics: in the order of `METRICS`, NaN where there is none (SI), (n, s, len(METRICS)).
        codes: 0 for a pass, otherwise of the fault, see `FAULTS`, shape (n, s).
    """

    index: NDArray[np.int64]
    values: FloatArray
    metrics: FloatArray
    codes: NDArray[np.int8]

    @classmethod
    def joined(cls, parts: Sequence["Outcomes"]) -> "Outcomes":
        """Several, one after the other."""
        names = [field.name for field in fields(cls)]
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    @property
    def passed(self) -> NDArray[np.bool_]:
        """Shape (n, s)."""
        return np.asarray(self.codes == 0)

    def metric(self, name: str) -> FloatArray:
        """One figure of every flight, shape (n, s)."""
        return np.asarray(self.metrics[:, :, METRICS.index(name)])

    def take(self, rows: slice) -> "Outcomes":
        """Some of the samples."""
        return Outcomes(*(getattr(self, field.name)[rows] for field in fields(self)))

    def save(self, path: Path) -> None:
        """Write a file that appears complete or not at all."""
        with whole_file(path) as unfinished, unfinished.open("wb") as stream:
            np.savez_compressed(
                stream,
                index=self.index,
                values=self.values,
                metrics=self.metrics,
                codes=self.codes,
                names=np.array(NAMES),
                figures=np.array(METRICS),
            )

    @classmethod
    def load(cls, path: Path) -> "Outcomes":
        """What `save` wrote."""
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            return cls(*(stored[field.name] for field in fields(cls)))


def code_of(verdict: Verdict) -> int:
    """See `FAULTS`."""
    return 0 if verdict.fault is None else 1 + FAULTS.index(verdict.fault)
