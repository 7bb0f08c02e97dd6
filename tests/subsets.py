"""Which of many alike cases are quick, and which the gate takes: the rest is exhaustive."""

import pytest


def slow_subset(step, cases):
    """Each `step`-th case is slow, the others are exhaustive."""
    return [
        pytest.param(case, marks=pytest.mark.exhaustive if index % step else pytest.mark.slow)
        for index, case in enumerate(cases)
    ]


def fast_subset(step, cases, rest=pytest.mark.slow):
    """Each `step`-th case is quick, the others have this mark; a case of several is a tuple."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=[rest] * bool(i % step))
        for i, case in enumerate(cases)
    ]
