"""Text that is filled into templates, whatever it is."""

from xml.dom import minidom

from hypothesis import given
from hypothesis import strategies as st

from ocs_design.export.templates import in_comment


@given(st.text("-a b", max_size=12))
def test_any_text_may_stand_in_a_comment(text):
    whole = minidom.parseString(f"<x><!--{in_comment(text)}--></x>")
    found = whole.documentElement.firstChild.data if in_comment(text) else ""
    assert found.replace(" ", "").rstrip("-") == text.replace(" ", "").rstrip("-")
