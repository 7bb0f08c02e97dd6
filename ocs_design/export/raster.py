"""Views and rasterization of triangles for pictures and hidden lines; images as PNG."""

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray

_PNG = b"\x89PNG\r\n\x1a\n"
_SUB = b"\1"
"""PNG filter Sub: rows are differences to the pixel on the left, zero in areas of one colour."""


def view_of(camera: Sequence[float], up: Sequence[float]) -> FloatArray:
    """Rotation into the picture's axes: right, up, and towards the eye, shape (3, 3)."""
    eye = np.asarray(camera, dtype=np.float64) / np.linalg.norm(camera)
    right = np.cross(up, eye)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(eye, right), eye])


def covered_pixels(
    corners: FloatArray, offset: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """Each pixel that each triangle covers: triangle, row, column, and depth there.

    As in Foley, van Dam, Feiner, Hughes, "Computer Graphics", section 3.6.

    Args:
        corners: corners of triangles, x and y in pixels and a depth, shape (n, 3, 3).
        offset: offset of a pixel's sample point from its lower corner, along both axes [pixels].
    """
    flat = corners[:, :, :2]
    low, high = (
        rounded(end - offset).astype(np.int64)
        for rounded, end in ((np.ceil, flat[:, :, 1].min(1)), (np.floor, flat[:, :, 1].max(1)))
    )
    counts = np.maximum(high - low + 1, 0)
    triangle, row = np.repeat(np.arange(len(corners)), counts), ranges(low, counts)
    begin, end = flat[triangle], np.roll(flat[triangle], -1, axis=1)
    # No row crosses a horizontal side; the adjacent sides are crossed instead.
    with np.errstate(divide="ignore", invalid="ignore"):
        part = ((row + offset)[:, None] - begin[:, :, 1]) / (end[:, :, 1] - begin[:, :, 1])
        crossing = begin[:, :, 0] + part * (end[:, :, 0] - begin[:, :, 0])
    outside = ~((part >= 0.0) & (part <= 1.0))
    first = np.where(outside, np.inf, crossing).min(axis=1)
    last = np.where(outside, -np.inf, crossing).max(axis=1)
    met = first <= last
    triangle, row, first, last = triangle[met], row[met], first[met], last[met]
    left = np.ceil(first - offset).astype(np.int64)
    counts = np.maximum(np.floor(last - offset).astype(np.int64) - left + 1, 0)
    # Depth in the plane of each triangle, and its gradients along and across the rows.
    b, c = (corners[:, index] - corners[:, 0] for index in (1, 2))
    area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    scale = np.divide(1.0, area, out=np.zeros_like(area), where=area != 0.0)
    along = scale * (b[:, 2] * c[:, 1] - c[:, 2] * b[:, 1])
    across = scale * (c[:, 2] * b[:, 0] - b[:, 2] * c[:, 0])
    corner = corners[:, 0, 2] + along * (offset - corners[:, 0, 0])
    corner += across * (offset - corners[:, 0, 1])
    column = ranges(left, counts)
    depth = np.repeat(corner[triangle] + across[triangle] * row, counts)
    depth += np.repeat(along[triangle], counts) * column
    return np.repeat(triangle, counts), np.repeat(row, counts), column, depth


def ranges(first: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Concatenated ranges `first[i], first[i] + 1, ...` of `counts[i]` numbers each."""
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
    png = _PNG
    for chunk in (b"IHDR" + header, b"IDAT" + zlib.compress(lines, 6), b"IEND"):
        png += struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return png
