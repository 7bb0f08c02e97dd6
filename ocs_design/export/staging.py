"""Hidden folders in which a result is made whole, and what became of those whose run was killed.

A run holds a lock on its folder for as long as it lives, and the system takes that from it however
it ends. So a later run can tell what is left over from what another one is writing just now.
"""

import errno
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

NEW, OLD = "new", "old"
"""In such a folder: what is made, and what it takes the place of."""

_MARK = "ocs-design"
"""In their names, so that nobody's own hidden folders are taken for them."""


@contextmanager
def staging_beside(target: Path) -> Iterator[Path]:
    """A folder of our own beside `target`, on the same disk, which is gone after the block.

    Raises:
        OSError: none can be made there.
    """
    folder, handle = _locked_folder(target)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if handle is not None:
            os.close(handle)


def clear_leftovers(target: Path) -> None:
    """Remove what killed runs left beside `target`; what one of them had put aside comes back."""
    pattern = re.compile(rf"\.{re.escape(target.name)}\.{_MARK}-[a-z0-9_]{{8}}")
    with suppress(OSError):
        for folder in sorted(target.absolute().parent.iterdir()):
            if pattern.fullmatch(folder.name) and not folder.is_symlink():
                _clear(folder, target)


def _locked_folder(target: Path) -> tuple[Path, int | None]:
    """Its path, and the handle that bears the lock; None where there are no locks."""
    while True:
        prefix, parent = f".{target.name}.{_MARK}-", target.absolute().parent
        folder = Path(tempfile.mkdtemp(prefix=prefix, dir=parent))
        try:
            handle = _lock(folder)
        except (BlockingIOError, FileNotFoundError):
            # A run that is clearing up took it for a leftover before it was locked.
            continue
        except OSError:
            return folder, None
        if folder.exists():
            return folder, handle
        os.close(handle)


def _clear(folder: Path, target: Path) -> None:
    with suppress(OSError):
        handle = _lock(folder)
        try:
            if (folder / OLD).exists() and not os.path.lexists(target):
                (folder / OLD).rename(target)
            shutil.rmtree(folder, ignore_errors=True)
        finally:
            os.close(handle)


def _lock(folder: Path) -> int:
    """The handle that bears the lock, until it is closed or the process ends in whatever way.

    Raises:
        BlockingIOError: another run has it.
        OSError: there are no locks on this system or disk.
    """
    if sys.platform == "win32":
        raise OSError(errno.ENOTSUP, os.strerror(errno.ENOTSUP), str(folder))
    import fcntl  # noqa: PLC0415  Windows has none

    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        raise
    return handle
