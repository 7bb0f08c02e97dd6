"""Charts as PNG: the SVG, drawn by resvg with our own font."""

import sys
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from stories import story

from ocs_design.common.errors import MissingToolError
from ocs_design.report.charts.chart import Axis, Chart
from ocs_design.report.charts.figures import all_charts
from ocs_design.report.charts.svg import png_file, write_charts


def picture(chart):
    return np.asarray(Image.open(BytesIO(png_file(chart))).convert("RGB")).astype(int)


def chart_titled(title):
    axis = Axis("value", "m", 0.0, 10.0)
    return Chart("name", title, "seen", axis, axis, ())


def test_a_chart_is_drawn_twice_as_large_as_in_svg():
    charts = {chart.name: chart for chart in all_charts(story())}
    image = picture(charts["bound_pitch"])
    assert image.shape == (2 * charts["bound_pitch"].height, 880, 3)
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 20


def test_twice_the_same_chart_gives_the_same_bytes():
    for chart in all_charts(story()):
        assert png_file(chart) == png_file(replace(chart))


@pytest.mark.parametrize("letters", ["Maß α*", "10⁻⁴ m²", "−1 …", "Ж", "A"])
def test_every_letter_has_a_shape_in_our_font(letters):
    """Only the title differs, and each letter leaves ink of its own on it."""
    blank = picture(chart_titled(""))
    for letter in letters.replace(" ", ""):
        drawn = picture(chart_titled(letter))
        assert (drawn != blank).any(axis=2).sum() > 4
        # What the font does not have would be drawn as the same box for all.
        assert (drawn != picture(chart_titled("\ue000"))).any()


def test_words_that_would_run_into_their_neighbours_are_narrower_than_the_layout_says():
    """The layout of the SVG takes letters for 6.2 px wide in the mean."""
    drawn = picture(chart_titled("an ordinary title of a chart"))
    blank = picture(chart_titled(""))
    columns = np.flatnonzero((drawn != blank).any(axis=(0, 2)))
    assert columns.max() - 8 < 2 * 28 * 6.2 * 13 / 11


def test_without_resvg_the_svg_is_written_and_it_is_told_how_to_get_the_rest(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "resvg_py", None)
    with pytest.raises(MissingToolError) as caught:
        png_file(next(all_charts(story())))
    assert "ocs-design[plot]" in caught.value.hint
    (told,) = write_charts([chart_titled("one")], tmp_path)
    assert "resvg-py is not installed: pip install 'ocs-design[plot]'" in told
    assert [path.name for path in tmp_path.iterdir()] == ["name.svg"]
