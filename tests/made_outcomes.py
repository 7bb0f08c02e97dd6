"""Outcomes made up, for what is done with them."""

from dataclasses import fields

import numpy as np

from ocs_design.device.layout import PAIR
from ocs_design.monte_carlo.outcomes import METRICS, Outcomes
from ocs_design.monte_carlo.uncertainty import quantities

NAMES = quantities(PAIR)


def made_outcomes(samples, scenarios=1, *, fail_from=2.0, seed=0):
    """Each sample by itself: the trunk is off level by what its first quantity says, in radians.

    One that is off by more than `fail_from` fails.
    """
    values = np.array([np.random.default_rng([seed, n]).normal(size=len(NAMES)) for n in samples])
    metrics = np.zeros((len(values), scenarios, len(METRICS)))
    metrics[:, :, METRICS.index("touchdown_pitch")] = values[:, :1]
    codes = np.where(np.abs(values[:, :1]) > fail_from, 3, 0).astype(np.int8)
    codes = np.broadcast_to(codes, (len(values), scenarios)).copy()
    return Outcomes(np.array(samples), values, metrics, codes, NAMES)


def assert_same(one, other):
    for field in fields(Outcomes):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))
