"""Text inserted into XML files of every kind: the rest stays byte for byte."""

import re
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.common.errors import RobotError
from ocs_design.export.urdf import insert_before_end

ADDITION = '  <link name="a"/>\n  <link name="b"/>\n'

PLAIN = '<robot name="r">\n  <link name="été"/>\n</robot>\n'
TEXTS = {
    "plain": PLAIN,
    "one line": '<robot name="r"><link name="l"/></robot>',
    "comment behind": PLAIN + "<!-- </robot> -->\n",
    "comment before": PLAIN.replace("</robot>", "<!-- </robot> --></robot>"),
    "cdata": PLAIN.replace("</robot>", "<![CDATA[</robot>]]></robot>"),
    "instruction": PLAIN + "<?pi </robot> ?>",
    "space in tag": PLAIN.replace("</robot>", "</robot  >"),
    "nested": PLAIN.replace("</robot>", "<robot></robot></robot>"),
    "doctype": '<!DOCTYPE robot [<!ENTITY e "</robot>">]>\n' + PLAIN,
}
ENCODINGS = ["utf-8", "utf-8-sig", "utf-16", "utf-16-le-bom", "utf-16-be-bom", "iso-8859-1"]


def encoded(text, encoding):
    """The text as bytes, with a declaration where XML needs one."""
    if encoding == "iso-8859-1":
        return f'<?xml version="1.0" encoding="{encoding}"?>\n{text}'.encode(encoding)
    if encoding.endswith("-bom"):
        return ("\ufeff" + text).encode(encoding.removesuffix("-bom"))
    return text.encode(encoding)


def inserted(content):
    """The result and the bytes inserted into the user's."""
    result = insert_before_end(content, ADDITION)
    length = len(result) - len(content)
    places = [i for i in range(len(content) + 1) if content[:i] == result[:i]]
    place = next(i for i in reversed(places) if content[i:] == result[i + length :])
    return result, result[place : place + length]


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS.keys())
def test_the_users_bytes_stay_and_the_addition_is_last(text, encoding):
    content = encoded(text, encoding)
    result, _ = inserted(content)
    before, after = ET.fromstring(content), ET.fromstring(result)
    assert [child.get("name") for child in after] == [
        *(child.get("name") for child in before),
        "a",
        "b",
    ]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_line_ends_are_those_of_the_file(encoding):
    _, addition = inserted(PLAIN.replace("\n", "\r\n").encode(encoding))
    assert addition.count("\r\n".encode("utf-16-le" if encoding == "utf-16" else "ascii")) == 2
    _, addition = inserted(PLAIN.encode(encoding))
    assert b"\r" not in addition


def test_undeclared_latin_1_is_kept():
    content = PLAIN.encode("latin-1")
    result, _ = inserted(content)
    assert "été".encode("latin-1") in result


def test_characters_that_the_encoding_lacks_become_references():
    content = encoded(PLAIN, "iso-8859-1")
    result = insert_before_end(content, '<link name="机"/>\n')
    assert ET.fromstring(result)[-1].get("name") == "机"


def test_an_empty_root_is_refused():
    with pytest.raises(RobotError, match="empty"):
        insert_before_end(b'<robot name="r"/>', ADDITION)


@given(st.text("ab -<>&?!]é机\n"), st.sampled_from(ENCODINGS))
def test_any_comment_behind_the_robot_is_kept(comment, encoding):
    if encoding == "iso-8859-1":
        comment = comment.encode("latin-1", "ignore").decode("latin-1")
    comment = re.sub("-+", "-", comment).rstrip("-")
    content = encoded(f"{PLAIN}<!--{comment}-->", encoding)
    result, _ = inserted(content)
    assert len(ET.fromstring(result)) == 3
