"""Words on pictures, and pictures as a film: MP4 where there is ffmpeg, else GIF."""

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from ocs_design.export.programs import ffmpeg_program

Picture: TypeAlias = NDArray[np.uint8]
"""Red, green and blue, shape (height, width, 3)."""

SIZE = 18
"""Height of letters [pixels]."""

MARGIN = 10
INK, GOOD, BAD = (30, 30, 35), (20, 120, 50), (170, 40, 40)
_PAPER = (255, 255, 255)
_HALO = 2
"""Width of the paper around letters, so that they are read before anything [pixels]."""

GIF_EVERY = 2
"""Every so many frames one is in a GIF, which packs badly."""

GIF_COLORS = 128

_SAMPLES = 8
"""Frames that a GIF's colours are chosen from."""

_TIME_LIMIT = 300.0
"""Longest time that ffmpeg may take [s]."""


def captioned(picture: Picture, title: str, good: bool | None, lines: Sequence[str]) -> Picture:
    """The picture with a title, in a colour for how it went if that is known, and lines below."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(SIZE)
    color = INK if good is None else GOOD if good else BAD
    leading = SIZE + 6
    top = image.height - MARGIN - leading * len(lines)
    below = ((top + place * leading, line, INK) for place, line in enumerate(lines))
    for height, text, ink in ((MARGIN, title, color), *below):
        draw.text((MARGIN, height), text, ink, font, stroke_width=_HALO, stroke_fill=_PAPER)
    return np.asarray(image)


def encode(pictures: Sequence[Picture], seconds: float, stem: Path) -> Path:
    """Write a film of pictures of one even size, one every so many seconds.

    Its path is `stem` with the suffix of what could be made.
    """
    program = ffmpeg_program()
    if program is not None and _mp4(program, pictures, seconds, stem.with_suffix(".mp4")):
        return stem.with_suffix(".mp4")
    return _gif(pictures[::GIF_EVERY], GIF_EVERY * seconds, stem.with_suffix(".gif"))


def _mp4(program: str, pictures: Sequence[Picture], seconds: float, path: Path) -> bool:
    """Write H.264, which all browsers play; gives whether it worked."""
    height, width, _ = pictures[0].shape
    source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
    codec = ["-c:v", "libx264", "-crf", "23", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    try:
        done = subprocess.run(
            [program, "-y", *source, "-r", f"{1.0 / seconds:.6f}", "-i", "-", *codec, str(path)],
            input=b"".join(picture.tobytes() for picture in pictures),
            capture_output=True,
            check=False,
            timeout=_TIME_LIMIT,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    if done.returncode:
        path.unlink(missing_ok=True)
    return done.returncode == 0


def _gif(pictures: Sequence[Picture], seconds: float, path: Path) -> Path:
    """Write all frames in the colours of some: one palette is small, and nothing flickers."""
    some = pictures[:: max(1, len(pictures) // _SAMPLES)]
    palette = Image.fromarray(np.concatenate(some)).quantize(GIF_COLORS)
    # Dithered colours pack badly: twice the size and more.
    plain = Image.Dither.NONE
    frames = [Image.fromarray(each).quantize(palette=palette, dither=plain) for each in pictures]
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=round(1e3 * seconds), loop=0
    )
    return path
