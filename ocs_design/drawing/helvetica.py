"""Widths of Helvetica, which every PDF reader has: text is measured before it is drawn."""

ENCODING = "cp1252"
"""PDF's WinAnsiEncoding: it has what drawings need, as in `Ø8 H7 ±0.05`."""

CAP_HEIGHT = 0.718
ASCENT = 0.740
DESCENT = 0.212
"""Of capitals, of brackets, and of what hangs below the line, per font size."""

_WIDTHS = """
    278 278 355 556 556 889 667 191 333 333 389 584 278 333 278 278
    556 556 556 556 556 556 556 556 556 556 278 278 584 584 584 556
    1015 667 667 722 722 667 611 778 722 278 500 667 556 833 722 778
    667 778 722 667 611 722 667 944 667 667 611 278 278 278 469 556
    333 556 556 500 556 556 278 556 556 222 222 500 222 833 556 556
    556 556 333 500 278 556 500 722 500 500 500 334 260 334 584 0
    556 0 222 556 333 1000 556 556 333 1000 667 333 1000 0 611 0
    0 222 222 333 333 350 556 1000 333 1000 500 333 944 0 500 667
    278 333 556 556 556 556 260 556 333 737 370 556 584 333 737 333
    400 584 333 333 333 556 537 278 333 333 365 556 834 834 834 611
    667 667 667 667 667 667 1000 722 667 667 667 667 278 278 278 278
    722 722 778 778 778 778 778 584 778 722 722 722 722 667 667 611
    556 556 556 556 556 556 889 500 556 556 556 556 278 278 278 278
    556 556 556 556 556 556 556 584 611 556 556 556 556 500 556 500
"""
"""Per thousandth of the font size, of the codes 32..255; 0: no such character. Adobe Font Metrics
of the 14 base fonts, file Helvetica.afm."""

WIDTHS = dict(enumerate(map(int, _WIDTHS.split()), start=32))

UNKNOWN = "?"


def printable(text: str) -> str:
    """The text with a question mark for each character that Helvetica does not have."""
    return "".join(character if _width(character) else UNKNOWN for character in text)


def text_width(text: str, size: float) -> float:
    """Of printable text at a font size, in the size's unit."""
    return size * sum(_width(character) for character in text) / 1000.0


def _width(character: str) -> int:
    code = character.encode(ENCODING, errors="replace")
    return WIDTHS.get(code[0], 0) if code != b"?" or character == UNKNOWN else 0
