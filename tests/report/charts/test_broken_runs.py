"""Axes of runs that broke down."""

import numpy as np
import pytest

from ocs_design.report.charts.scales import Axis


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf, 1.7e308, -1.7e308])
def test_what_is_beyond_measure_stretches_no_axis(odd):
    axis = Axis.around("tilt", "deg", [0.0, odd, 10.0, -odd])
    assert (axis.low, axis.high) == pytest.approx((-0.6, 10.6))
    assert axis.ticks()[-1] == 10.0
    parts = axis.parts(np.array([odd, 5.0]))
    assert np.isnan(parts[0]) or abs(parts[0]) <= 1e3
    assert parts[1] == pytest.approx(0.5)
