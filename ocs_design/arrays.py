"""The array type of the package, and arrays that cannot be written to."""

from collections.abc import Sequence
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

Number = TypeVar("Number", np.float64, np.bool_)


def frozen(values: ArrayLike | Sequence[float]) -> FloatArray:
    """A read-only copy of `values` as float64, so that frozen dataclasses are frozen throughout."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def vector(values: FloatArray) -> Vector:
    """Three numbers as a tuple."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def matrix(values: FloatArray) -> Matrix:
    """Three rows as tuples."""
    first, second, third = (vector(row) for row in values)
    return first, second, third


def put_rows(
    values: NDArray[Number], rows: NDArray[np.intp], others: NDArray[Number]
) -> NDArray[Number]:
    """A copy with other values in these rows."""
    copy = values.copy()
    copy[rows] = others
    return copy
