"""The array type of the package, read-only arrays, and tables of equal-length columns."""

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance
else:
    DataclassInstance = object

FloatArray: TypeAlias = NDArray[np.float64]

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]


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


def finite_or_none(limit: float | FloatArray) -> float | None:
    """A limit as a number; None if it is infinite, that is, if there is no limit."""
    return float(limit) if np.isfinite(limit) else None


class Table(DataclassInstance):
    """Equal-length columns: the base of frozen dataclasses whose arrays have one row per entry.

    A column is an array with the rows along its first axis, or a table itself. Every other field,
    a number or a sequence that all rows share, is carried along unchanged.
    """

    def take(self, rows: NDArray[np.intp] | NDArray[np.bool_] | slice | int) -> Self:
        """Table of the rows selected by indices, a slice or a mask.

        A single index gives that row alone, with scalars.
        """
        return self._combined([self], lambda column: column[rows])

    @classmethod
    def joined(cls, parts: Sequence[Self]) -> Self:
        """Table with the rows of several, one after the other."""
        return cls._combined(parts, lambda *columns: np.concatenate(columns))

    def repeat(self, times: int) -> Self:
        """Table with every row `times` times in a row, shape (n * times,)."""
        return self._combined([self], lambda column: np.repeat(column, times, axis=0))

    def put(self, rows: NDArray[np.intp], others: Self) -> Self:
        """Copy of the table with these rows replaced by those of another."""

        def replaced(column: NDArray[Any], new: NDArray[Any]) -> NDArray[Any]:
            copy = column.copy()
            copy[rows] = new
            return copy

        return self._combined([self, others], replaced)

    @classmethod
    def _combined(cls, parts: Sequence[Self], combine: Callable[..., NDArray[Any]]) -> Self:
        """Table in which each column is made from the columns of that name of several tables."""
        columns: dict[str, Any] = {}
        for field in fields(cls):
            values = [getattr(part, field.name) for part in parts]
            if isinstance(values[0], Table):
                columns[field.name] = type(values[0])._combined(values, combine)
            elif isinstance(values[0], np.ndarray):
                columns[field.name] = combine(*values)
        return replace(parts[0], **columns)


Rows = TypeVar("Rows", bound=Table)


def stacked(rows: Sequence[Rows]) -> Rows:
    """Table of arrays, shape (n,) each, with one row per table of scalars."""
    columns: dict[str, Any] = {}
    for field in fields(rows[0]):
        values = [getattr(row, field.name) for row in rows]
        nested = isinstance(values[0], Table)
        columns[field.name] = stacked(values) if nested else np.array(values, dtype=np.float64)
    return replace(rows[0], **columns)


def stacked_columns(rows: Sequence[Rows]) -> Rows:
    """Table as in `stacked`, with a second axis of length 1 to broadcast, (n, 1) or (n, 1, m)."""
    table = stacked(rows)
    columns = {field.name: getattr(table, field.name)[:, None] for field in fields(table)}
    return replace(table, **columns)


def interpolated(at: FloatArray, samples: FloatArray, values: FloatArray) -> FloatArray:
    """Linear interpolation of values, shape (n, m), given at n `samples`, at k places; (k, m)."""
    return np.column_stack([np.interp(at, samples, column) for column in values.T])
