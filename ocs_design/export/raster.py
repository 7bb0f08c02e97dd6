"""Pixels: those that triangles cover, for pictures and for lines that are hidden; images as PNG."""

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray

_PNG = b"\x89PNG\r\n\x1a\n"
_SUB = b"\1"
"""Filter of PNG: rows are differences to the pixel on the left, zeros on even faces."""


def covered_rows(
    corners: FloatArray, offset: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray, FloatArray]:
    """Each row that each triangle meets: triangle, row, and the two places where it is crossed.

    As in Foley, van Dam, Feiner, Hughes, "Computer Graphics", section 3.6.

    Args:
        corners: of triangles, in pixels, shape (n, 3, 2).
        offset: of a pixel's own point from its lower corner, along both axes [pixels].
    """
    low = np.ceil(corners[:, :, 1].min(axis=1) - offset).astype(np.int64)
    high = np.floor(corners[:, :, 1].max(axis=1) - offset).astype(np.int64)
    counts = np.maximum(high - low + 1, 0)
    triangle, row = np.repeat(np.arange(len(corners)), counts), ranges(low, counts)
    begin, end = corners[triangle], np.roll(corners[triangle], -1, axis=1)
    # A side that is level is crossed nowhere, its neighbours are.
    with np.errstate(divide="ignore", invalid="ignore"):
        part = ((row + offset)[:, None] - begin[:, :, 1]) / (end[:, :, 1] - begin[:, :, 1])
        crossing = begin[:, :, 0] + part * (end[:, :, 0] - begin[:, :, 0])
    outside = ~((part >= 0.0) & (part <= 1.0))
    first = np.where(outside, np.inf, crossing).min(axis=1)
    last = np.where(outside, -np.inf, crossing).max(axis=1)
    met = first <= last
    return triangle[met], row[met], first[met], last[met]


def ranges(first: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """`first[i], first[i] + 1, ...` of `counts[i]` numbers each, one behind the other."""
    total = np.cumsum(counts)
    within = np.arange(total[-1] if len(total) else 0) - np.repeat(total - counts, counts)
    return np.asarray(np.repeat(first, counts) + within)


def png_bytes(image: NDArray[np.uint8]) -> bytes:
    """PNG (ISO/IEC 15948) of an image, shape (height, width, 3): red, green and blue, 8 bits."""
    height, width, _ = image.shape
    left = np.zeros_like(image)
    left[:, 1:] = image[:, :-1]
    rows = (image - left).reshape(height, -1)
    lines = b"".join(_SUB + row.tobytes() for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        _PNG
        + _chunk(b"IHDR", header)
        + _chunk(b"IDAT", zlib.compress(lines, 6))
        + _chunk(b"IEND", b"")
    )


def _chunk(kind: bytes, content: bytes) -> bytes:
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)
