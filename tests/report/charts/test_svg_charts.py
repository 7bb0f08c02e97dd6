"""Charts: axes and ticks, marks as SVG, and PNG by resvg."""

import sys
from dataclasses import replace
from io import BytesIO
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from stories import story

from ocs_design.common.errors import MissingToolError
from ocs_design.report.charts.chart import (
    MOST_POINTS,
    Axis,
    Chart,
    Curve,
    FilledArea,
    Ink,
    Points,
    Rule,
    thinned,
    tick_text,
)
from ocs_design.report.charts.figures import all_charts
from ocs_design.report.charts.svg import inline_svg, png_of, svg_file, write_charts

SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = "<script>alert('&')</script>\""


def chart(*marks, title="title", **options):
    axis = Axis("value", "m", 0.0, 10.0)
    return Chart("name", title, "seen", axis, axis, marks, **options)


def path_of(classes, svg):
    """Data of the path with these classes."""
    return ET.fromstring(svg).find(f".//{SVG}path[@class='{classes}']").get("d")


def notes(svg):
    """Labels beside marks."""
    texts = ET.fromstring(svg).iter(f"{SVG}text")
    return [text for text in texts if text.get("class") == "note"]


def ticks_below(svg):
    """Tick labels of the lower axis."""
    texts = ET.fromstring(svg).iter(f"{SVG}text")
    ticks = [text for text in texts if text.get("class") == "tick"]
    return [text for text in ticks if text.get("text-anchor") == "middle"]


def centres(svg):
    """Centres of the discs in the order of the marks [px]."""
    circles = ET.fromstring(svg).iter(f"{SVG}circle")
    return np.array([[float(c.get("cx")), float(c.get("cy"))] for c in circles])


def test_points_lie_where_their_values_are():
    values = np.array([0.0, 2.5, 5.0, 10.0])
    x, y = centres(inline_svg(chart(Points(values, values, Ink.BLUE)))).T
    np.testing.assert_allclose((x - x[0]) / (x[-1] - x[0]), values / 10.0, atol=1e-3)
    np.testing.assert_allclose((y - y[0]) / (y[-1] - y[0]), values / 10.0, atol=1e-3)
    assert x[0] < x[-1]
    assert y[0] > y[-1], "up is up"


def test_equal_axes_have_units_of_equal_length():
    corner = np.array([0.0, 4.0, 4.0]), np.array([0.0, 0.0, 4.0])
    origin, right, up = centres(inline_svg(chart(Points(*corner, Ink.BLUE), equal=True)))
    assert right[0] - origin[0] == pytest.approx(right[1] - up[1], abs=0.2)


def test_texts_are_escaped_with_title_and_description():
    x = np.array([1.0, 2.0])
    marks = (
        Curve(x, x, Ink.BLUE, HOSTILE),
        FilledArea(x, x, Ink.SKY, "area"),
        Points(x, x, Ink.GREEN, labels=(HOSTILE, "b")),
        Rule(3.0, upright=True, label=HOSTILE),
        Rule(3.0, upright=False),
    )
    axis = Axis(HOSTILE, "m", 0.0, 10.0)
    drawn = replace(chart(*marks, title=HOSTILE), description=HOSTILE, x=axis, y=axis)
    for content in (inline_svg(drawn), svg_file(drawn).decode()):
        root = ET.fromstring(content)
        assert not list(root.iter(f"{SVG}script"))
        assert root.find(f"{SVG}title").text == root.find(f"{SVG}desc").text == HOSTILE
        assert [text.text for text in root.iter(f"{SVG}text")].count(HOSTILE) == 4


def test_a_file_has_colours_and_an_inline_chart_has_none():
    drawn = chart(Rule(1.0, upright=True))
    assert "#0072b2" in svg_file(drawn).decode()
    assert "#" not in inline_svg(drawn).replace("url(#", "")


def test_a_line_is_broken_at_nan():
    x = np.arange(6.0)
    y = np.array([1.0, 2.0, np.nan, 3.0, 4.0, 5.0])
    assert path_of("line blue", inline_svg(chart(Curve(x, y, Ink.BLUE)))).count("M") == 2


def test_thinning_keeps_ends_and_peaks():
    x = np.linspace(0.0, 1.0, 20_000)
    y = np.sin(40.0 * x)
    y[7777] = 5.0
    few_x, few_y = thinned(x, y)
    assert len(few_x) <= MOST_POINTS + 2
    assert (few_y.max(), few_y.min()) == (5.0, y.min())
    assert (few_x[0], few_x[-1]) == (0.0, 1.0)
    assert set(zip(few_x, few_y, strict=True)) <= set(zip(x, y, strict=True))


def test_labels_avoid_each_other_and_discs():
    near = np.array([5.0, 5.02]), np.array([5.0, 5.01])
    drawn = chart(
        Points(*near, Ink.BLUE, labels=("kick in hop", "off the table")),
        Points(np.array([5.5]), np.array([0.5]), Ink.GREEN),
        Rule(5.1, upright=True, label="alpha 28 deg"),
    )
    first, second, rule = (float(note.get("y")) for note in notes(inline_svg(drawn)))
    assert abs(first - second) > 10.0
    disc = centres(inline_svg(drawn))[2]
    assert not -4.0 < rule - disc[1] < 13.5, "clear of the disc"


@pytest.mark.parametrize("rise", [0.0, 2.0])
def test_curves_do_not_cross_the_labels_of_their_points(rise):
    """Also not a straight curve, of which only the ends are drawn."""
    x, y = np.array([0.5, 6.0]), np.array([5.0, 5.0 + rise])
    svg = inline_svg(chart(Curve(x, y, Ink.BLUE), Points(x, y, Ink.BLUE, labels=("50 %", "99 %"))))
    slope = np.polyfit(*centres(svg).T, 1)
    first, _ = labels = notes(svg)
    assert [label.text for label in labels] == ["50 %", "99 %"]
    ends = float(first.get("x")) + np.array([0.0, 25.0])
    baseline = float(first.get("y"))
    line = np.polyval(slope, ends)
    assert (line > baseline).all() or (line < baseline - 8.0).all()


def test_the_label_of_a_rule_avoids_curves():
    x = np.linspace(0.0, 10.0, 200)
    low = Curve(x, np.where(x > 8.0, 4.0, 0.3), Ink.BLUE)
    high = Curve(x, np.full(200, 9.8), Ink.GREEN)
    root = ET.fromstring(inline_svg(chart(low, high, Rule(2.0, upright=True, label="touchdown"))))
    texts = root.iter(f"{SVG}text")
    (label,) = (float(text.get("y")) for text in texts if text.text == "touchdown")
    top, bottom = map(float, root.get("data-y").split())
    height = (bottom - label) / (bottom - top)
    assert 0.07 < height < 0.9


def test_the_label_of_a_rule_moves_to_its_left_where_the_right_is_full():
    levels = np.linspace(0.0, 10.0, 41)
    curves = [Curve(np.array([5.0, 9.0]), np.array([y, y]), Ink.BLUE) for y in levels]
    svg = inline_svg(chart(*curves, Rule(5.0, upright=True, label="touchdown")))
    (label,) = notes(svg)
    assert label.get("text-anchor") == "end"


def test_the_label_of_a_rule_stays_off_the_axis_where_all_is_full():
    """The tick labels are below; a curve through the label is the lesser evil."""
    levels = np.linspace(0.0, 10.0, 41)
    curves = [Curve(np.array([1.0, 6.0]), np.array([y, y]), Ink.BLUE) for y in levels]
    svg = inline_svg(chart(*curves, Rule(2.0, upright=True, label="touchdown")))
    (label,) = notes(svg)
    axis = min(float(tick.get("y")) for tick in ticks_below(svg))
    assert float(label.get("y")) < axis - 12.0


def test_rules_of_one_name_are_in_the_legend_once():
    rules = (Rule(side, upright=False, name="allowed") for side in (2.0, 8.0))
    root = ET.fromstring(inline_svg(chart(*rules)))
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert texts.count("allowed") == 1


def test_a_level_stretch_is_drawn_by_its_ends():
    x = np.linspace(0.0, 10.0, 300)
    shape = np.concatenate([x, x[::-1]]), np.concatenate([np.full(300, 8.0), np.full(300, 2.0)])
    assert (
        path_of("area fill-faint", inline_svg(chart(FilledArea(*shape, Ink.FAINT)))).count("L") == 3
    )


ENDS = st.tuples(st.floats(-1e6, 1e6), st.floats(1e-6, 1e7))


@given(ENDS, st.sampled_from(["", "deg", "rpm"]))
def test_ticks_lie_on_the_axis_at_equal_round_distances(ends, unit):
    low, span = ends
    axis = Axis("x", unit, low, low + span)
    ticks = np.array(axis.ticks())
    slack = 1e-6 * span + 1e-9
    assert ((ticks >= low - slack) & (ticks <= low + span + slack)).all()
    assert len(ticks) <= 8
    if len(ticks) > 2:
        np.testing.assert_allclose(np.diff(ticks), np.diff(ticks)[0], rtol=1e-3, atol=1e-10)


def test_angles_have_ticks_at_usual_angles():
    assert Axis("pitch", "deg", -380.0, 20.0).ticks() == [-360.0, -270.0, -180.0, -90.0, 0.0]
    assert Axis("alpha", "deg", 0.0, 90.0).ticks() == [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0]


def test_a_logarithmic_axis_has_equal_ratios_at_equal_distances():
    axis = Axis("I", "kg m2", 1e-6, 1e-2, log=True)
    np.testing.assert_allclose(axis.fractions(np.array([1e-6, 1e-4, 1e-2])), [0.0, 0.5, 1.0])
    np.testing.assert_allclose(axis.ticks(), [1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
    # A narrow one has ticks between the powers.
    np.testing.assert_allclose(Axis("I", "", 1.1e-5, 8e-5, log=True).ticks(), [2e-5, 5e-5])


def test_an_axis_of_equal_or_no_values_has_a_width():
    for values in ([3.0, 3.0], [3.0, 3.0 + 1e-12], [0.0], [], [np.nan]):
        axis = Axis.around("x", "m", values)
        assert axis.low < axis.high
        assert len(axis.ticks()) > 1


def test_numbers_are_short_and_typeset():
    texts = {
        0.0: "0",
        -0.25: "\N{MINUS SIGN}0.25",
        20000.0: "20\N{THIN SPACE}000",
        1e-4: "10⁻⁴",
        5e-5: "5·10⁻⁵",
    }
    assert {value: tick_text(value) for value in texts} == texts


@pytest.mark.parametrize("extreme", [np.nan, np.inf, -np.inf, 1.7e308, -1.7e308])
def test_extreme_values_do_not_stretch_an_axis(extreme):
    axis = Axis.around("tilt", "deg", [0.0, extreme, 10.0, -extreme])
    assert (axis.low, axis.high) == pytest.approx((-0.6, 10.6))
    assert axis.ticks()[-1] == 10.0
    parts = axis.fractions(np.array([extreme, 5.0]))
    assert np.isnan(parts[0]) or abs(parts[0]) <= 1e3
    assert parts[1] == pytest.approx(0.5)


def pixels(chart):
    content = png_of(svg_file(chart).decode())
    return np.asarray(Image.open(BytesIO(content)).convert("RGB")).astype(int)


@pytest.mark.slow
def test_a_png_is_twice_as_large_as_its_svg_and_reproducible():
    drawn = next(figure for figure in all_charts(story()) if figure.name == "bound_pitch")
    image = pixels(drawn)
    assert image.shape == (2 * drawn.height, 880, 3)
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 20
    assert png_of(svg_file(drawn).decode()) == png_of(svg_file(replace(drawn)).decode())


@pytest.mark.parametrize("letters", ["Maß α*", "10⁻⁴ m² −1 …", "Ж"])
def test_every_letter_has_a_glyph(letters):
    """Pictures with one letter as title differ from those without title or with a missing glyph."""
    blank = pixels(chart(title=""))
    # A letter that the font lacks would be drawn as a box.
    unknown = pixels(chart(title="\ue000"))
    for letter in letters.replace(" ", ""):
        drawn = pixels(chart(title=letter))
        assert (drawn != blank).any(axis=2).sum() > 4
        assert (drawn != unknown).any()


def test_text_is_narrower_than_the_layout_assumes():
    """The layout of the SVG assumes letters of 6.2 px on average."""
    drawn = pixels(chart(title="an ordinary title of a chart"))
    blank = pixels(chart(title=""))
    columns = np.flatnonzero((drawn != blank).any(axis=(0, 2)))
    assert columns.max() - 8 < 2 * 28 * 6.2 * 13 / 11


def test_without_resvg_the_svg_is_written_with_a_note(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "resvg_py", None)
    with pytest.raises(MissingToolError) as caught:
        pixels(chart())
    assert "ocs-design[plot]" in caught.value.hint
    (note,) = write_charts([chart()], tmp_path)
    assert "resvg-py is not installed: pip install 'ocs-design[plot]'" in note
    assert [path.name for path in tmp_path.iterdir()] == ["name.svg"]
