"""The array type of the package, and arrays that cannot be written to."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]


def frozen(values: ArrayLike | Sequence[float]) -> FloatArray:
    """A read-only copy of `values` as float64, so that frozen dataclasses are frozen throughout."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
