"""Numbers that a script in a page unpacks: compressed and in base64."""

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

Record = dict[str, Any]
"""What becomes an object of JSON."""


class Blob:
    """Arrays one behind the other; each `add` gives where it lies, for the script."""

    def __init__(self) -> None:
        self._content = bytearray()

    def add(self, values: NDArray[Any], kind: str) -> Record:
        """An array as little-endian numbers of `kind` (`f4`, `i2`, `u2` or `u4`)."""
        content = np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()
        place = {"at": len(self._content), "kind": kind, "length": int(values.size)}
        # A view of an array must begin at a multiple of the size of its numbers.
        self._content += content + b"\0" * (-len(content) % 4)
        return place

    def text(self) -> str:
        """All of it: zlib in base64."""
        return base64.b64encode(zlib.compress(bytes(self._content), 6)).decode("ascii")
