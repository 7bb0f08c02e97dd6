"""What the drawing's PDF holds, and what a reader makes of it."""

import re
import shutil
import subprocess

import numpy as np
import pytest
from drawn_wheels import FLAT

from ocs_design.export.drawing.sheet import OUTLINE, Circle, Line
from ocs_design.export.drawing.wheel_sheet import draw_wheel, wheel_sheet
from ocs_design.export.drawing.writers import pdf_of_pages

PDF = draw_wheel(FLAT)["pdf"]
NUMBER = rb"-?\d*\.?\d+"


def test_the_table_says_where_each_object_begins():
    start = int(re.search(rb"startxref\n(\d+)\n%%EOF\s*$", PDF)[1])
    assert PDF[start:].startswith(b"xref\n0 ")
    offsets = re.findall(rb"(\d{10}) 00000 n ", PDF)
    for number, offset in enumerate(offsets, start=1):
        assert PDF[int(offset) :].startswith(b"%d 0 obj\n" % number)
    assert len(offsets) >= 5


def test_the_page_is_a4_and_there_is_one():
    width, height = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", PDF).groups()
    assert float(width) / 72.0 * 25.4 == pytest.approx(297.0, abs=1e-3)
    assert float(height) / 72.0 * 25.4 == pytest.approx(210.0, abs=1e-3)
    assert len(re.findall(rb"/Type /Page\b", PDF)) == 1


def test_circles_are_round():
    content = pdf_of_pages([[Circle((100.0, 60.0), 40.0, OUTLINE)]], "")
    curves = re.findall(rb"((?:%b ){6})c\b" % NUMBER, content)
    start = np.array(re.search(rb"n\s(%b) (%b) m\s" % (NUMBER, NUMBER), content).groups(), float)
    first = start
    for curve in curves:
        handles = np.array(curve.split(), float).reshape(3, 2)
        points = [start, *handles]
        for t in np.linspace(0.0, 1.0, 21):
            weights = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3]
            at = sum(w * p for w, p in zip(weights, points, strict=True))
            assert np.hypot(*(at - [100.0, 150.0])) == pytest.approx(40.0, rel=5e-4)
        start = handles[2]
    assert len(curves) == 4
    np.testing.assert_allclose(start, first)


def test_every_line_of_the_sheet_is_drawn():
    lines = [item for item in wheel_sheet(FLAT) if isinstance(item, Line)]
    drawn = re.findall(rb"n (%b) (%b) m (%b) (%b) l S" % ((NUMBER,) * 4), PDF)
    expected = [(*each.start, *each.end) for each in lines]
    np.testing.assert_allclose(
        np.array(drawn, float), np.array(expected) * [1, -1, 1, -1] + [0, 210, 0, 210], atol=1e-4
    )


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="poppler is not installed")
def test_a_reader_finds_the_texts(tmp_path):
    path = tmp_path / "wheel.pdf"
    path.write_bytes(PDF)
    done = subprocess.run(["pdftotext", "-layout", path, "-"], capture_output=True, check=True)
    text = done.stdout.decode()
    for label in ("Ø8 H7", "4 × Ø3.4 through", "ISO 2768-mK", "35.95 kg mm²", "OCS flywheel"):
        assert label in text
    assert done.stderr == b""
