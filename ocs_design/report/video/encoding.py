"""Pictures one after another as a file that plays: MP4 where there is ffmpeg, else GIF."""

import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ocs_design.export.ffmpeg import ffmpeg_program

Picture = NDArray[np.uint8]

GIF_EVERY = 2
"""Of the frames are in a GIF, which packs badly."""

GIF_COLORS = 128

_SAMPLES = 8
"""Frames that a GIF's colours are chosen from."""

_TIME_LIMIT = 300.0
"""Of ffmpeg [s]."""


def encode(pictures: Sequence[Picture], seconds: float, stem: Path) -> Path:
    """Write a film beside `stem`, with the suffix of what could be made.

    Args:
        pictures: all of one size, shape (height, width, 3), both even.
        seconds: from one to the next [s].
        stem: path without a suffix.
    """
    program = ffmpeg_program()
    if program is not None and _mp4(program, pictures, seconds, stem.with_suffix(".mp4")):
        return stem.with_suffix(".mp4")
    return _gif(pictures[::GIF_EVERY], GIF_EVERY * seconds, stem.with_suffix(".gif"))


def _mp4(program: str, pictures: Sequence[Picture], seconds: float, path: Path) -> bool:
    """In H.264, which all browsers play; whether it worked."""
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
    """All frames in the colours of some: one palette is small, and nothing flickers."""
    some = pictures[:: max(1, len(pictures) // _SAMPLES)]
    palette = Image.fromarray(np.concatenate(some)).quantize(GIF_COLORS)
    # Dithered colours pack badly: twice the size and more.
    plain = Image.Dither.NONE
    frames = [Image.fromarray(each).quantize(palette=palette, dither=plain) for each in pictures]
    frames[0].save(
        path,
        save_all=True,
        append_images=frames[1:],
        duration=round(1e3 * seconds),
        loop=0,
    )
    return path
