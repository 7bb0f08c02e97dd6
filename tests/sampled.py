"""Which of many alike cases the gate takes: the rest is for `-m exhaustive`."""

import pytest


def every(step, cases):
    """Each `step`-th case is slow, the others are exhaustive."""
    return [
        pytest.param(case, marks=pytest.mark.exhaustive if index % step else pytest.mark.slow)
        for index, case in enumerate(cases)
    ]
