import json
from html.parser import HTMLParser

from hypothesis import given, settings
from hypothesis import strategies as st

from ocs_design.report.html.elements import Markup, data, element, items, table
from ocs_design.report.table import Table, Tone, Toned, columns

TABLE = Table(columns("<name", "time [s]"), (("torque", Toned("1.2", Tone.OPEN)),))
TEXT = st.text(st.characters(exclude_categories=["Cs", "Cc"]))


class Reading(HTMLParser):
    """Tags, attributes and texts, as a program that nobody here wrote reads them."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.attributes, self.texts = [], [], []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, text):
        self.texts.append(text)


@given(TEXT, TEXT)
def test_no_text_becomes_an_element_or_an_attribute(text, value):
    page = Reading(element("p", text, title=value, hidden=True))
    assert page.tags == ["p"]
    assert page.attributes == ([("title", value)] if value else []) + [("hidden", None)]
    for power, letter in (("²", "2"), ("³", "3")):
        text = text.replace(power, letter)
        page.texts = [each.replace(power, letter) for each in page.texts]
    assert "".join(page.texts) == text


@settings(max_examples=30)
@given(st.dictionaries(TEXT, TEXT))
def test_data_comes_back_and_cannot_end_its_element(value):
    page = Reading(data("design", json.dumps(value, ensure_ascii=False)))
    assert page.tags == ["script"]
    assert json.loads("".join(page.texts)) == value


def test_markup_stands_as_it_is_and_what_is_not_does_not():
    assert element("p", Markup("<b>x</b>"), "<b>") == "<p><b>x</b>&lt;b&gt;</p>"


def test_units_get_their_powers():
    assert (
        element("p", "4 kg m2, 5 kg m^2, robot_m2, 3 rad/s2")
        == "<p>4 kg m², 5 kg m², robot_m2, 3 rad/s²</p>"
    )


def test_lists_without_anything_are_not_there():
    assert items([]) == ""
    assert Reading(items(["a", "b"])).tags == ["ul", "li", "li"]


def test_tables_have_a_caption_and_heads_for_their_columns():
    page = Reading(table("Margins", TABLE))
    assert " ".join(page.tags) == "div table caption thead tr th th tbody tr td td span"
    assert page.attributes.count(("scope", "col")) == 2
    assert page.texts == ["Margins", "name", "time [s]", "torque", "1.2"]
    assert page.attributes.count(("class", "number")) == 2
    assert page.attributes.count(("class", "mark open")) == 1
