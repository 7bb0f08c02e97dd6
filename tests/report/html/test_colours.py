"""Whether the colours of page and charts can be told apart and read, by everyone."""

import re
from itertools import combinations

import numpy as np
import pytest

from ocs_design.export.templates import template_text
from ocs_design.report.charts.chart import SERIES

# Of linear sRGB, severity 1: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A
# Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15(6), 2009.
SEEN_BY = {
    "all cones": np.eye(3),
    "no red cones": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ]),
    "no green cones": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]),
    "no blue cones": np.array([
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def palettes():
    """Palettes of the page in light and in dark."""
    style = template_text("report/report.css")
    blocks = re.findall(r":root \{(.*?)\}", style, re.DOTALL)[:2]
    return {
        look: dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
        for look, block in zip(("light", "dark"), blocks, strict=True)
    }


def linear(color):
    """Intensities of a colour of the screen (IEC 61966-2-1)."""
    code = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def lab(intensity):
    """CIE L*a*b* of linear sRGB under D65."""
    to_xyz = np.array([
        [0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ])  # fmt: skip
    ratio = to_xyz @ np.clip(intensity, 0.0, 1.0) / [0.95047, 1.0, 1.08883]
    f = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def contrast(one, other):
    """Ratio of WCAG 2.2, success criterion 1.4.3."""
    light, dark = sorted((LUMINANCE @ linear(each) for each in (one, other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("look", ["light", "dark"])
@pytest.mark.parametrize("eyes", SEEN_BY)
def test_curves_are_told_apart(look, eyes):
    palette = palettes()[look]
    seen = {ink: lab(SEEN_BY[eyes] @ linear(palette[ink])) for ink in SERIES}
    for one, other in combinations(SERIES, 2):
        # What is just seen beside each other is 2.3 (M. Mahy and others, 1994).
        assert np.linalg.norm(seen[one] - seen[other]) > 4.0 * 2.3, (one, other)


@pytest.mark.parametrize("look", ["light", "dark"])
def test_words_stand_out_from_what_is_behind_them(look):
    palette = palettes()[look]
    for ink in ("text", "soft", "accent"):
        for back in ("paper", "page"):
            assert contrast(palette[ink], palette[back]) >= 4.5, (ink, back)
    for state in ("good", "bad", "open"):
        assert contrast(palette[state], palette[f"{state}-back"]) >= 4.5, state


@pytest.mark.parametrize("look", ["light", "dark"])
def test_curves_stand_out_from_the_paper(look):
    palette = palettes()[look]
    # The last two are only for a fifth and a sixth curve, which the legend names.
    for ink in SERIES[:4]:
        assert contrast(palette[ink], palette["paper"]) >= 3.0, ink
