"""Two folders that change places in one step, so that there is no moment without either."""

import errno
import os
from pathlib import Path

_AT_FDCWD = -100
_RENAME_EXCHANGE = 2
"""From Linux' `fcntl.h` and `fs.h`; Python has no name for either."""

_CANNOT = {errno.EINVAL, errno.ENOSYS, errno.ENOTSUP}
"""What file systems without it answer, and containers that do not let it through."""


def exchange(one: Path, other: Path) -> bool:
    """Let both change places; False where system or file system cannot.

    Raises:
        OSError: it could, but not with these two.
    """
    # It takes a while to import, and only replacing needs it.
    import ctypes  # noqa: PLC0415

    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError, TypeError):
        # Not Linux, or a C library that does not have it.
        return False
    names = (os.fsencode(one), os.fsencode(other))
    if rename(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _RENAME_EXCHANGE) == 0:
        return True
    fault = ctypes.get_errno()
    if fault in _CANNOT:
        return False
    raise OSError(fault, os.strerror(fault), str(other))
