"""Tables behave like the arrays they are made of."""

from dataclasses import dataclass

import numpy as np
from numpy.testing import assert_array_equal

from ocs_design.common.arrays import FloatArray, Table


@dataclass(frozen=True, eq=False)
class Inner(Table):
    inertia: FloatArray


@dataclass(frozen=True, eq=False)
class Outer(Table):
    mass: FloatArray
    axes: FloatArray
    inner: Inner
    name: str = "shared"


def table(seed, rows=5):
    draw = np.random.default_rng(seed)
    return Outer(draw.random(rows), draw.random((rows, 3)), Inner(draw.random(rows)))


def columns(value):
    return value.mass, value.axes, value.inner.inertia


def test_take_is_indexing_every_column():
    some = table(0)
    for rows in (np.array([4, 0, 0]), np.array([True, False, False, True, False])):
        for taken, column in zip(columns(some.take(rows)), columns(some), strict=True):
            assert_array_equal(taken, column[rows])
    assert some.take(np.array([1])).name == "shared"


def test_repeat_keeps_copies_of_a_row_together():
    for repeated, column in zip(columns(table(1).repeat(3)), columns(table(1)), strict=True):
        assert_array_equal(repeated, column[np.repeat(np.arange(5), 3)])


def test_put_replaces_rows_and_leaves_the_original_alone():
    some, rows = table(2), np.array([3, 1])
    before = [column.copy() for column in columns(some)]
    put = some.put(rows, table(3, rows=2))
    for after, other, column, old in zip(
        columns(put), columns(table(3, rows=2)), columns(some), before, strict=True
    ):
        assert_array_equal(after[rows], other)
        assert_array_equal(after[[0, 2, 4]], old[[0, 2, 4]])
        assert_array_equal(column, old)
