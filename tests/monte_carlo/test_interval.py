"""The exact interval against SciPy's, and its promise by brute force."""

import numpy as np
import pytest
from scipy import stats

from ocs_design.monte_carlo.summary import share


@pytest.mark.parametrize("flown", [1, 2, 10, 64, 10_000])
def test_it_is_that_of_scipy(flown):
    for passed in {0, 1, flown // 2, flown - 1, flown}:
        exact = stats.binomtest(passed, flown).proportion_ci(0.95, method="exact")
        found = share(passed, flown)
        assert (found.low, found.high) == pytest.approx((exact.low, exact.high), abs=1e-12)
        assert found.estimate == passed / flown
        assert found.width == found.high - found.low


def test_it_holds_the_truth_at_least_as_often_as_it_says():
    """Summed over all outcomes of 20 trials."""
    intervals = [share(passed, 20) for passed in range(21)]
    for truth in np.linspace(0.01, 0.99, 49):
        holds = [found.low <= truth <= found.high for found in intervals]
        assert stats.binom.pmf(range(21), 20, truth)[holds].sum() >= 0.95
