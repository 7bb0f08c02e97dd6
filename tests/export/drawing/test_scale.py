"""Scales of the standard, and the largest that fits."""

from ocs_design.export.drawing.sheet import Scale, largest_scale


def test_a_length_on_paper_and_back():
    assert Scale(2, 1)(0.01) == 20.0
    assert Scale(1, 5)(0.1) == 20.0
    assert Scale(1, 5).length(20.0) == 0.1


def test_all_that_fit_are_smaller():
    tried = []

    def fits(scale):
        tried.append(str(scale))
        return scale(0.3) <= 61.0

    assert str(largest_scale(fits)) == "1:5"
    assert tried == [
        "500:1",
        "200:1",
        "100:1",
        "50:1",
        "20:1",
        "10:1",
        "5:1",
        "2:1",
        "1:1",
        "1:2",
        "1:5",
    ]


def test_the_smallest_if_nothing_fits():
    assert largest_scale(lambda _: False).paper == 1
