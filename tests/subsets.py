"""Marks for many similar cases: which of them are fast, slow and exhaustive."""

import pytest


def slow_subset(step, cases):
    """Every `step`-th case is slow, the others are exhaustive."""
    return [
        pytest.param(case, marks=pytest.mark.exhaustive if index % step else pytest.mark.slow)
        for index, case in enumerate(cases)
    ]


def fast_subset(step, cases, rest=pytest.mark.slow):
    """Every `step`-th case is fast, the others have the mark `rest`; tuples are several values."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=[rest] * bool(i % step))
        for i, case in enumerate(cases)
    ]
