from xml.etree import ElementTree as ET

import numpy as np
import pytest

from ocs_design.report.charts.chart import Area, Axis, Chart, Ink, Line, Points, Rule, thinned
from ocs_design.report.charts.svg import inline_svg, svg_file

SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = "<script>alert('&')</script>\""


def chart(*marks, **options):
    axis = Axis("value", "m", 0.0, 10.0)
    return Chart("name", "title", "seen", axis, axis, marks, **options)


def places(svg):
    """Centres of its discs, in the order of the marks [px]."""
    circles = ET.fromstring(svg).iter(f"{SVG}circle")
    return np.array([[float(c.get("cx")), float(c.get("cy"))] for c in circles])


def test_points_lie_where_their_values_are():
    values = np.array([0.0, 2.5, 5.0, 10.0])
    x, y = places(inline_svg(chart(Points(values, values, Ink.BLUE)))).T
    np.testing.assert_allclose((x - x[0]) / (x[-1] - x[0]), values / 10.0, atol=1e-3)
    np.testing.assert_allclose((y - y[0]) / (y[-1] - y[0]), values / 10.0, atol=1e-3)
    assert x[0] < x[-1]
    assert y[0] > y[-1], "up is up"


def test_units_are_as_long_on_both_axes_where_that_is_asked_for():
    corner = np.array([0.0, 4.0, 4.0]), np.array([0.0, 0.0, 4.0])
    origin, right, up = places(inline_svg(chart(Points(*corner, Ink.BLUE), equal=True)))
    assert right[0] - origin[0] == pytest.approx(right[1] - up[1], abs=0.2)


def test_every_text_is_escaped_and_read_out():
    x = np.array([1.0, 2.0])
    marks = (
        Line(x, x, Ink.BLUE, HOSTILE),
        Area(x, x, Ink.SKY, "area"),
        Points(x, x, Ink.GREEN, labels=(HOSTILE, "b")),
        Rule(3.0, upright=True, label=HOSTILE),
        Rule(3.0, upright=False),
    )
    axis = Axis(HOSTILE, "m", 0.0, 10.0)
    drawn = Chart("name", HOSTILE, HOSTILE, axis, axis, marks)
    for content in (inline_svg(drawn), svg_file(drawn).decode()):
        root = ET.fromstring(content)
        assert not list(root.iter(f"{SVG}script"))
        assert root.find(f"{SVG}title").text == root.find(f"{SVG}desc").text == HOSTILE
        assert [each.text for each in root.iter(f"{SVG}text")].count(HOSTILE) == 4


def test_a_file_has_its_own_colours_and_a_page_has_none():
    drawn = chart(Rule(1.0, upright=True))
    assert "#0072b2" in svg_file(drawn).decode()
    assert "#" not in inline_svg(drawn).replace("url(#", "")


def test_a_line_is_broken_where_its_values_are():
    x = np.arange(6.0)
    y = np.array([1.0, 2.0, np.nan, 3.0, 4.0, 5.0])
    path = ET.fromstring(inline_svg(chart(Line(x, y, Ink.BLUE)))).find(
        f".//{SVG}path[@class='line blue']"
    )
    assert path.get("d").count("M") == 2


def test_thinning_keeps_ends_and_peaks():
    x = np.linspace(0.0, 1.0, 20_000)
    y = np.sin(40.0 * x)
    y[7777] = 5.0
    few_x, few_y = thinned(x, y, 300)
    assert len(few_x) <= 302
    assert (few_y.max(), few_y.min()) == (5.0, y.min())
    assert (few_x[0], few_x[-1]) == (0.0, 1.0)
    assert set(zip(few_x, few_y, strict=True)) <= set(zip(x, y, strict=True))


def test_words_that_would_lie_on_each_other_or_on_a_disc_give_way():
    near = np.array([5.0, 5.02]), np.array([5.0, 5.01])
    drawn = chart(
        Points(*near, Ink.BLUE, labels=("kick in hop", "off the table")),
        Points(np.array([5.5]), np.array([0.5]), Ink.GREEN),
        Rule(5.1, upright=True, label="alpha 28 deg"),
    )
    words = ET.fromstring(inline_svg(drawn)).iter(f"{SVG}text")
    first, second, rule = (float(each.get("y")) for each in words if each.get("class") == "note")
    assert abs(first - second) > 10.0
    disc = places(inline_svg(drawn))[2]
    assert not -4.0 < rule - disc[1] < 13.5, "clear of the disc"


@pytest.mark.parametrize("rise", [0.0, 2.0])
def test_no_curve_strikes_the_words_of_its_points_through(rise):
    """Not a straight one either, of which only the ends are drawn."""
    x, y = np.array([0.5, 6.0]), np.array([5.0, 5.0 + rise])
    svg = inline_svg(chart(Line(x, y, Ink.BLUE), Points(x, y, Ink.BLUE, labels=("50 %", "99 %"))))
    slope = np.polyfit(*places(svg).T, 1)
    words = [each for each in ET.fromstring(svg).iter(f"{SVG}text") if each.get("class") == "note"]
    assert [each.text for each in words] == ["50 %", "99 %"]
    first = words[0]
    ends = float(first.get("x")) + np.array([0.0, 25.0])
    baseline = float(first.get("y"))
    line = np.polyval(slope, ends)
    assert (line > baseline).all() or (line < baseline - 8.0).all()


def test_the_word_at_a_rule_stands_where_no_curve_is():
    x = np.linspace(0.0, 10.0, 200)
    low = Line(x, np.where(x > 8.0, 4.0, 0.3), Ink.BLUE)
    high = Line(x, np.full(200, 9.8), Ink.GREEN)
    root = ET.fromstring(inline_svg(chart(low, high, Rule(2.0, upright=True, label="touchdown"))))
    word = next(
        float(each.get("y")) for each in root.iter(f"{SVG}text") if each.text == "touchdown"
    )
    top, bottom = map(float, root.get("data-y").split())
    height = (bottom - word) / (bottom - top)
    assert 0.07 < height < 0.9


def test_a_rule_with_a_name_is_in_the_legend_once():
    rules = (Rule(side, upright=False, name="allowed") for side in (2.0, 8.0))
    texts = [each.text for each in ET.fromstring(inline_svg(chart(*rules))).iter(f"{SVG}text")]
    assert texts.count("allowed") == 1


def test_a_level_stretch_is_drawn_by_its_ends():
    x = np.linspace(0.0, 10.0, 300)
    shape = np.concatenate([x, x[::-1]]), np.concatenate([np.full(300, 8.0), np.full(300, 2.0)])
    area = ET.fromstring(inline_svg(chart(Area(*shape, Ink.FAINT)))).find(
        f".//{SVG}path[@class='area fill-faint']"
    )
    assert area.get("d").count("L") == 3
