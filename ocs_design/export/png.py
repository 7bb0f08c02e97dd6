"""Images as PNG."""

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SUB = b"\1"
"""Filter of PNG: rows are differences to the pixel on the left, zeros on even faces."""


def png_bytes(image: NDArray[np.uint8]) -> bytes:
    """PNG (ISO/IEC 15948) of an image, shape (height, width, 3): red, green and blue, 8 bits."""
    height, width, _ = image.shape
    left = np.zeros_like(image)
    left[:, 1:] = image[:, :-1]
    rows = (image - left).reshape(height, -1)
    lines = b"".join(_SUB + row.tobytes() for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        _SIGNATURE
        + _chunk(b"IHDR", header)
        + _chunk(b"IDAT", zlib.compress(lines, 6))
        + _chunk(b"IEND", b"")
    )


def _chunk(kind: bytes, content: bytes) -> bytes:
    checksum = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)
