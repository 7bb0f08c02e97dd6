"""Widths against Adobe's own metrics, of which matplotlib has a copy."""

import re
from pathlib import Path

import matplotlib as mpl
import pytest

from ocs_design.drawing.helvetica import WIDTHS, printable, text_width

METRICS = Path(mpl.get_data_path()) / "fonts" / "pdfcorefonts" / "Helvetica.afm"


def test_ascii_has_the_widths_of_the_font():
    found = re.findall(r"^C (\d+) ; WX (\d+) ; N", METRICS.read_text(), re.MULTILINE)
    # Two quotation marks stand elsewhere in Adobe's own encoding.
    own = {int(code): int(width) for code, width in found if int(code) < 127}
    compared = {code: width for code, width in own.items() if chr(code) not in "'`"}
    assert len(compared) == 93
    assert {code: WIDTHS[code] for code in compared} == compared


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
    width = re.search(rf"WX (\d+) ; N {name} ;", METRICS.read_text())
    assert text_width(character, 1000.0) == int(width[1])


def test_every_code_that_can_be_encoded_is_printable():
    for code in range(0xA0, 0x100):
        assert printable(chr(code)) == chr(code)


def test_what_the_font_lacks_becomes_a_question_mark():
    assert printable("a机\n≤?") == "a???" + "?"
