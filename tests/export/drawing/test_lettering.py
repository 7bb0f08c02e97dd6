"""Widths of the sheet's letters, against Adobe's metrics, of which matplotlib has a copy."""

import re
from pathlib import Path

import matplotlib as mpl
import pytest

from ocs_design.export.drawing.sheet import CAP_HEIGHT, Text, printable

METRICS = Path(mpl.get_data_path()) / "fonts" / "pdfcorefonts" / "Helvetica.afm"
FOUND = re.findall(r"^C (\d+) ; WX (\d+) ; N (\w+) ;", METRICS.read_text(), re.MULTILINE)


def width(character):
    """Per thousandth of the font size."""
    return Text((0.0, 0.0), character, CAP_HEIGHT * 1000.0).width


def test_ascii_has_the_widths_of_the_font():
    # Two quotation marks stand elsewhere in Adobe's own encoding.
    own = {chr(int(code)): int(wide) for code, wide, _ in FOUND if int(code) < 127}
    compared = {each: wide for each, wide in own.items() if each not in "'`"}
    assert len(compared) == 93
    assert {each: width(each) for each in compared} == pytest.approx(compared)


@pytest.mark.parametrize(
    ("character", "name"),
    [
        ("Ø", "Oslash"),
        ("±", "plusminus"),
        ("×", "multiply"),
        ("°", "degree"),
        ("–", "endash"),
        ("µ", "mu"),
        ("…", "ellipsis"),
        ("é", "eacute"),
        ("ß", "germandbls"),
        ("²", "twosuperior"),
    ],
)
def test_other_characters_have_the_widths_of_the_font(character, name):
    wide = re.search(rf"WX (\d+) ; N {name} ;", METRICS.read_text())
    assert width(character) == pytest.approx(int(wide[1]))


def test_every_code_that_can_be_encoded_is_printable():
    for code in range(0xA0, 0x100):
        assert printable(chr(code)) == chr(code)


def test_what_the_font_lacks_becomes_a_question_mark():
    assert printable("a机\n≤\x7f\x81?") == "a?????" + "?"
