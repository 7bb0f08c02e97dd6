"""Files that a file names: read only if they are plain files, and only up to a size."""

import errno
import os
import stat
from pathlib import Path


def read_plain_file(path: Path, largest: int) -> bytes:
    """The bytes of a file that may be whatever a stranger has named.

    A pipe would be waited for without end, and a device may never end.

    Raises:
        OSError: it cannot be read, is no plain file, or is larger than `largest` [bytes].
    """
    # Without waiting for the other end of a pipe.
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        status = os.fstat(handle)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is no plain file", str(path))
        content = stream.read(largest + 1)
    if len(content) > largest:
        raise OSError(errno.EFBIG, f"it is larger than {largest >> 20} MiB", str(path))
    return content
