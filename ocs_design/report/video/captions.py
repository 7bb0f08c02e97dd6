"""Words on a picture."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Picture: TypeAlias = NDArray[np.uint8]

SIZE = 18
"""Of letters [pixels]."""

MARGIN = 10
INK, GOOD, BAD = (30, 30, 35), (20, 120, 50), (170, 40, 40)
_PAPER = (255, 255, 255)
_HALO = 2
"""Around letters, so that they are read before anything [pixels]."""


@dataclass(frozen=True)
class Caption:
    """What is said of one frame.

    Attributes:
        title: at the top. good: its color: whether all went well; None: not known.
        lines: at the bottom.
    """

    title: str
    good: bool | None
    lines: tuple[str, ...]


def captioned(picture: Picture, caption: Caption) -> Picture:
    """The picture with the words on it."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(SIZE)
    color = INK if caption.good is None else GOOD if caption.good else BAD
    _write(draw, font, MARGIN, caption.title, color)
    leading = SIZE + 6
    top = image.height - MARGIN - leading * len(caption.lines)
    for place, line in enumerate(caption.lines):
        _write(draw, font, top + place * leading, line, INK)
    return np.asarray(image)


def _write(
    draw: ImageDraw.ImageDraw,
    font: ImageFont.ImageFont | ImageFont.FreeTypeFont,
    top: int,
    text: str,
    color: tuple[int, int, int],
) -> None:
    draw.text((MARGIN, top), text, color, font, stroke_width=_HALO, stroke_fill=_PAPER)
