import sys
from io import BytesIO

import numpy as np
import pytest
from matplotlib.image import imread
from stories import story

from ocs_design.exceptions import MissingToolError
from ocs_design.report.charts.png import png_chart
from ocs_design.report.figures.figures import all_charts


def test_a_chart_is_drawn_twice_as_large_as_in_svg():
    charts = {chart.name: chart for chart in all_charts(story())}
    image = imread(BytesIO(png_chart(charts["bound_pitch"])))
    assert image.shape[:2] == (2 * charts["bound_pitch"].height, 880)
    assert len(np.unique(image.reshape(-1, 4), axis=0)) > 20


def test_without_matplotlib_it_is_told_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingToolError) as caught:
        png_chart(next(all_charts(story())))
    assert "ocs-design[plot]" in caught.value.hint
